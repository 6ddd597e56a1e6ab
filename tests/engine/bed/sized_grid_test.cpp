#include "engine/bed/cells/sized_grid.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/engine/sample_packings.hpp"

using namespace jostle;

namespace {

// Points that may overlap, some on the seams.
Packing points(const Container& container, const std::vector<double>& diameters,
               RandomStream& random) {
  Packing packing{container, {}, std::make_shared<const Sizes>(diameters)};
  const Boundary boundary(container);
  const double height = boundary.periodic_z ? boundary.height : 12;
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    packing.centres.push_back({boundary.width_x * random.uniform(),
                               boundary.width_y * random.uniform(), height * random.uniform()});
    if (i % 5 == 0) packing.centres[i].x = 0;
    if (i % 7 == 0) packing.centres[i].y = std::nextafter(boundary.width_y, 0.0);
  }
  return packing;
}

// Against all pairs: none is met twice, none within the skin is missed.
void check_searches(const SizedGrid& grid, const Packing& packing, double skin) {
  const Boundary boundary(packing.container);
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    std::multiset<std::uint32_t> met;
    grid.for_each_near(packing.centres[i], packing.radius(i),
                       [&](std::uint32_t j) { met.insert(j); });
    for (std::uint32_t j = 0; j < packing.centres.size(); ++j) {
      REQUIRE(met.count(j) <= 1);
      const double reach = packing.radius(i) + packing.radius(j) + skin;
      if (overlaps(boundary, packing.centres[i], packing.centres[j], reach))
        REQUIRE(met.count(j) == 1);
    }
  }
}

}  // namespace

TEST_CASE("a search among several sizes misses nothing and meets nothing twice") {
  for (const Container& container :
       std::vector<Container>{PeriodicBox{16, 16}, PeriodicBox{4.1, 9}, WalledBox{3, 8},
                              Cylinder{7}, FullyPeriodicBox{4.1, 7, 11}}) {
    for (const double ratio : {1.0, 1.4, 3.0, 10.0}) {
      for (const double skin : {0.0, 0.3, 1.5}) {
        CAPTURE(container.index(), width_x(container), ratio, skin);
        RandomStream random(stream_key(41, 0, 0, Purpose::start));
        Packing packing = points(container, graded_diameters(120, 0.2, ratio), random);
        SizedGrid grid;
        grid.build(
            Boundary(container), skin, 120, [&](std::uint32_t i) { return packing.centres[i]; },
            [&](std::uint32_t i) { return packing.radius(i); });
        check_searches(grid, packing, skin);
        const Packing second = points(container, graded_diameters(120, 0.2, ratio), random);
        for (std::uint32_t i = 0; i < 120; i += 2) {
          packing.centres[i] = second.centres[i];
          grid.relocate(i, packing.centres[i]);
        }
        check_searches(grid, packing, skin);
      }
    }
  }
}
