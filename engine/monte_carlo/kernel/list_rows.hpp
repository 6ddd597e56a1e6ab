#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
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

  /// The place of all rows.
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

  /// Calls make(i) for every row i of n, which fills it if holds(i, its spheres), and returns that.
  template <class Make>
  void make_all(Index n, Make&& make) {
    for (bool all_fit = false; !all_fit; stride_ *= 2) {
      entries_.assign(static_cast<std::size_t>(n) * stride_, 0);
      all_fit = true;
      for (Index i = 0; i < n && all_fit; ++i) all_fit = make(i);
      if (all_fit) break;
    }
  }
  /// Returns whether row i has room for so many spheres and some newcomers.
  bool holds(Index, std::size_t n_spheres) const { return n_spheres < stride_ - stride_ / 4; }
  /// Rows have one stride: a row that is full cannot grow alone.
  static bool enlarge(Index) { return false; }

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
  std::size_t room(Index i) const { return rooms_[i]; }

  template <class Make>
  void make_all(Index n, Make&& make) {
    offsets_.clear();
    rooms_.clear();
    entries_.clear();
    offsets_.reserve(n);
    rooms_.reserve(n);
    most_entries_ = std::numeric_limits<std::size_t>::max();
    for (Index i = 0; i < n; ++i) make(i);
    most_entries_ = 2 * entries_.size();
  }
  /// Like StridedRows, but gives a row the room that it needs.
  bool holds(Index i, std::size_t n_spheres) {
    if (i == offsets_.size()) {
      append(i, n_spheres);
      return true;
    }
    return n_spheres + 1 < rooms_[i] || move_to_end(i, n_spheres);
  }
  /// Gives a row more room, at the end of all. Returns false where former places of rows have come
  /// to take up as much as the rows: then all must be made anew.
  bool enlarge(Index i) { return move_to_end(i, rooms_[i]); }

  std::size_t bytes() const {
    return sizeof(Index) * entries_.capacity() + sizeof(std::size_t) * offsets_.capacity() +
           sizeof(std::uint32_t) * rooms_.capacity();
  }

 private:
  // Whole cache lines, a quarter of them at least for newcomers.
  void append(Index i, std::size_t n_spheres) {
    constexpr std::size_t line = 16;
    const std::size_t room = ((1 + n_spheres + n_spheres / 3) / line + 1) * line;
    if (i == offsets_.size()) {
      offsets_.push_back(0);
      rooms_.push_back(0);
    }
    offsets_[i] = entries_.size();
    rooms_[i] = static_cast<std::uint32_t>(room);
    entries_.resize(entries_.size() + room, 0);
  }

  bool move_to_end(Index i, std::size_t n_spheres) {
    if (entries_.size() > most_entries_) return false;
    const std::size_t first = offsets_[i], length = rooms_[i];
    append(i, n_spheres);
    std::copy_n(entries_.begin() + static_cast<std::ptrdiff_t>(first), length,
                entries_.begin() + static_cast<std::ptrdiff_t>(offsets_[i]));
    return true;
  }

  std::vector<std::size_t> offsets_;  // [n]
  std::vector<std::uint32_t> rooms_;  // [n]
  std::size_t most_entries_ = 0;
  ListEntries entries_;
};

}  // namespace jostle::inline engine
