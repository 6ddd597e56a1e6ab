#include "study/running/scene_warnings.hpp"

#include <catch2/catch.hpp>

#include "tests/monte_carlo_plan.hpp"

using namespace jostle;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

LoadedScene scene_of(Plan plan) {
  LoadedScene loaded;
  loaded.scene.realizations = 1;
  plan.container = PeriodicBox{4, 4};
  plan.n_spheres = 20;
  loaded.plans = {std::move(plan)};
  return loaded;
}

std::vector<std::string> warnings_of_taps(std::vector<Stage> protocol) {
  Plan plan;
  plan.protocol = std::move(protocol);
  return scene_warnings(scene_of(plan));
}

}  // namespace

TEST_CASE("Settings of the papers are not warned of") {
  CHECK(warnings_of_taps({{Dilate{0.5}, 10},
                          {DilateFloorHeld{0.45}, 10},
                          {Lift{0.5}, 10},
                          {Shake{.lambda = 0.1}, 10},
                          {HalfSine{0.4413, 7.5}, 10},
                          {Vibration{0.48, 90, 10}, 1}})
            .empty());
}

TEST_CASE("Strengths that look like other units are warned of, each once") {
  for (const Tap& tap : {Tap{Dilate{2}}, Tap{DilateFloorHeld{2}}, Tap{Shake{.lambda = 2}}}) {
    const auto warnings = warnings_of_taps({{tap, 10}, {tap, 5}});
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], Contains("2 percent are 0.02"));
  }
  CHECK_THAT(warnings_of_taps({{Lift{20}, 1}}).at(0), Contains("20 diameters above the floor"));
  CHECK_THAT(warnings_of_taps({{HalfSine{8, 10}, 1}}).at(0),
             Contains("half_sine") && Contains("8"));
  CHECK_THAT(warnings_of_taps({{Vibration{8, 10, 1}, 1}}).at(0), Contains("vibration"));
}

TEST_CASE("Scenes without random numbers are warned of") {
  Plan plan;
  plan.engine = DiscreteElement{};
  plan.start = Crystal{};
  plan.protocol = {{HalfSine{0.4413, 7.5}, 10}};
  const auto warnings = [&](std::uint32_t realizations) {
    LoadedScene loaded = scene_of(plan);
    loaded.scene.realizations = realizations;
    return scene_warnings(loaded);
  };
  REQUIRE(warnings(4).size() == 1);
  CHECK_THAT(warnings(4)[0], StartsWith("/realizations: nothing is random in this scene") &&
                                 Contains("from a crystal make 4 identical realizations"));
  CHECK(warnings(1).empty());
  plan.start = GivenPacking{std::make_shared<const std::vector<Vec3>>(20, Vec3{1, 1, 1})};
  CHECK_THAT(warnings(2).at(0), Contains("from a file make 2 identical realizations"));
  plan.protocol = {{Shake{.lambda = 0.1, .lateral_radius = 0.05}, 10}};
  CHECK(warnings(4).empty());
  plan.protocol = {{Shake{.lambda = 0.1, .lateral_radius = 0}, 10}};
  CHECK(warnings(4).size() == 1);
  plan.start = RandomSettle{};
  CHECK(warnings(4).empty());
  plan.start = Crystal{};
  plan.engine = MonteCarlo{};
  CHECK(warnings(4).empty());
}

TEST_CASE("Angles in degrees, boulders and rests beyond the cap are warned of") {
  Plan plan;
  monte_carlo(plan).relax.move = PolarMove{.theta0 = 45};
  CHECK_THAT(scene_warnings(scene_of(plan)).at(0),
             StartsWith("/relax: ") && Contains("45 degrees are 0.7854"));
  DiscreteElement grains;
  grains.diameter = 20;
  plan.engine = grains;
  CHECK_THAT(scene_warnings(scene_of(plan)).at(0), Contains("20 m is a boulder"));
  grains = {};
  grains.rest = TimedRest{10};
  grains.most_seconds = 4;
  plan.engine = grains;
  CHECK_THAT(scene_warnings(scene_of(plan)).at(0), Contains("every tap will be"));
}

TEST_CASE("Densities and accelerations in units of the CGS system are warned of") {
  Plan plan;
  const auto warnings = [&](double density, double gravity) {
    DiscreteElement grains;
    grains.density = density;
    grains.gravity = gravity;
    plan.engine = grains;
    return scene_warnings(scene_of(plan));
  };
  CHECK(warnings(1200, 9.81).empty());
  CHECK(warnings(30, 1.62).empty());
  REQUIRE(warnings(2.5, 9.81).size() == 1);
  CHECK_THAT(warnings(2.5, 9.81)[0],
             Contains("in kg/m^3, and 2.5 is less") && Contains("2.5 g/cm^3 are 2500"));
  REQUIRE(warnings(1200, 981).size() == 1);
  CHECK_THAT(warnings(1200, 981)[0], Contains("in m/s^2, and 981 is 100 times that of the Earth") &&
                                         Contains("981 cm/s^2 are 9.81"));
}

TEST_CASE("Floors that are too fast for the stiffness are warned of") {
  Plan plan;
  plan.engine = DiscreteElement{};
  plan.protocol = {{HalfSine{3, 30}, 10}};
  const auto warnings = scene_warnings(scene_of(plan));
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], StartsWith("/protocol: ") && Contains("raise the stiffness"));
}

TEST_CASE("At most fifty warnings are listed, and terabytes of results are one") {
  std::vector<Stage> ramp;
  for (int i = 1; i <= 60; ++i) ramp.push_back({Dilate{1.0 + i}, 1});
  const auto warnings = warnings_of_taps(ramp);
  REQUIRE(warnings.size() == 51);
  CHECK(warnings.back() == "... and 10 more");
  Plan plan;
  plan.protocol = {{Dilate{0.1}, 1'000'000}};
  plan.snapshots.taps = {1};
  LoadedScene loaded = scene_of(plan);
  loaded.scene.realizations = 1'000'000;
  CHECK_THAT(scene_warnings(loaded).back(), Contains("of disk"));
}
