#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/monte_carlo/kernel/blocker_cache.hpp"
#include "engine/monte_carlo/kernel/neighbour_lists.hpp"
#include "engine/monte_carlo/kernel/packed_geometry.hpp"

namespace jostle::inline engine {

/// Settings of the lists. Diameters.
struct Reach {
  double longest = 0;  // no displacement of a trial is longer
  double drift = 0;    // mean dz of the trials that geometry decides
};

/// True if trials are first tested against blocker caches. They pay where few trials are accepted:
/// every move brings those up to date that show the sphere.
enum class BlockerCaching { disabled, enabled };

template <class Box, BlockerCaching caching, class Spheres = EqualSpheres>
class NeighbourhoodView;

/// The spheres of a loop, who is near whom, and what blocks each most often. Trials ask and move
/// through a view: there is no other way to move a sphere, and a view keeps lists and caches good.
/// Lists and caches are made when a view is asked for that needs them.
template <class Box, class Spheres = EqualSpheres>
class Neighbourhood {
 public:
  using Lists = NeighbourListsOf<Spheres>;
  using Index = typename Lists::Index;
  template <BlockerCaching caching>
  using View = NeighbourhoodView<Box, caching, Spheres>;

  explicit Neighbourhood(const Box& box) : box_(box), packed_box_(box) {}

  /// Takes over the centres of a packing in this container, any number.
  void load(const Packing& packing) {
    centres_.resize(packing.centres.size());
    if constexpr (Spheres::several) {
      for (std::size_t i = 0; i < centres_.size(); ++i)
        centres_[i] = packed_sphere(packing.centres[i], packing.radius(i));
      spare_skin_ = spare_skin * (2 * packing.smallest_radius());
    } else {
      std::ranges::transform(packing.centres, centres_.begin(), packed);
    }
    built_for_ = -1;
  }
  /// Writes them back, in the order they were loaded.
  void store(Packing& packing) const {
    packing.centres.resize(centres_.size());
    std::ranges::transform(centres_, packing.centres.begin(), unpacked);
  }

  /// A view for trials that keep within `reach`. At most one view at a time, and none across
  /// load().
  template <BlockerCaching caching>
  View<caching> view(const Reach& reach) {
    reach_ = reach;
    caches_follow_ = caches_follow_ && caching == BlockerCaching::enabled;
    if (reach.longest > built_for_) build<caching>();
    if (caching == BlockerCaching::enabled && !caches_follow_) build_caches();
    return View<caching>(*this);
  }

  const PackedCentres& centres() const { return centres_; }
  const Lists& lists() const { return lists_; }
  const BlockerCaches<Box, Spheres>& caches() const { return caches_; }
  /// Buildings of all lists, and renewals of one sphere's.
  std::uint64_t builds() const { return builds_; }
  std::uint64_t renewals() const { return renewals_; }
  std::size_t bytes() const {
    return lists_.bytes() + caches_.bytes() + sizeof(PackedCentre) * centres_.capacity();
  }

 private:
  template <class, BlockerCaching, class>
  friend class NeighbourhoodView;

  // Room in the skin beyond the longest step, diameters of the smallest sphere (bench/: little
  // changes from 0.1 to 0.3).
  static constexpr double spare_skin = 0.2;

  template <BlockerCaching caching>
  [[gnu::noinline]] void build() {
    lists_.build(box_, centres_, 2 * reach_.longest + spare_skin_, {0, 0, reach_.drift});
    built_for_ = reach_.longest;
    ++builds_;
    if (caching == BlockerCaching::enabled) build_caches();
  }
  [[gnu::noinline]] void build_caches() {
    caches_.build(packed_box_, centres_, lists_, built_for_);
    caches_follow_ = true;
  }

  // Makes the list of sphere i at its position, and removes it from its former neighbours.
  template <BlockerCaching caching>
  void renew(Index i) {
    const auto* const row = lists_.row(i);
    if (caching == BlockerCaching::enabled) former_.assign(row + 1, row + 1 + row[0]);
    if (!lists_.renew(box_, i, centres_[i])) return build<caching>();
    ++renewals_;
    if (caching == BlockerCaching::disabled) return;
    for (const auto j : former_) caches_.refresh(packed_box_, centres_, lists_, j);
  }

  Box box_;
  PackedBox<Box, Spheres> packed_box_;
  Reach reach_;
  double spare_skin_ = spare_skin;
  double built_for_ = -1;  // longest step of the reach that lists were built for; negative: none
  bool caches_follow_ = false;
  std::uint64_t builds_ = 0, renewals_ = 0;
  PackedCentres centres_;
  Lists lists_;
  BlockerCaches<Box, Spheres> caches_;
  std::vector<Index> former_;  // neighbours of the sphere whose list is renewed
};

/// Functions by which trials test a neighbourhood and move its spheres. It holds in members what
/// the loop reads again and again: the compiler cannot know that no store to a centre changes them.
/// Rare paths and the exact test of a trial that passes its cache are not inlined.
template <class Box, BlockerCaching caching, class Spheres>
class NeighbourhoodView {
 public:
  using Index = std::uint32_t;
  using Cache = BlockerCacheOf<Spheres>;

