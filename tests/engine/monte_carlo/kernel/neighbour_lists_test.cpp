#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "engine/bed/cells/cell_grid.hpp"
#include "engine/monte_carlo/kernel/neighbour_lists.hpp"
#include "tests/engine/sample_packings.hpp"

using namespace jostle;

namespace {

std::vector<Container> containers() {
  return {PeriodicBox{16, 16}, PeriodicBox{2.1, 2.1},     PeriodicBox{4.1, 9},
          WalledBox{1, 1},     WalledBox{8, 3},           Cylinder{1},
          Cylinder{7},         FullyPeriodicBox{7, 7, 7}, FullyPeriodicBox{2.1, 5, 11},
          Plates{2.1, 3}};
}

// Random points (they may overlap), with some on the seams and the upper edges.
Packing points(const Container& container, int n, double height, std::uint64_t seed) {
  RandomStream random(stream_key(seed, 0, 0, Purpose::start));
  const auto* bulk = std::get_if<FullyPeriodicBox>(&container);
  const double wx = width_x(container), wy = width_y(container);
  const double wz = bulk ? bulk->height : height;
  Packing packing{container, {}};
  for (int k = 0; k < n; ++k) {
    Vec3 r{wx * random.uniform(), wy * random.uniform(), wz * random.uniform()};
    if (k % 5 == 0) r.x = 0;
    if (k % 7 == 0) r.y = std::nextafter(wy, 0.0);
    if (bulk && k % 11 == 0) r.z = 0;
    packing.centres.push_back(r);
  }
  return packing;
}

PackedCentres packed_centres(const Packing& packing) {
  PackedCentres centres;
  for (std::size_t i = 0; i < packing.centres.size(); ++i)
    centres.push_back(packed_sphere(packing.centres[i], packing.radius(i)));
  return centres;
}

template <class Spheres>
std::vector<std::uint32_t> list_of(const NeighbourListsOf<Spheres>& lists, std::uint32_t i) {
  const auto* row = lists.row(i);
  return {row + 1, row + 1 + *row};
}

// Lists against all pairs: each neighbour exactly once, none missing, none too far.
template <class Spheres = EqualSpheres>
void check_lists(const Packing& packing, double skin) {
  std::visit(
      [&](const auto& box) {
        NeighbourListsOf<Spheres> lists;
        lists.build(box, packed_centres(packing), skin, {0, 0, -0.04});
        for (std::uint32_t i = 0; i < packing.centres.size(); ++i) {
          std::vector<std::uint32_t> found = list_of(lists, i), expected;
          for (std::uint32_t j = 0; j < packing.centres.size(); ++j) {
            const Vec3 displacement = separation(box, packing.centres[i], packing.centres[j]);
            const double reach = packing.radius(i) + packing.radius(j) + skin;
            if (j != i && norm_squared(displacement) < reach * reach) expected.push_back(j);
          }
          std::ranges::sort(found);
          REQUIRE(found == expected);
        }
      },
      packing.container);
}

}  // namespace

TEST_CASE("neighbour lists hold exactly the pairs that all pairs give") {
  for (const Container& container : containers()) {
    CAPTURE(container.index(), width_x(container), width_y(container));
    for (const double skin : {0.05, 0.3, 1.0, 4.0}) {
      check_lists(points(container, 80, 10, 1), skin);
      check_lists(points(container, 80, 400, 2), skin);  // a dilute column
      check_lists(points(container, 2, 3, 3), skin);
      check_lists(points(container, 1, 3, 4), skin);
    }
  }
}

TEST_CASE("neighbour lists of several sizes hold exactly the pairs that all pairs give") {
  for (const Container& container : containers()) {
    CAPTURE(container.index(), width_x(container), width_y(container));
    for (const double ratio : {1.0, 1.4, 3.0, 10.0}) {
      Packing packing = points(container, 80, 10, 1);
      packing.sizes = std::make_shared<const Sizes>(graded_diameters(80, 0.25, ratio));
      for (const double skin : {0.05, 0.3, 4.0}) check_lists<SeveralSizes>(packing, skin);
    }
  }
}

