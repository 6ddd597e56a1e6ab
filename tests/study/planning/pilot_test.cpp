#include "study/planning/pilot.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/bed/boundary.hpp"
#include "tests/monte_carlo_plan.hpp"

using namespace jostle;

namespace {

Plan plan_of(const Container& container, std::uint32_t n_spheres) {
  Plan plan;
  plan.seed = 5;
  plan.container = container;
  plan.n_spheres = n_spheres;
  plan.start = SteepestDescentPour{};
  plan.protocol = {{Dilate{0.02}, 10}};
  monte_carlo(plan).relax.stop.rule = SweepsStop{20};
  return plan;
}

double depth(const CutBed& bed) {
  return bed.n_spheres / footprint_area(bed.container);
}

}  // namespace

TEST_CASE("A large bed is cut to a smaller footprint and keeps its depth") {
  for (const Container& container :
       {Container(PeriodicBox{200, 200}), Container(PeriodicBox{400, 100}),
        Container(WalledBox{200, 200}), Container(Cylinder{220}), Container(Plates{400, 100})}) {
    for (const std::uint32_t n : {20'001u, 40'000u, 1'000'000u, 10'000'000u}) {
      const Plan plan = plan_of(container, n);
      const CutBed bed = cut_down(plan, 20'000);
      CHECK(bed.as_deep);
      CHECK(bed.n_spheres <= 20'100);
      CHECK(bed.n_spheres > 15'000);
      CHECK(depth(bed) == Approx(n / footprint_area(container)).epsilon(1e-3));
      CHECK_FALSE(width_fault(bed.container));
    }
  }
}

TEST_CASE("Beds that are small, from files or without gravity are not cut") {
  CHECK(cut_down(plan_of(PeriodicBox{16, 16}, 20'000), 20'000).n_spheres == 20'000);
  CHECK(cut_down(plan_of(FullyPeriodicBox{40, 40, 40}, 50'000), 20'000).n_spheres == 50'000);
  Plan given = plan_of(PeriodicBox{100, 100}, 50'000);
  given.start = GivenPacking{};
  CHECK(cut_down(given, 20'000).n_spheres == 50'000);
}

TEST_CASE("A narrow column keeps 8 diameters of width, and loses depth where it is very high") {
  const CutBed high = cut_down(plan_of(PeriodicBox{10, 10}, 60'000), 20'000);
  CHECK(std::get<PeriodicBox>(high.container) == PeriodicBox{8, 8});
  CHECK(high.n_spheres == 38'400);
  CHECK(high.as_deep);
  const CutBed higher = cut_down(plan_of(PeriodicBox{10, 10}, 600'000), 20'000);
  CHECK(higher.n_spheres == 100'000);
  CHECK_FALSE(higher.as_deep);
}

TEST_CASE("A crystal is cut to whole rows") {
  Plan hcp = plan_of(PeriodicBox{64, 32 * std::sqrt(3.0)}, 100'000);
  hcp.start = Crystal{Lattice::hcp};
  const CutBed bed = cut_down(hcp, 20'000);
  const auto box = std::get<PeriodicBox>(bed.container);
  CHECK(box.width_x == std::round(box.width_x));
  CHECK(box.width_y / std::sqrt(3.0) == Approx(std::round(box.width_y / std::sqrt(3.0))));
  CHECK(depth(bed) == Approx(100'000 / footprint_area(hcp.container)).epsilon(1e-3));
  CHECK(pilot(hcp, 10'000'000, 5'000).realization.count() > 0);  // the lattice fits
}

TEST_CASE("A ramp is tried at its first, weakest, middle, strongest and last strength") {
  std::vector<Stage> protocol;
  for (const double epsilon : {0.04, 0.01, 0.09, 0.16, 0.25, 0.36, 0.09}) {
    protocol.push_back({Dilate{epsilon}, 3});
  }
  // By the square root of epsilon: 0.2, 0.1, 0.3, 0.4, 0.5, 0.6, 0.3; the middle is 0.35.
  CHECK(piloted_stages(protocol) == std::vector<std::size_t>{0, 1, 2, 5});
  CHECK(piloted_stages({{Lift{0.2}, 1000}}) == std::vector<std::size_t>{0});
  CHECK(piloted_stages({}).empty());
  // Strengths of different kinds are not compared.
  CHECK(piloted_stages({{Lift{0.2}, 10}, {Dilate{0.02}, 10}, {Lift{0.1}, 0}}) ==
        std::vector<std::size_t>{0, 1});
}

TEST_CASE("A ramp costs the sum over its taps") {
  Plan ramp = plan_of(PeriodicBox{6, 6}, 200);
  monte_carlo(ramp).relax.stop.rule = MeanHeightStop{.eta = 1e-4, .every_sweeps = 10};
  const auto sweeps = [&](std::vector<Stage> protocol) {
    ramp.protocol = std::move(protocol);
    const PilotEstimate estimate = pilot(ramp, 1'000'000'000);
    CHECK(estimate.settled);
    return estimate.rounds_per_tap;
  };
  const double weak = sweeps({{Dilate{0.01}, 10}}), strong = sweeps({{Dilate{0.3}, 10}});
  CHECK(strong > 1.5 * weak);  // a bed that is stretched more falls longer
  const double sweeps_of_both = sweeps({{Dilate{0.01}, 30}, {Dilate{0.3}, 10}});
  CHECK(sweeps_of_both > weak);
  CHECK(sweeps_of_both < strong);
}

TEST_CASE("The memory includes the followed motion") {
  Plan plan = plan_of(PeriodicBox{8, 8}, 500);
  const PilotEstimate bare = pilot(plan, 1'000'000);
  plan.motion = MotionSettings{.origins = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9},
                               .lags = {1, 2, 3, 4, 5},
                               .overlap_lengths = {0.05, 0.1},
                               .layers = 20};
  const PilotEstimate measured = pilot(plan, 1'000'000);
  const std::uint64_t followed = motion_bytes(*plan.motion, 500);
  CHECK(followed > 11 * 500 * sizeof(Vec3));
  CHECK(measured.bytes == bare.bytes + 4 * followed);
  // For a bed that is cut for the pilot, the value is that of the whole bed.
  Plan large = plan_of(PeriodicBox{100, 100}, 40'000);
  monte_carlo(large).relax.stop.rule = SweepsStop{1};
  large.protocol = {{Dilate{0.02}, 1}};
  large.motion = plan.motion;
  CHECK(pilot(large, 1'000'000).bytes > 4 * motion_bytes(*plan.motion, 40'000));
}

TEST_CASE("A mixture is cut kind by kind, and keeps at least one sphere of each") {
  Plan plan = plan_of(PeriodicBox{200, 200}, 0);
  std::vector<double> listed(1000, 1.0);
  listed.back() = 3;
  plan.kinds = {{"small", 398'000, LognormalDiameter{1, 0.1}},
                {"listed", 1000, ListedDiameters{listed}},
                {"large", 999, FixedDiameter{4}},
                {"intruder", 1, FixedDiameter{6}, 1, {{100, 50}}}};
  plan.n_spheres = 400'000;
  const CutBed bed = cut_down(plan, 20'000);
  REQUIRE(bed.kinds.size() == 4);
  CHECK(bed.n_spheres == n_spheres_of(bed.kinds));
  CHECK(bed.n_spheres <= 20'100);
  CHECK(bed.kinds[3].count == 1);
  CHECK(bed.kinds[2].count == Approx(50).margin(1));
  CHECK(bed.kinds[0].count == Approx(19'900).epsilon(0.01));
  CHECK(std::get<ListedDiameters>(bed.kinds[1].diameter).values.size() == bed.kinds[1].count);
  const Boundary cut(bed.container);
  CHECK((*bed.kinds[3].place)[0] == Approx(cut.width_x / 2));
  CHECK((*bed.kinds[3].place)[1] == Approx(cut.width_y / 4));
  CHECK_FALSE(width_fault(bed.container, 6));
  CHECK(depth(bed) == Approx(400'000 / 40'000.0).epsilon(1e-2));
}
