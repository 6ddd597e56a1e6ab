#include "engine/bed/packing.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "engine/bed/geometry.hpp"
#include "tests/engine/sample_packings.hpp"

using namespace jostle;

TEST_CASE("a coordinate on the seam wraps to the same place") {
  CHECK(wrap_coordinate(-5e-17, 16) == 0);
  CHECK(wrap_coordinate(16, 16) == 0);
  CHECK(wrap_coordinate(0, 16) == 0);
  CHECK(wrap_coordinate(16.25, 16) == 0.25);
  CHECK(wrap_coordinate(-0.25, 16) == 15.75);
  const double last = std::nextafter(16.0, 0.0);
  CHECK(wrap_coordinate(last, 16) == last);
}

TEST_CASE("least widths are named") {
  CHECK(width_fault(PeriodicBox{2, 5})->find("least is 2") != std::string::npos);
  CHECK_FALSE(width_fault(PeriodicBox{2.001, 5}));
  CHECK(width_fault(WalledBox{0.999, 5})->find("least is 1") != std::string::npos);
  CHECK_FALSE(width_fault(WalledBox{1, 5}));
  CHECK(width_fault(Cylinder{0.5})->find("least is 1") != std::string::npos);
  CHECK_FALSE(width_fault(Cylinder{1}));
  CHECK(width_fault(Plates{2, 3})->find("periodic width is 2") != std::string::npos);
  CHECK(width_fault(Plates{3, 0.9})->find("between walls is 0.9") != std::string::npos);
  CHECK_FALSE(width_fault(Plates{2.1, 1}));
  CHECK(width_fault(FullyPeriodicBox{5, 5, 1})->find("height") != std::string::npos);
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  for (const Container& container :
       {Container{PeriodicBox{no_number, 5}}, Container{PeriodicBox{5, no_number}},
        Container{WalledBox{no_number, 5}}, Container{WalledBox{5, no_number}},
        Container{Cylinder{no_number}}, Container{FullyPeriodicBox{5, 5, no_number}},
        Container{Plates{no_number, 5}}, Container{Plates{5, no_number}}}) {
    CAPTURE(container.index());
    CHECK(width_fault(container));
  }
}

TEST_CASE("the deepest overlap is found across seams, floors and walls") {
  const Packing seam{PeriodicBox{4, 4}, {{0.1, 0.1, 1}, {3.7, 3.9, 1.2}}};
  const Overlap pair = deepest_overlap_brute_force(seam);
  CHECK(pair.depth == Approx(1 - std::sqrt(0.16 + 0.04 + 0.04)));
  CHECK((pair.first == 0 && pair.second == 1));
  CHECK(deepest_overlap_brute_force({PeriodicBox{4, 4}, {{1, 1, 0.4}}}).depth == Approx(0.1));
  CHECK(deepest_overlap_brute_force({WalledBox{4, 4}, {{3.7, 1, 1}}}).depth == Approx(0.2));
  CHECK(deepest_overlap_brute_force({Cylinder{4}, {{2, 3.9, 1}}}).depth == Approx(0.4));
  const std::vector<Vec3> across = {{0.1, 2, 1}, {3.7, 2, 1.2}}, at_plate = {{0.1, 3.7, 1}};
  CHECK(deepest_overlap_brute_force({Plates{4, 4}, across}).depth ==
        Approx(1 - std::sqrt(0.16 + 0.04)));
  CHECK(deepest_overlap_brute_force({Plates{4, 4}, at_plate}).depth == Approx(0.2));
  CHECK_FALSE(deepest_overlap_brute_force({Plates{4, 4}, {{0.1, 0.5, 0.5}}}).depth > 0);
  CHECK(
      deepest_overlap_brute_force({FullyPeriodicBox{4, 4, 4}, {{1, 1, 0.1}, {1, 1, 3.9}}}).depth ==
      Approx(0.8));
}

TEST_CASE("cells find the same deepest overlap as all pairs") {
  RandomStream random(stream_key(3, 0, 0, Purpose::start));
  for (const Container& container :
       {Container{PeriodicBox{2.1, 7}}, Container{PeriodicBox{9, 9}}, Container{WalledBox{1, 6}},
        Container{Cylinder{5}}, Container{FullyPeriodicBox{3.1, 5, 8}},
        Container{Plates{2.1, 6}}}) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      Packing packing{container, {}};
      const auto* bulk = std::get_if<FullyPeriodicBox>(&container);
      for (int k = 0; k < 30; ++k) {
        packing.centres.push_back({width_x(container) * random.uniform(),
                                   width_y(container) * random.uniform(),
                                   (bulk ? bulk->height : 9) * random.uniform()});
      }
      CHECK(deepest_overlap(packing).depth == deepest_overlap_brute_force(packing).depth);
    }
  }
}