TEST_CASE("neighbour lists hold on a crystal whose rows lie on the seams") {
  for (const double skin : {0.0, 1e-9, 0.2, 0.5}) {
    check_lists(cubic_packing(PeriodicBox{6, 6}, 6, 1), skin);
    check_lists(cubic_packing(FullyPeriodicBox{6, 6, 6}, 6, 1), skin);
    check_lists(cubic_packing(PeriodicBox{3, 3}, 3, 1), skin);
  }
}

namespace {

// Spheres walk at random, every one that leaves half a skin gets a new list, as in the trial loop.
template <class Spheres>
void check_renewals(double smallest, double ratio) {
  for (const Container& container : containers()) {
    CAPTURE(container.index(), width_x(container), width_y(container), ratio);
    constexpr double skin = 0.4, longest = 0.1;
    const std::uint32_t n = 60;
    Packing packing = points(container, n, 6, 9);
    if (Spheres::several)
      packing.sizes = std::make_shared<const Sizes>(graded_diameters(n, smallest, ratio));
    std::visit(
        [&](const auto& box) {
          RandomStream random(stream_key(10, 0, 0, Purpose::trials));
          auto centres = packed_centres(packing);
          NeighbourListsOf<Spheres> lists;
          lists.build(box, centres, skin, {0, 0, -0.04});
          int renewals = 0, builds = 0;
          for (int step = 0; step < 30'000; ++step) {
            const auto i = static_cast<std::uint32_t>(random.integer_below(n));
            const auto shift = [&] { return longest * (random.uniform() - 0.5); };
            Vec3 r = wrapped(box, unpacked(centres[i]) + Vec3{shift(), shift(), shift()});
            if (!clear_of_boundaries(box, r)) continue;
            if (norm_squared(separation(box, r, unpacked(lists.origins()[i]))) >
                lists.half_skin_squared()) {
              ++renewals;
              if (!lists.renew(box, i, centres[i])) {
                lists.build(box, centres, skin, {0, 0, -0.04});
                ++builds;
              }
            }
            centres[i] = packed_sphere(r, packing.radius(i));
            if (step % 97 != 0) continue;
            for (std::uint32_t a = 0; a < n; ++a) {
              const auto list = list_of(lists, a);
              REQUIRE(std::set(list.begin(), list.end()).size() == list.size());
              REQUIRE(std::ranges::find(list, a) == list.end());
              // A trial may carry sphere a to the rim of its half skin.
              for (std::uint32_t b = 0; b < n; ++b) {
                const Vec3 displacement =
                    separation(box, unpacked(lists.origins()[a]), unpacked(centres[b]));
                const double reach = packing.radius(a) + packing.radius(b) + 0.5 * skin;
                const bool listed = std::ranges::find(list, b) != list.end();
                if (b != a && norm_squared(displacement) < reach * reach) REQUIRE(listed);
                const auto second = list_of(lists, b);
                REQUIRE(listed == (std::ranges::find(second, a) != second.end()));
              }
            }
          }
          // In the narrowest containers nothing can walk.
          if (width_x(container) > 1) CHECK(renewals > 100);
          CHECK(builds < 1 + renewals / (Spheres::several ? 100 : 20));
        },
        container);
  }
}

}  // namespace

TEST_CASE("lists renewed one by one still hold all that can be touched") {
  check_renewals<EqualSpheres>(1, 1);
  for (const double ratio : {1.4, 10.0}) check_renewals<SeveralSizes>(0.25, ratio);
}

TEST_CASE("a search by cells misses nothing within its cutoff and meets nothing twice") {
  for (const Container& container : containers()) {
    for (const double cutoff : {0.3, 1.0, 1.7, 5.0}) {
      const Packing packing = points(container, 150, 12, 6);
      CellGrid grid;
      grid.build(Boundary(container), cutoff, 150,
                 [&](std::uint32_t i) { return packing.centres[i]; });
      for (std::uint32_t i = 0; i < 150; ++i) {
        std::multiset<std::uint32_t> met;
        grid.for_each_near(packing.centres[i], [&](std::uint32_t j) { met.insert(j); });
        for (std::uint32_t j = 0; j < 150; ++j) {
          REQUIRE(met.count(j) <= 1);
          const bool close = std::visit(
              [&](const auto& box) {
                return norm_squared(separation(box, packing.centres[i], packing.centres[j])) <
                       cutoff * cutoff;
              },
              container);
          if (close) REQUIRE(met.count(j) == 1);
        }
      }
    }
  }
}
