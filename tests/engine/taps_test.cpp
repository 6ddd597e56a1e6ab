#include "engine/taps.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "engine/starts/starts.hpp"
#include "sample_packings.hpp"

using namespace jostle;

namespace {

Packing excited(Packing packing, const Tap& tap) {
  RandomStream random(stream_key(9, 0, 0, Purpose::tap));
  excite(packing, tap, random);
  return packing;
}

}  // namespace

TEST_CASE("taps displace heights as published") {
  const Packing packing{PeriodicBox{4, 4}, {{1, 1, 0.5}, {3, 3, 10.5}}};
  CHECK(excited(packing, Dilate{0.02}).centres[0].z == Approx(0.51));
  CHECK(excited(packing, Dilate{0.02}).centres[1].z == Approx(10.71));
  CHECK(excited(packing, DilateFloorHeld{0.025}).centres[0].z == 0.5);
  CHECK(excited(packing, DilateFloorHeld{0.025}).centres[1].z == Approx(10.75));
  CHECK(excited(packing, Lift{0.25}).centres[0].z == 0.75);
  CHECK(excited(packing, Lift{0.25}).centres[1].z == 10.75);
}

TEST_CASE("figures know the control parameter of every tap by its name") {
  const auto is_known = [](const Tap& tap) {
    return std::ranges::count(control_symbols(), control(tap).name, &ControlSymbol::name) == 1;
  };
  [&]<class... Taps>(std::type_identity<std::variant<Taps...>>) {
    const bool all_known = (is_known(Taps{}) && ...);
    CHECK(all_known);
  }(std::type_identity<Tap>{});
  CHECK(is_known(HalfSine{.kind = FloorStrength::acceleration}));

  CHECK(tap_symbol("lift") == "γ");
  CHECK(tap_symbol("shake").empty());
  CHECK(displacing_taps() ==
        std::vector<std::string_view>{"dilate", "dilate_floor_held", "lift", "shake"});
}

TEST_CASE("a dilation of 1.025 about the floor spheres lifts a 0.567 bed like gamma = 0.25") {
  // Rosato et al. 2010, fig. 2: the same increase of potential energy. A uniform bed of mean height
  // 10.6 d gains 0.025 x (10.6 - 0.5) = 0.2525 d.
  Packing bed{PeriodicBox{12, 12}, {}};
  for (int k = 0; k < 1000; ++k) bed.centres.push_back({1, 1, 0.5 + 20.2 * (k + 0.5) / 1000});
  const double gain = mean_height(excited(bed, DilateFloorHeld{0.025})) - mean_height(bed);
  CHECK(gain == Approx(0.2525).epsilon(1e-10));
}

TEST_CASE("no tap creates an overlap beyond rounding") {
  for (const Container& container : {Container{PeriodicBox{5, 5}}, Container{WalledBox{5, 5}},
                                     Container{Cylinder{5.5}}, Container{Plates{5, 5}}}) {
    const Packing packing = random_packing(container, 60, 8, 4);
    for (const Tap& tap : {Tap{Dilate{0.1}}, Tap{DilateFloorHeld{0.1}}, Tap{Lift{0.3}},
                           Tap{Shake{0.05, 0.3, 5}}, Tap{Dilate{0}}, Tap{Dilate{1e-16}}}) {
      const Packing packing_after = excited(packing, tap);
      CHECK(deepest_overlap_brute_force(packing_after).depth <= overlap_bound(packing_after));
    }
  }
}

TEST_CASE("no tap of a mixture creates an overlap beyond rounding") {
  for (const double ratio : {1.4, 4.0, 10.0}) {
    for (const Container& container : {Container{PeriodicBox{7, 7}}, Container{WalledBox{5, 5}},
                                       Container{Cylinder{5.5}}, Container{Plates{7, 5}}}) {
      const Packing packing = random_mixture(container, graded_diameters(60, 0.3, ratio), 6, 4);
      for (const Tap& tap : {Tap{Dilate{0.1}}, Tap{DilateFloorHeld{0.1}}, Tap{Lift{0.3}},
                             Tap{Shake{0.05, 0.3, 5}}, Tap{Dilate{1e-16}}}) {
        const Packing packing_after = excited(packing, tap);
        CHECK(deepest_overlap_brute_force(packing_after).depth <= overlap_bound(packing_after));
        CHECK(packing_after.sizes == packing.sizes);
      }
    }
  }
}

