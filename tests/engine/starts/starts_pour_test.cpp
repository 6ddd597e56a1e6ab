#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "engine/bed/slab.hpp"
#include "engine/starts/starts.hpp"
#include "tests/engine/starts/starts_supports.hpp"

namespace jostle {
namespace {

Packing poured(const Container& container, std::uint32_t n, std::uint64_t realization,
               std::uint64_t seed = 1) {
  RandomStream random(stream_key(seed, 0, realization, Purpose::start));
  return make_start(SteepestDescentPour{}, container, n, random);
}

std::size_t on_floor(const Packing& packing) {
  std::size_t count = 0;
  for (const Vec3& r : packing.centres) count += r.z == sphere_radius ? 1 : 0;
  return count;
}

// Spheres that neither rest on the floor nor are carried by their contacts.
std::size_t unsupported(const Packing& packing) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    if (packing.centres[i].z == sphere_radius) continue;
    if (!carried(contacts(packing, i))) ++count;
  }
  return count;
}

struct Moments {
  std::vector<double> values;
  double mean() const {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  }
  double error() const {
    const double centre = mean();
    double sum = 0;
    for (const double value : values) sum += (value - centre) * (value - centre);
    const auto n = static_cast<double>(values.size());
    return std::sqrt(sum / (n * (n - 1)));
  }
};

void check_within_3_errors(const Moments& run, double reference, double reference_error) {
  INFO("mean " << run.mean() << ", standard error " << run.error() << ", reference " << reference
               << "(" << reference_error << ")");
  CHECK(run.error() <= std::max(reference_error, 0.003 * reference));
  CHECK(std::abs(run.mean() - reference) <=
        3 * std::sqrt(reference_error * reference_error + run.error() * run.error()));
}

// The spheres that arrived before this one and lie within the touch tolerance of it.
std::size_t earlier_contacts(const Packing& packing, std::size_t sphere) {
  std::size_t count = 0;
  for (std::size_t neighbour = 0; neighbour < sphere; ++neighbour) {
    const Vec3 offset = separation(std::get<PeriodicBox>(packing.container),
                                   packing.centres[sphere], packing.centres[neighbour]);
    if (norm_squared(offset) < (1 + touch_tolerance) * (1 + touch_tolerance)) ++count;
  }
  return count;
}

}  // namespace

TEST_CASE("Steepest-descent pours have the fractions and contacts of an independent program",
          "[statistics]") {
  // Reference: 20 deposits of 4096 spheres, periodic sides 16 d, by an independent program; one of
  // them is tests/data/dep_L32_N4096_s1.dat.
  constexpr std::uint64_t pours = 24;
  Moments bulk, bottom, coordination;
  std::size_t aloft = 0, on_three = 0;
  for (std::uint64_t pour = 0; pour < pours; ++pour) {
    const Packing packing = poured(PeriodicBox{16, 16}, 4096, pour);
    REQUIRE(deepest_overlap(packing).depth <= 1e-12);
    CHECK(unsupported(packing) == 0);
    const double low = 4, high = 4.0 / 3 * mean_height(packing);
    bulk.values.push_back(solids_fraction(packing, {low, high}));
    bottom.values.push_back(solids_fraction(packing, {0, 2}));
    double touching = 0, inside = 0;
    for (std::size_t i = 0; i < packing.centres.size(); ++i) {
      const double z = packing.centres[i].z;
      if (z > sphere_radius) {
        ++aloft;
        if (earlier_contacts(packing, i) == 3) ++on_three;
      }
      if (z < low || z > high) continue;
      touching += static_cast<double>(contacts(packing, i).size());
      inside += 1;
    }
    coordination.values.push_back(touching / inside);
  }
  check_within_3_errors(bulk, 0.5809, 0.0004);
  check_within_3_errors(bottom, 0.5447, 0.0005);
  check_within_3_errors(coordination, 5.9996, 0.0012);
  // A fourth sphere within the tolerance by chance: about once in 1e5.
  CHECK(on_three + 10 >= aloft);
}

TEST_CASE("Between walls and in tubes every poured sphere is carried, and the bed is looser") {
  const double periodic = solids_fraction(poured(PeriodicBox{12, 12}, 2000, 0), HeightWindow{3, 8});
  for (const Container& container : {Container{WalledBox{12, 12}}, Container{WalledBox{8, 15}},
                                     Container{Cylinder{13.5}}, Container{Plates{14, 9}}}) {
    const Packing packing = poured(container, 2000, 1);
    CHECK(deepest_overlap_brute_force(packing).depth <= 1e-12);
    CHECK(unsupported(packing) == 0);
    CHECK(on_floor(packing) > 0);
    const double fraction = solids_fraction(packing, {3, 8});
    CHECK(fraction < periodic - 0.01);
    CHECK(fraction > 0.50);
  }
}