  explicit NeighbourhoodView(Neighbourhood<Box, Spheres>& neighbourhood)
      : neighbourhood_(neighbourhood), box_(neighbourhood.packed_box_) {
    refresh();
  }
  NeighbourhoodView(const NeighbourhoodView&) = delete;
  NeighbourhoodView& operator=(const NeighbourhoodView&) = delete;

  /// Where a step, diameters, leads sphere i, wrapped.
  [[gnu::always_inline]] PackedCentre target(Index i, Pair lateral, double dz) const {
    const PackedCentre& centre = centres_[i];
    return box_.wrapped({centre.xy + lateral, centre.z + dz, Spheres::several ? centre.radius : 0});
  }

  /// True if the cache alone rejects the step: then rejects() would. False decides nothing.
  [[gnu::always_inline]] bool certainly_rejects(Index i, double dx, double dy, double dz) const
      requires(caching == BlockerCaching::enabled) {
    return jostle::certainly_rejects<Box>(caches_[i], static_cast<float>(dx),
                                          static_cast<float>(dy), static_cast<float>(dz));
  }

  /// True if floor, sides or another sphere reject sphere i at r, a target.
  [[gnu::always_inline]] bool rejects(Index i, const PackedCentre& r) {
    if (!box_.clear_of_boundaries(r)) return true;
    if constexpr (caching == BlockerCaching::enabled) return blocked_beyond_cache(i, r);
    return blocked_by_first(i, r, *row(i));
  }

  /// Moves sphere i to r, a target that rejects() did not reject. Far from where its list was made
  /// the list may be incomplete: returns false, and moves nothing, if a new list has an obstacle.
  [[gnu::always_inline]] bool move(Index i, const PackedCentre& r) {
    if (distance_squared(box_, r, origins_[i]) > half_skin_squared_ && !free_by_new_list(i, r)) {
      return false;
    }
    centres_[i] = r;
    if constexpr (caching == BlockerCaching::enabled) follow(i);
    return true;
  }

  // Batches fetch early what their trials will need.
  [[gnu::always_inline]] void fetch_cache(Index i) const { __builtin_prefetch(&caches_[i]); }
  [[gnu::always_inline]] void fetch_list(Index i) const {
    __builtin_prefetch(&centres_[i]);
    __builtin_prefetch(row(i));
  }
  [[gnu::noinline]] void fetch_neighbours(Index i) const {
    const Index* const near = row(i);
    for (Index m = 1; m <= near[0]; ++m) __builtin_prefetch(&centres_[near[m]]);
  }

  /// Distances that rejects() and move() compared.
  std::uint64_t distance_tests() const { return distance_tests_; }

 private:
  [[gnu::always_inline]] const Index* row(Index i) const { return rows_[i]; }

  void refresh() {
    centres_ = neighbourhood_.centres_.data();
    rows_ = neighbourhood_.lists_.rows_place();
    caches_ = neighbourhood_.caches_.data();
    origins_ = neighbourhood_.lists_.origins();
    half_skin_squared_ = neighbourhood_.lists_.half_skin_squared();
  }

  [[gnu::always_inline]] bool touches(const PackedCentre& r, const PackedCentre& neighbour) const {
    return distance_squared(box_, r, neighbour) < Spheres::touching_squared(r, neighbour);
  }

  // One of the first n neighbours.
  [[gnu::always_inline]] bool blocked_by_first(Index i, const PackedCentre& r, Index n) {
    const Index* const near = row(i);
    const Index* const last = near + 1 + n;
    for (const Index* j = near + 1; j < last; ++j) {
      ++distance_tests_;
      if (touches(r, centres_[*j])) return true;
    }
    return false;
  }

  // Those that the cache does not hold first. One that blocks moves up in the list: caches come to
  // hold those that block most often.
  [[gnu::noinline]] bool blocked_beyond_cache(Index i, const PackedCentre& r) {
    const Index* const near = row(i);
    const Index shown = caches_[i].shown();
    for (Index place = shown; place < near[0]; ++place) {
      ++distance_tests_;
      if (touches(r, centres_[near[1 + place]])) {
        neighbourhood_.caches_.promote(box_, neighbourhood_.centres_, neighbourhood_.lists_, i,
                                       place);
        return true;
      }
    }
    return blocked_by_first(i, r, std::min(*near, shown));
  }

  [[gnu::noinline]] bool free_by_new_list(Index i, const PackedCentre& r) {
    neighbourhood_.template renew<caching>(i);
    refresh();
    if (!blocked_by_first(i, r, *row(i))) return true;
    if constexpr (caching == BlockerCaching::enabled) follow(i);
    return false;
  }

  [[gnu::always_inline]] void follow(Index i) {
    neighbourhood_.caches_.follow(box_, neighbourhood_.centres_, neighbourhood_.lists_, i);
  }

  Neighbourhood<Box, Spheres>& neighbourhood_;
  PackedBox<Box, Spheres> box_;
  PackedCentre* centres_;
  typename Neighbourhood<Box, Spheres>::Lists::Rows::Place rows_;
  const Cache* caches_;
  const PackedCentre* origins_;
  double half_skin_squared_;
  std::uint64_t distance_tests_ = 0;
};

}  // namespace jostle::inline engine
