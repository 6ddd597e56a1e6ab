#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/large_pages.hpp"
#include "engine/monte_carlo/kernel/packed_centre.hpp"

// The rows of neighbour lists in memory: a row is its length, then the spheres.
namespace jostle::inline engine {

using ListEntries = std::vector<std::uint32_t, LargePageAllocator<std::uint32_t>>;

/// Rows of one stride, which doubles until all fit.
class StridedRows {
 public:
  using Index = std::uint32_t;

  /// Where the rows are.
  struct Place {
    const Index* first;
    std::size_t stride;
    [[gnu::always_inline]] const Index* operator[](Index i) const { return first + i * stride; }
  };
  Place place() const { return {entries_.data(), stride_}; }
  Index* operator[](Index i) { return &entries_[i * stride_]; }
  const Index* operator[](Index i) const { return &entries_[i * stride_]; }
  /// Cells of row i, its length included.
  std::size_t room(Index) const { return stride_; }

  /// Calls make(i) for every row i of n: it puts spheres there with put(), and returns what that
  /// returned.
  template <class Make>
  void make_all(Index n, Make&& make) {
    for (bool all_fit = false; !all_fit; stride_ *= 2) {
      entries_.assign(static_cast<std::size_t>(n) * stride_, 0);
      all_fit = true;
      for (Index i = 0; i < n && all_fit; ++i) all_fit = make(i);
      if (all_fit) break;
    }
  }
  /// Whether row i has room for so many spheres and some newcomers.
  bool holds(Index, std::size_t n_spheres) const { return n_spheres < stride_ - stride_ / 4; }

  std::size_t bytes() const { return sizeof(Index) * entries_.capacity(); }

 private:
  std::size_t stride_ = 16;  // a cache line
  ListEntries entries_;
};

/// Rows as long as each needs, found by offset: a large sphere among small ones has hundreds of
/// neighbours, and each of them a dozen.
class OffsetRows {
 public:
  using Index = std::uint32_t;

  struct Place {
    const Index* first;
    const std::size_t* offsets;
    [[gnu::always_inline]] const Index* operator[](Index i) const { return first + offsets[i]; }
  };
  Place place() const { return {entries_.data(), offsets_.data()}; }
  Index* operator[](Index i) { return &entries_[offsets_[i]]; }
  const Index* operator[](Index i) const { return &entries_[offsets_[i]]; }
  std::size_t room(Index i) const { return offsets_[i + 1] - offsets_[i]; }

  template <class Make>
  void make_all(Index n, Make&& make) {
    offsets_.assign(1, 0);
    offsets_.reserve(n + std::size_t{1});
    entries_.clear();
    for (Index i = 0; i < n; ++i) make(i);
  }
  /// Gives the row room at the first making.
  bool holds(Index i, std::size_t n_spheres) {
    if (i + std::size_t{1} < offsets_.size()) return n_spheres + 1 < room(i);
    // Whole cache lines, a quarter of them at least for newcomers.
    constexpr std::size_t line = 16;
    const std::size_t lines = (1 + n_spheres + n_spheres / 3) / line + 1;
    offsets_.push_back(offsets_.back() + lines * line);
    entries_.resize(offsets_.back(), 0);
    return true;
  }

  std::size_t bytes() const {
    return sizeof(Index) * entries_.capacity() + sizeof(std::size_t) * offsets_.capacity();
  }

 private:
  std::vector<std::size_t> offsets_;  // [n + 1]
  ListEntries entries_;
};

}  // namespace jostle::inline engine