TEST_CASE("a dilation about the floor holds the smallest radius for all spheres of a mixture") {
  // A small sphere leans on a large one, both on the floor. Held about its own radius each would
  // stay, and nothing would be gained; about 1/2 the small one would sink into the floor.
  Packing pair{PeriodicBox{9, 9}, {{2, 2, 1}, {2 + std::sqrt(1.0), 2, 0.25}}};
  pair.sizes = std::make_shared<const Sizes>(std::vector<double>{2, 0.5});
  REQUIRE(deepest_overlap_brute_force(pair).depth == 0);
  const Packing packing_after = excited(pair, DilateFloorHeld{0.1});
  CHECK(packing_after.centres[1].z == 0.25);
  CHECK(packing_after.centres[0].z == Approx(1 + 0.75 * 0.1));
  CHECK(deepest_overlap_brute_force(packing_after).depth == 0);
  // A large sphere on top of a small one: held about its own radius it would rise by less than
  // what carries it, and overlap it.
  Packing tower{PeriodicBox{9, 9}, {{2, 2, 0.25}, {2, 2, 1.5}, {2, 2, 2.75}}};
  tower.sizes = std::make_shared<const Sizes>(std::vector<double>{0.5, 2, 0.5});
  CHECK(deepest_overlap_brute_force(excited(tower, DilateFloorHeld{0.5})).depth == 0);
}

TEST_CASE("sizes of diameter 1 change no tap") {
  Packing equal = random_packing(WalledBox{5, 5}, 60, 8, 4), forced = equal;
  forced.sizes = std::make_shared<const Sizes>(std::vector<double>(60, 1.0));
  for (const Tap& tap :
       {Tap{Dilate{0.1}}, Tap{DilateFloorHeld{0.1}}, Tap{Lift{0.3}}, Tap{Shake{0.05, 0.3, 5}}}) {
    CHECK(excited(forced, tap).centres == excited(equal, tap).centres);
  }
}

TEST_CASE("taps of a touching bed leave overlaps of rounding only") {
  RandomStream random(stream_key(12, 0, 0, Purpose::start));
  const PeriodicBox box{6, 6.928203230275509};
  for (const Packing& packing : {make_start(Crystal{}, box, 480, random),
                                 make_start(SteepestDescentPour{}, box, 300, random)}) {
    for (const Tap& tap : {Tap{Dilate{0}}, Tap{Dilate{1e-16}}, Tap{Dilate{1e-8}}, Tap{Dilate{10}},
                           Tap{DilateFloorHeld{0.025}}, Tap{Lift{1e-12}}, Tap{Lift{0.3}},
                           Tap{Lift{100}}, Tap{Shake{0.02, 0.1, 3}}}) {
      const Packing packing_after = excited(packing, tap);
      CHECK(deepest_overlap_brute_force(packing_after).depth <= overlap_bound(packing_after));
    }
  }
}

TEST_CASE("a shake offsets spheres inside its disc and counts those it could not") {
  RandomStream random(stream_key(10, 0, 0, Purpose::tap));
  Packing packing = random_packing(PeriodicBox{6, 6}, 40, 6, 5);
  const Packing packing_before = packing;
  const TapReport report = excite(packing, Shake{0.1, 0.2, 3}, random);
  std::uint64_t unmoved = 0;
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const Vec3 moved = separation(PeriodicBox{6, 6}, packing.centres[i], packing_before.centres[i]);
    CHECK(moved.x * moved.x + moved.y * moved.y <= 0.2 * 0.2 * (1 + 1e-12));
    CHECK(packing.centres[i].z == packing_before.centres[i].z * 1.1);
    unmoved += moved.x == 0 && moved.y == 0;
  }
  CHECK(report.lateral_offsets_dropped == unmoved);

  // A sphere held by a tube of its own width can go nowhere.
  Packing column{Cylinder{1}, {{0.5, 0.5, 0.5}}};
  CHECK(excite(column, Shake{0, 0.2, 3}, random).lateral_offsets_dropped == 1);
}

