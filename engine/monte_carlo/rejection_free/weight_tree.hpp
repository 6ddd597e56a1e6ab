#pragma once

#include <cassert>
#include <cstdint>
#include <utility>
#include <vector>

namespace jostle::inline engine {

/// Draws an index with a probability proportional to its integer weight, in a time that grows with
/// the logarithm of their number. A function of the weights alone, whatever order they were set in.
class WeightTree {
 public:
  struct Hit {
    std::uint32_t index;
    std::uint64_t rest;  // target less the weights of all lower indices
  };

  void assign(std::vector<std::uint32_t> weights) {
    leaves_ = std::move(weights);
    leaves_.resize(padded(leaves_.size()), 0);
    total_ = 0;
    for (const std::uint32_t weight : leaves_) total_ += weight;
    levels_.clear();
    for (std::size_t size = leaves_.size(); size > fan; size = levels_.back().size()) {
      std::vector<std::uint64_t> sums(padded(size / fan), 0);
      for (std::size_t k = 0; k < size; ++k) {
        sums[k / fan] += levels_.empty() ? leaves_[k] : levels_.back()[k];
      }
      levels_.push_back(std::move(sums));
    }
  }

  void set(std::uint32_t index, std::uint32_t weight) {
    const std::uint64_t change =
        std::uint64_t{weight} - leaves_[index];  // modulo 2^64, as sums are
    leaves_[index] = weight;
    std::size_t k = index;
    for (std::vector<std::uint64_t>& level : levels_) level[k /= fan] += change;
    total_ += change;
  }

  std::uint64_t total() const { return total_; }
  std::uint32_t weight(std::uint32_t index) const { return leaves_[index]; }

  /// The index whose stretch of [0, total) holds the target. Requires target < total().
  Hit find(std::uint64_t target) const {
    assert(target < total_);
    std::size_t node = 0;
    for (std::size_t level = levels_.size(); level-- > 0;) {
      node = child(levels_[level].data(), node, target);
    }
    node = child(leaves_.data(), node, target);
    return {static_cast<std::uint32_t>(node), target};
  }

  std::size_t bytes() const {
    std::size_t sum = sizeof(std::uint32_t) * leaves_.capacity();
    for (const auto& level : levels_) sum += sizeof(std::uint64_t) * level.capacity();
    return sum;
  }

 private:
  static constexpr std::size_t fan = 16;

  static std::size_t padded(std::size_t size) { return (size + fan - 1) / fan * fan; }

  // The child of a node in whose stretch the target lies; the target becomes relative to it.
  template <class Weight>
  static std::size_t child(const Weight* level, std::size_t node, std::uint64_t& target) {
    const Weight* const weights = level + node * fan;
    std::uint64_t sum = 0, passed = 0;
    std::size_t index = 0;
    for (std::size_t k = 0; k < fan; ++k) {
      sum += weights[k];
      const bool beyond = sum <= target;
      index += beyond;
      passed = beyond ? sum : passed;
    }
    target -= passed;
    return node * fan + index;
  }

  std::vector<std::uint32_t> leaves_;
  std::vector<std::vector<std::uint64_t>> levels_;  // sums of `fan` below, the lowest first
  std::uint64_t total_ = 0;
};

}  // namespace jostle::inline engine
