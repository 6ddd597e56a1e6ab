#include "engine/monte_carlo/kernel/neighbourhood.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/engine/sample_packings.hpp"

using namespace jostle;

namespace {

std::vector<Container> containers() {
  return {PeriodicBox{4.2, 3.1}, WalledBox{4, 3.5}, Cylinder{4.4}, FullyPeriodicBox{4, 3.4, 4.6},
          Plates{4, 3.5}};
}

// Every lane of every cache is as a new one would be.
template <class Box>
void check_caches(const PackedBox<Box, SeveralSizes>& box,
                  const Neighbourhood<Box, SeveralSizes>& neighbourhood, double longest) {
  const PackedCentres& centres = neighbourhood.centres();
  for (std::uint32_t i = 0; i < centres.size(); ++i) {
    const SizedBlockerCache& cache = neighbourhood.caches().data()[i];
    SizedBlockerCache expected;
    expected.see_faces(box, centres[i], longest);
    const auto* row = neighbourhood.lists().row(i);
    for (std::uint32_t lane = 0; lane < std::min(expected.shown(), row[0]); ++lane)
      expected.see(box, centres[i], centres[row[1 + lane]], lane, longest);
    for (std::uint32_t lane = 0; lane < SizedBlockerCache::size; ++lane) {
      REQUIRE(cache.x[lane] == expected.x[lane]);
      REQUIRE(cache.y[lane] == expected.y[lane]);
      REQUIRE(cache.z[lane] == expected.z[lane]);
      REQUIRE(cache.c[lane] == expected.c[lane]);
    }
  }
}

// Every lane of every cache has the position of its sphere, the rest nothing.
template <class Box>
void check_caches(const PackedBox<Box>& box, const Neighbourhood<Box>& neighbourhood, double) {
  const PackedCentres& centres = neighbourhood.centres();
  for (std::uint32_t i = 0; i < centres.size(); ++i) {
    const BlockerCache& cache = neighbourhood.caches().data()[i];
    const auto* row = neighbourhood.lists().row(i);
    for (std::uint32_t lane = 0; lane < BlockerCache::size; ++lane) {
      if (lane >= row[0]) {
        REQUIRE(cache.x[lane] == BlockerCache::far);
        continue;
      }
      const PackedCentre& neighbour = centres[row[1 + lane]];
      const Pair displacement = box.lateral(neighbour.xy - centres[i].xy);
      REQUIRE(cache.x[lane] == static_cast<float>(displacement[0]));
      REQUIRE(cache.y[lane] == static_cast<float>(displacement[1]));
      REQUIRE(cache.z[lane] == static_cast<float>(box.vertical(neighbour.z - centres[i].z)));
    }
  }
}

// True if a step is rejected, by all spheres and in double precision.
template <class Spheres, class Box>
bool rejected(const Box& box, const PackedCentres& centres, std::uint32_t i, Vec3 step) {
  const Vec3 target = wrapped(box, unpacked(centres[i]) + step);
  const double radius = Spheres::radius(centres[i]);
  if (!clear_of_boundaries(box, target, radius)) return true;
  for (std::uint32_t j = 0; j < centres.size(); ++j) {
    const double touching = radius + Spheres::radius(centres[j]);
    if (j != i && overlaps(box, target, unpacked(centres[j]), touching)) return true;
  }
  return false;
}

// Random trials, each tested against all spheres.
template <class Box, class Spheres>
struct Walk {
  Box box;
  double longest;
  PackedBox<Box, Spheres> packed_box{box};
  Neighbourhood<Box, Spheres> neighbourhood{box};
  RandomStream random{stream_key(32, 0, 0, Purpose::trials)};
  int moved = 0, certainly_rejected = 0, promoted = 0;

  Walk(const Box& sides, double longest_part) : box(sides), longest(longest_part) {}

  template <BlockerCaching caching>
  void make_trials(const Reach& reach, int n) {
    auto neighbourhood_view = neighbourhood.template view<caching>(reach);
    for (int trial = 0; trial < n; ++trial) make_trial<caching>(neighbourhood_view);
  }

  template <BlockerCaching caching>
  void make_trial(NeighbourhoodView<Box, caching, Spheres>& neighbourhood_view) {
    const PackedCentres& centres = neighbourhood.centres();
    const auto i = static_cast<std::uint32_t>(random.integer_below(centres.size()));
    const auto part = [&] { return longest * (2 * random.uniform() - 1); };
    const Vec3 step{part(), part(), part()};
    const bool is_rejected = rejected<Spheres>(box, centres, i, step);
    const PackedCentre target = neighbourhood_view.target(i, Pair{step.x, step.y}, step.z);
    REQUIRE(unpacked(target) == wrapped(box, unpacked(centres[i]) + step));
    if constexpr (caching == BlockerCaching::enabled) {
      if (neighbourhood_view.certainly_rejects(i, step.x, step.y, step.z)) {
        REQUIRE(is_rejected);
        ++certainly_rejected;
      }
    }
    const std::vector<std::uint32_t> row_before = row_of(i);
    const bool free = !neighbourhood_view.rejects(i, target);
    promoted += row_of(i) != row_before;
    const bool moves = free && neighbourhood_view.move(i, target);
    REQUIRE(moves == !is_rejected);
    moved += moves;
  }