TEST_CASE("a shake moves grains that press into the floor, a wall and each other") {
  RandomStream random(stream_key(11, 0, 0, Purpose::tap));
  const Vec3 pressed{0.4998, 5, 0.4999}, neighbour{1.4997, 5, 0.4999};
  int dropped = 0;
  for (int i = 0; i < 200; ++i) {
    Packing packing{WalledBox{10, 10}, {pressed, neighbour, {6, 6, 0.4999}}};
    dropped += static_cast<int>(excite(packing, Shake{0, 0.2, 20}, random).lateral_offsets_dropped);
    CHECK(packing.centres[0].x >= pressed.x);
    const double gap = std::hypot(packing.centres[1].x - packing.centres[0].x,
                                  packing.centres[1].y - packing.centres[0].y);
    CHECK(gap >= neighbour.x - pressed.x);
    CHECK(packing.centres[2].x != 6);
  }
  CHECK(dropped < 200);  // the sphere between wall and neighbour may find no room
}

TEST_CASE("a shake takes spheres in random order, so that their numbers decide nothing") {
  // One sphere at a wall, one just beside it with room beyond: if that goes first, the one at the
  // wall finds room more often. In the order of numbers its share of dropped offsets is 0.955 as
  // the first and 0.646 as the second; in random order it is 0.80 either way.
  constexpr int shakes = 20'000;
  const std::array<Vec3, 2> held{Vec3{0.5, 1.5, 0.5}, Vec3{1.5001, 1.5, 0.5}};
  std::array<double, 2> dropped{};
  RandomStream random(stream_key(11, 0, 0, Purpose::tap));
  for (const std::size_t number : {0u, 1u}) {
    for (int shake = 0; shake < shakes; ++shake) {
      Packing packing{WalledBox{4, 3}, {held[number], held[1 - number]}};
      excite(packing, Shake{0, 0.2, 1}, random);
      dropped[number] += packing.centres[number] == held[0] ? 1.0 / shakes : 0;
    }
  }
  const double share = 0.5 * (dropped[0] + dropped[1]);
  const double error = std::sqrt(2 * share * (1 - share) / shakes);
  CAPTURE(dropped[0], dropped[1], error);
  CHECK(std::abs(dropped[0] - dropped[1]) <= 3 * error);
}

TEST_CASE("a shake drops as many offsets at any height, in whatever order spheres were poured") {
  constexpr std::size_t n = 300, quarters = 4;
  constexpr std::uint64_t beds = 50;
  // Dropped offsets by height, of beds numbered from below less the same numbered from above.
  std::array<std::array<double, beds>, quarters> differences{};
  for (std::uint64_t bed = 0; bed < beds; ++bed) {
    RandomStream start(stream_key(5, 0, bed, Purpose::start));
    Packing packing = make_start(SteepestDescentPour{}, PeriodicBox{6, 6}, n, start);
    std::ranges::sort(packing.centres, {}, &Vec3::z);
    for (const bool from_below : {true, false}) {
      Packing shaken = packing;
      if (!from_below) std::ranges::reverse(shaken.centres);
      const Packing packing_before = shaken;
      RandomStream tap(stream_key(5, 0, bed, Purpose::tap));
      excite(shaken, Shake{0.02, 0.1, 3}, tap);
      for (std::size_t i = 0; i < n; ++i) {
        const bool dropped = shaken.centres[i].x == packing_before.centres[i].x;
        const std::size_t quarter = (from_below ? i : n - 1 - i) * quarters / n;
        differences.at(quarter).at(bed) += (from_below ? 1.0 : -1.0) * (dropped ? 1 : 0);
      }
    }
  }
  for (const auto& of_beds : differences) {
    double sum = 0, squares = 0;
    for (const double difference : of_beds) {
      sum += difference;
      squares += difference * difference;
    }
    const double mean = sum / beds, error = std::sqrt((squares / beds - mean * mean) / (beds - 1));
    CAPTURE(mean, error);
    CHECK(std::abs(mean) <= 3 * error);
  }
}