TEST_CASE("Pours work in every legal width, however narrow") {
  // Widths at which columns, zigzags and squares just fit are degenerate on purpose.
  const std::vector<double> walled = {
      1,   1 + 1e-9, 1.0001, 1.3, 1.5, 1 + std::sqrt(0.75), 1.99, 2, 2.01, 1 + 2 / std::sqrt(3.0),
      2.5, 3};
  for (const double width : walled) {
    CAPTURE(width);
    const Packing box = poured(WalledBox{width, width}, 300, 2);
    CHECK(deepest_overlap_brute_force(box).depth <= 1e-12);
    const Packing slit = poured(WalledBox{width, 5}, 300, 2);
    CHECK(deepest_overlap_brute_force(slit).depth <= 1e-12);
    CHECK(unsupported(slit) == 0);
    const Packing tube = poured(Cylinder{width}, 300, 2);
    CHECK(deepest_overlap_brute_force(tube).depth <= 1e-12);
  }
  for (const double room : {1e-9, 0.9e-6, 1.1e-6, 1.9e-6, 2.1e-6, 1e-5}) {
    CAPTURE(room);
    const Packing tube = poured(Cylinder{1 + room}, 50, 2);
    CHECK(deepest_overlap_brute_force(tube).depth <= 1e-12);
  }
  for (const double width : {2 + 1e-9, 2.01, 2.3, 2.9, 3.0, 3.7, 4.0}) {
    CAPTURE(width);
    const Packing packing = poured(PeriodicBox{width, width + 0.5}, 300, 3);
    CHECK(deepest_overlap_brute_force(packing).depth <= 1e-12);
    for (const Vec3& r : packing.centres) {
      CHECK((r.x >= 0 && r.x < width && r.y >= 0 && r.y < width + 0.5));
    }
  }
}

TEST_CASE(
    "Slits and tubes one to two diameters wide have a place for every sphere, whatever the key") {
  // A sphere can come to rest between a side and a sphere at its own height, but for rounding.
  std::vector<Container> narrow = {Plates{3, 1}, Plates{5, 1}, Plates{5, 1.5}, WalledBox{2.5, 1}};
  for (const double width : {1.0, 1 + 1e-9, 1.0001, 1.01, 1.2, 1.5, 1.7, 2.0}) {
    for (const double length : {3.0, 5.0, 5.5}) narrow.emplace_back(WalledBox{width, length});
    if (width > 1.00001) narrow.emplace_back(Cylinder{width});  // else one column
  }
  for (const Container& container : narrow) {
    CAPTURE(Boundary(container).width_x, Boundary(container).width_y);
    for (std::uint64_t key = 0; key < 10; ++key) {
      CAPTURE(key);
      const Packing packing = poured(container, 300, 0, key);
      CHECK(deepest_overlap(packing).depth <= 1e-12);
      CHECK(unsupported(packing) == 0);
    }
  }
}

TEST_CASE("A tube and a box of width 1 hold a single column") {
  for (const Container& container : {Container{Cylinder{1}}, Container{WalledBox{1, 1}}}) {
    const Packing packing = poured(container, 50, 0);
    for (std::size_t i = 0; i < packing.centres.size(); ++i) {
      CHECK(packing.centres[i].z == Approx(0.5 + static_cast<double>(i)).epsilon(1e-12));
    }
  }
}

TEST_CASE("In a tube of less than 2 diameters spheres lean on opposite sides in turn") {
  // Height gained by each: sqrt(1 - (D - 1)^2).
  const double diameter = 1.6;
  const Packing packing = poured(Cylinder{diameter}, 40, 0);
  for (std::size_t i = 2; i < packing.centres.size(); ++i) {
    const double rise = packing.centres[i].z - packing.centres[i - 1].z;
    CHECK(rise == Approx(std::sqrt(1 - 0.6 * 0.6)).margin(1e-6));
  }
}

TEST_CASE("Pours depend on the stream alone") {
  const Container box = WalledBox{6, 6};
  CHECK(poured(box, 300, 4).centres == poured(box, 300, 4).centres);
  CHECK_FALSE(poured(box, 300, 4).centres == poured(box, 300, 5).centres);
}

TEST_CASE("Pours that cannot be are refused") {
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  CHECK_THROWS_WITH(make_start(SteepestDescentPour{}, FullyPeriodicBox{}, 10, random),
                    Catch::Contains("neither floor"));
  CHECK_THROWS_WITH(make_start(SteepestDescentPour{}, PeriodicBox{16, 16}, 0, random),
                    Catch::Contains("at least one"));
  CHECK_THROWS_AS(make_start(SteepestDescentPour{}, PeriodicBox{2, 16}, 10, random), StartError);
}

}  // namespace jostle
