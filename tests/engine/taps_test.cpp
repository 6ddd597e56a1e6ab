#include "engine/taps.hpp"

#include <catch2/catch.hpp>

#include "engine/starts.hpp"
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

TEST_CASE("a dilation of 1.025 about the floor spheres lifts a 0.567 bed like gamma = 0.25") {
  // Rosato et al. 2010, fig. 2: the same increase of potential energy. A uniform bed of mean height
  // 10.6 d gains 0.025 x (10.6 - 0.5) = 0.2525 d.
  Packing bed{PeriodicBox{12, 12}, {}};
  for (int k = 0; k < 1000; ++k) bed.centres.push_back({1, 1, 0.5 + 20.2 * (k + 0.5) / 1000});
  const double gain = mean_height(excited(bed, DilateFloorHeld{0.025})) - mean_height(bed);
  CHECK(gain == Approx(0.2525).epsilon(1e-10));
}

TEST_CASE("no tap creates an overlap beyond rounding") {
  for (const Container& container :
       {Container{PeriodicBox{5, 5}}, Container{WalledBox{5, 5}}, Container{Cylinder{5.5}}}) {
    const Packing packing = random_packing(container, 60, 8, 4);
    for (const Tap& tap : {Tap{Dilate{0.1}}, Tap{DilateFloorHeld{0.1}}, Tap{Lift{0.3}},
                           Tap{Shake{0.05, 0.3, 5}}, Tap{Dilate{0}}, Tap{Dilate{1e-16}}}) {
      const Packing after = excited(packing, tap);
      CHECK(deepest_overlap_brute_force(after).depth <= overlap_bound(after));
    }
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
      const Packing after = excited(packing, tap);
      CHECK(deepest_overlap_brute_force(after).depth <= overlap_bound(after));
    }
  }
}

TEST_CASE("a shake offsets spheres inside its disc and counts those it could not") {
  RandomStream random(stream_key(10, 0, 0, Purpose::tap));
  Packing packing = random_packing(PeriodicBox{6, 6}, 40, 6, 5);
  const Packing before = packing;
  const TapReport report = excite(packing, Shake{0.1, 0.2, 3}, random);
  std::uint64_t unmoved = 0;
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const Vec3 moved = separation(PeriodicBox{6, 6}, packing.centres[i], before.centres[i]);
    CHECK(moved.x * moved.x + moved.y * moved.y <= 0.2 * 0.2 * (1 + 1e-12));
    CHECK(packing.centres[i].z == before.centres[i].z * 1.1);
    unmoved += moved.x == 0 && moved.y == 0;
  }
  CHECK(report.lateral_offsets_dropped == unmoved);

  // A sphere held by a tube of its own width can go nowhere.
  Packing column{Cylinder{1}, {{0.5, 0.5, 0.5}}};
  CHECK(excite(column, Shake{0, 0.2, 3}, random).lateral_offsets_dropped == 1);
}