  std::vector<std::uint32_t> row_of(std::uint32_t i) const {
    const auto* row = neighbourhood.lists().row(i);
    return {row + 1, row + 1 + row[0]};
  }

  Packing stored(Packing packing) const {
    neighbourhood.store(packing);
    return packing;
  }
};

template <class Spheres>
void check_walk(const Packing& packing) {
  CAPTURE(packing.container.index(), packing.largest_radius());
  std::visit(
      [&](const auto& box) {
        using Box = std::decay_t<decltype(box)>;
        constexpr double longest = 0.4, reach = std::numbers::sqrt3 * longest;
        Walk<Box, Spheres> walk(box, longest);
        walk.neighbourhood.load(packing);
        for (int stretch = 0; stretch < 200; ++stretch) {
          const bool caching = stretch % 5 != 4;
          if (stretch % 40 == 39) walk.neighbourhood.load(walk.stored(packing));
          if (caching) {
            walk.template make_trials<BlockerCaching::enabled>({reach, -0.1}, 200);
            check_caches(walk.packed_box, walk.neighbourhood, reach);
          } else {
            walk.template make_trials<BlockerCaching::disabled>({reach, -0.1}, 200);
          }
        }
        CHECK(walk.moved > 1000);
        CHECK(walk.certainly_rejected > 1000);
        CHECK(walk.promoted > 100);
        CHECK(walk.neighbourhood.renewals() > 20);
      },
      packing.container);
}

}  // namespace

TEST_CASE("a neighbourhood rejects what all spheres reject, whatever moved and however cached") {
  for (const Container& container : containers())
    check_walk<EqualSpheres>(random_packing(container, 24, 5, 31));
}

TEST_CASE("a neighbourhood of several sizes rejects what all spheres reject") {
  for (const Container& container : containers()) {
    check_walk<SeveralSizes>(random_packing(container, 24, 5, 31));
    check_walk<SeveralSizes>(random_mixture(container, graded_diameters(24, 0.9, 1.4), 5, 31));
    check_walk<SeveralSizes>(random_mixture(container, graded_diameters(60, 0.5, 2.9), 4, 31));
  }
}

TEST_CASE("a neighbourhood is built anew for longer steps, not for shorter ones") {
  const PeriodicBox box{5, 5};
  Neighbourhood<PeriodicBox> neighbourhood(box);
  neighbourhood.load(random_packing(box, 24, 5, 31));
  CHECK(neighbourhood.builds() == 0);
  for (const double longest : {0.2, 0.1, 0.2}) {
    neighbourhood.view<BlockerCaching::disabled>({longest, 0});
    CHECK(neighbourhood.builds() == 1);
  }
  neighbourhood.view<BlockerCaching::enabled>({0.3, 0});
  CHECK(neighbourhood.builds() == 2);
  neighbourhood.load(random_packing(box, 20, 5, 32));
  neighbourhood.view<BlockerCaching::enabled>({0.1, 0});
  CHECK(neighbourhood.builds() == 3);
  CHECK(neighbourhood.centres().size() == 20);
}

TEST_CASE("caches reject steps through floor and sides to within their margin") {
  for (const Container& container : containers()) {
    CAPTURE(container.index());
    std::visit(
        [&](const auto& box) {
          using Box = std::decay_t<decltype(box)>;
          const PackedBox<Box> packed_box(box);
          RandomStream random(stream_key(33, 0, 0, Purpose::trials));
          for (int trial = 0; trial < 20'000; ++trial) {
            const Vec3 r{width_x(container) * random.uniform(),
                         width_y(container) * random.uniform(), 0.5 + 3 * random.uniform()};
            if (!clear_of_boundaries(box, r)) continue;
            const auto part = [&] { return 2 * random.uniform() - 1; };
            const Vec3 step{part(), part(), part()};
            const bool leaves =
                PackedBox<Box>::leaves(packed_box.room(packed(r)), static_cast<float>(step.x),
                                       static_cast<float>(step.y), static_cast<float>(step.z));
            if (leaves) REQUIRE_FALSE(clear_of_boundaries(box, wrapped(box, r + step)));
            // A step that ends well outside is seen, but for a tube's far side of a chord.
            if (std::holds_alternative<Cylinder>(container)) continue;
            const Vec3 nearer = wrapped(box, r + 0.9999 * step);
            if (!clear_of_boundaries(box, nearer)) REQUIRE(leaves);
          }
        },
        container);
  }
}
