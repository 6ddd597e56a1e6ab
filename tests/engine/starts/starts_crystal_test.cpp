#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "engine/bed/slab.hpp"
#include "engine/starts/starts.hpp"
#include "tests/engine/starts/starts_supports.hpp"

namespace jostle {
namespace {

Packing crystal(Crystal start, const Container& container, std::uint32_t n) {
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  return make_start(start, container, n, random);
}

const double close_packed = std::acos(-1.0) / std::sqrt(18.0);

}  // namespace

TEST_CASE("hcp on its commensurate footprint is close packed") {
  // 14 rows of 12: 168 a layer, 20.57 layers.
  const Packing packing = crystal({Lattice::hcp}, PeriodicBox{12, 12.12435565298214}, 3456);
  CHECK(deepest_overlap_brute_force(packing).depth <= 1e-12);
  const double layer = std::sqrt(2.0 / 3);
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    CHECK(packing.centres[i].z ==
          Approx(0.5 + layer * static_cast<double>(i / 168)).epsilon(1e-14));
  }
  // Whole layer spacings in the bulk, from the middle of one gap to the middle of another.
  const HeightWindow window{0.5 + 2.5 * layer, 0.5 + 17.5 * layer};
  CHECK(solids_fraction(packing, window) == Approx(close_packed).epsilon(1e-9));
  for (std::size_t i = 5 * 168; i < 6 * 168; ++i) CHECK(contacts(packing, i).size() == 12);
  for (std::size_t i = 168; i < packing.centres.size(); ++i) {
    CHECK(carried(contacts(packing, i)));
  }
}

TEST_CASE("fcc on its square face is close packed") {
  const Packing packing = crystal({Lattice::fcc}, PeriodicBox{12, 12}, 3456);
  CHECK(deepest_overlap_brute_force(packing).depth <= 1e-12);
  CHECK(top_height(packing) == Approx(0.5 + 23 * std::sqrt(0.5)).epsilon(1e-14));
  for (std::size_t i = 5 * 144; i < 6 * 144; ++i) CHECK(contacts(packing, i).size() == 12);
}

TEST_CASE("Crystals fill a commensurate fully periodic box") {
  const double layer = std::sqrt(2.0 / 3);
  const FullyPeriodicBox hcp{4, 4 * std::sqrt(3.0) / 2, 4 * layer};
  const Packing full = crystal({Lattice::hcp}, hcp, 64);
  CHECK(deepest_overlap_brute_force(full).depth <= 1e-12);
  for (std::size_t i = 0; i < 64; ++i) CHECK(contacts(full, i).size() == 12);
  CHECK_THROWS_WITH(crystal({Lattice::hcp}, hcp, 65), Catch::Contains("64 sites for 65"));

  const FullyPeriodicBox fcc{4, 4, 6 * std::sqrt(0.5)};
  const Packing packing = crystal({Lattice::fcc}, fcc, 96);
  for (std::size_t i = 0; i < 96; ++i) CHECK(contacts(packing, i).size() == 12);
  CHECK_THROWS_WITH(
      crystal({Lattice::fcc}, FullyPeriodicBox{4, 4, 4}, 64),
      Catch::Contains("layers") && Catch::Contains("2.82") && Catch::Contains("4.24"));
}

TEST_CASE("An incommensurate footprint names the two nearest") {
  CHECK_THROWS_WITH(
      crystal({Lattice::hcp}, PeriodicBox{12, 12}, 100),
      Catch::Contains("12 x 10.392304845413264") && Catch::Contains("12 x 12.12435565298214"));
  CHECK_THROWS_WITH(crystal({Lattice::fcc}, PeriodicBox{12.5, 9}, 100),
                    Catch::Contains("12 x 9") && Catch::Contains("13 x 9"));
  // Too small by more than rounding the rows would overlap.
  CHECK_THROWS_AS(crystal({Lattice::fcc}, PeriodicBox{12 - 1e-8, 12}, 100), StartError);
  // Too large by an invisible amount is spaced out.
  const Packing spaced = crystal({Lattice::fcc}, PeriodicBox{12 + 1e-9, 12}, 500);
  CHECK(deepest_overlap_brute_force(spaced).depth <= 1e-12);
}

TEST_CASE("Stretched rows never overlap, and 12 half-shifted rows on 12 x 12 fill 0.671") {
  const Packing square = crystal({Lattice::hcp, true}, PeriodicBox{12, 12}, 3456);
  CHECK(solids_fraction(square, {2.5, 10.5}) == Approx(0.671).margin(0.01));
  for (const Lattice lattice : {Lattice::hcp, Lattice::fcc}) {
    for (const double x : {2.01, 2.5, 2.99, 3.4, 7.77}) {
      for (const double y : {2.05, 3.3, 3.47, 5.1, 8.2}) {
        const Packing packing = crystal({lattice, true}, PeriodicBox{x, y}, 200);
        CAPTURE(x, y, lattice == Lattice::hcp);
        CHECK(deepest_overlap_brute_force(packing).depth <= 1e-12);
      }
    }
  }
}

TEST_CASE("A crystal between walls leaves out the sites that do not fit") {
  for (const Container& container : {Container{WalledBox{6, 6}}, Container{WalledBox{5.3, 7.7}},
                                     Container{Cylinder{7}}, Container{Plates{6, 5.3}}}) {
    for (const Lattice lattice : {Lattice::hcp, Lattice::fcc}) {
      const Packing packing = crystal({lattice}, container, 250);
      CHECK(packing.centres.size() == 250);
      CHECK(deepest_overlap_brute_force(packing).depth <= 1e-12);
    }
  }
  CHECK_THROWS_WITH(crystal({Lattice::hcp}, WalledBox{1, 1}, 3), Catch::Contains("too narrow"));
  CHECK_THROWS_WITH(crystal({Lattice::hcp, true}, WalledBox{6, 6}, 3),
                    Catch::Contains("periodic sides"));
}

// Whatever site of a layer's lattice lies between the walls is taken.
TEST_CASE("A crystal between walls has every site that fits") {
  const auto sites = GENERATE(std::pair(5.0, 23 + 22), std::pair(8.0, 0), std::pair(6.3, 0));
  const auto [width, two_layers] = sites;
  const Container box = WalledBox{width, width};
  const Packing packing = crystal({Lattice::hcp}, box, 400);
  const double top = packing.centres.back().z;
  const auto has = [&](Vec3 site) {
    return std::ranges::any_of(packing.centres,
                               [&](Vec3 centre) { return norm_squared(centre - site) < 1e-12; });
  };
  int lowest = 0;
  for (const Vec3 centre : packing.centres) {
    lowest += centre.z < 1.4;
    if (centre.z > top - 0.1) continue;  // the last layer is not full
    for (int k = 0; k < 6; ++k) {
      const double angle = std::numbers::pi / 3 * k;
      const Vec3 neighbour = centre + Vec3{std::cos(angle), std::sin(angle), 0};
      CAPTURE(width, neighbour.x, neighbour.y, neighbour.z);
      const bool fits = std::min(neighbour.x, neighbour.y) >= 0.5 - 1e-9 &&
                        std::max(neighbour.x, neighbour.y) <= width - 0.5 + 1e-9;
      if (fits) CHECK(has(neighbour));
    }
  }
  if (two_layers > 0) CHECK(lowest == two_layers);
}

}  // namespace jostle
