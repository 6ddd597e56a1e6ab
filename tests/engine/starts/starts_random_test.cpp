#include <catch2/catch.hpp>

#include "engine/bed/slab.hpp"
#include "engine/starts/starts.hpp"
#include "tests/engine/sample_packings.hpp"

namespace jostle {
namespace {

Packing scattered(RandomSettle start, const Container& container, std::uint32_t n) {
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  return make_start(start, container, n, random);
}

}  // namespace

TEST_CASE("A random settle starts from random places without overlap at the asked fraction") {
  for (const Container& container : {Container{PeriodicBox{8, 8}}, Container{WalledBox{8, 8}},
                                     Container{Cylinder{8}}, Container{Plates{9, 7}}}) {
    for (const double fraction : {0.02, 0.1, 0.25}) {
      const Packing packing = scattered({fraction}, container, 1500);
      CHECK(packing.centres.size() == 1500);
      CHECK(deepest_overlap_brute_force(packing).depth == 0);
      const double height = 1500 * sphere_volume / (footprint_area(container) * fraction);
      CHECK(top_height(packing) <= height + 0.5);
      // Between walls the layer without centres makes up to 3 % of difference at mid-height.
      CHECK(solids_fraction(packing, {0.2 * height, 0.8 * height}) ==
            Approx(fraction).epsilon(0.12));
      CHECK(mean_height(packing) == Approx(0.5 + 0.5 * height).epsilon(0.06));
    }
  }
}

TEST_CASE("A random settle starts from columns nearly as dense as random places can be") {
  const Packing packing = scattered({0.36}, PeriodicBox{8, 8}, 1500);
  CHECK(packing.centres.size() == 1500);
  CHECK(deepest_overlap_brute_force(packing).depth == 0);
  const double height = 1500 * sphere_volume / (64 * 0.36);
  CHECK(top_height(packing) <= height + 0.5);
}

TEST_CASE("A column may begin high above the floor, with the same places") {
  const Packing low = scattered({0.2}, PeriodicBox{5, 5}, 100);
  const Packing high = scattered({0.2, 40}, PeriodicBox{5, 5}, 100);
  for (std::size_t i = 0; i < low.centres.size(); ++i) {
    CHECK(high.centres[i].x == low.centres[i].x);
    CHECK(high.centres[i].z == Approx(low.centres[i].z + 40).epsilon(1e-14));
  }
}

TEST_CASE("A mixture settles from random places, whatever its ratio") {
  for (const Container& container :
       {Container{PeriodicBox{8, 8}}, Container{WalledBox{3, 5}}, Container{Cylinder{3.5}}}) {
    for (const double ratio : {1.4, 3.0, 10.0}) {
      CAPTURE(container.index(), ratio);
      StartSpheres spheres{200};
      spheres.sizes = std::make_shared<const Sizes>(graded_diameters(200, 3 / ratio, ratio));
      RandomStream random(stream_key(1, 0, 0, Purpose::start));
      const Packing packing = make_start(RandomSettle{0.1, 2}, container, spheres, random);
      CHECK(packing.sizes == spheres.sizes);
      CHECK(deepest_overlap_brute_force(packing).depth == 0);
      const double height = solid_volume(packing) / (0.1 * footprint_area(container));
      for (std::size_t i = 0; i < 200; ++i) {
        CHECK(packing.centres[i].z >= 2 + packing.radius(i));
        CHECK(packing.centres[i].z <= 2 + packing.radius(i) + height);
      }
    }
  }
}

TEST_CASE("Sizes of diameter 1 settle like equal spheres, bit for bit") {
  StartSpheres spheres{300};
  spheres.sizes = std::make_shared<const Sizes>(std::vector<double>(300, 1.0));
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  CHECK(make_start(RandomSettle{0.2}, WalledBox{6, 6}, spheres, random).centres ==
        scattered({0.2}, WalledBox{6, 6}, 300).centres);
}

TEST_CASE("A random settle that cannot be is refused") {
  CHECK_THROWS_WITH(scattered({0.1, -1}, PeriodicBox{8, 8}, 100), Catch::Contains("drop_height"));
  CHECK_THROWS_WITH(scattered({0.37}, PeriodicBox{8, 8}, 100), Catch::Contains("0.36"));
  CHECK_THROWS_AS(scattered({0}, PeriodicBox{8, 8}, 100), StartError);
  CHECK_THROWS_WITH(scattered({0.1}, FullyPeriodicBox{}, 100), Catch::Contains("gravity"));
  CHECK_THROWS_WITH(scattered({0.25}, WalledBox{1.6, 1.6}, 500),
                    Catch::Contains("lower dilute_fraction"));
}

}  // namespace jostle
