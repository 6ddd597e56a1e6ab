#pragma once

#include <cassert>
#include <cstdint>
#include <numeric>
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
    weights_ = std::move(weights);
    levels_.clear();
    std::vector<std::uint64_t> sums(weights_.begin(), weights_.end());
    do {
      sums.resize((sums.size() + fan - 1) / fan * fan, 0);
      std::vector<Node> nodes(sums.size() / fan);
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        const std::uint64_t* const children = &sums[k * fan];
        std::exclusive_scan(children, children + fan, nodes[k].sum_before, std::uint64_t{0});
        sums[k] = nodes[k].sum_before[fan - 1] + children[fan - 1];
      }
      sums.resize(nodes.size());
      levels_.push_back(std::move(nodes));
    } while (sums.size() > 1);
    total_ = sums[0];
  }

  void set(std::uint32_t index, std::uint32_t weight) {
    const std::uint64_t change =
        std::uint64_t{weight} - weights_[index];  // modulo 2^64, as sums are
    weights_[index] = weight;
    std::size_t k = index;
    for (std::vector<Node>& level : levels_) {
      const std::uint64_t* const counts = &first_none_then_all[fan - 1 - k % fan];
      Node& node = level[k /= fan];
      for (std::size_t c = 0; c < fan; ++c) node.sum_before[c] += change & counts[c];
    }
    total_ += change;
  }

  void prefetch(std::uint32_t index) const {
    __builtin_prefetch(&weights_[index]);
    __builtin_prefetch(&levels_[0][index / fan]);
  }

  std::uint64_t total() const { return total_; }
  std::uint32_t weight(std::uint32_t index) const { return weights_[index]; }

  /// The index whose stretch of [0, total) holds the target. Requires target < total().
  Hit find(std::uint64_t target) const {
    assert(target < total());
    std::size_t k = 0;
    for (std::size_t level = levels_.size(); level-- > 0;) {
      const std::uint64_t* const sums = levels_[level][k].sum_before;
      std::size_t child = 0;
#pragma GCC unroll 8
      for (std::size_t c = 1; c < fan; ++c) child += target >= sums[c];
      target -= sums[child];
      k = k * fan + child;
    }
    return {static_cast<std::uint32_t>(k), target};
  }

  std::size_t bytes() const {
    std::size_t sum = sizeof(std::uint32_t) * weights_.capacity();
    for (const auto& level : levels_) sum += sizeof(Node) * level.capacity();
    return sum;
  }

 private:
  static constexpr std::size_t fan = 8;

  // For every child, the sum of the weights of all children before it.
  struct alignas(64) Node {
    std::uint64_t sum_before[fan];
  };

  // Its last fan - 1 - k words are all bits, those before are none: no branch is needed.
  static constexpr std::uint64_t all = ~std::uint64_t{0};
  static constexpr std::uint64_t first_none_then_all[2 * fan - 1] = {
      0, 0, 0, 0, 0, 0, 0, 0, all, all, all, all, all, all, all};

  std::vector<std::uint32_t> weights_;
  std::vector<std::vector<Node>> levels_;  // the lowest first
  std::uint64_t total_ = 0;
};

}  // namespace jostle::inline engine
