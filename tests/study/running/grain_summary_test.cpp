#include "study/running/grain_summary.hpp"

#include <catch2/catch.hpp>

using namespace jostle;
using Catch::Matchers::Contains;

namespace {

/// Acrylic spheres of 2 cm: 5.0265 g each.
Plan grains(std::vector<Stage> protocol) {
  Plan plan;
  plan.container = PeriodicBox{4, 4};
  plan.n_spheres = 20;
  plan.engine = DiscreteElement{};
  plan.protocol = std::move(protocol);
  return plan;
}

}  // namespace

// By hand. Two spheres of mass m on latched springs: half a period of the spring K1 while they
// approach, half a period of K1 / e^2 while they part, a reduced mass m / 2.
// (pi/2) (1 + 0.9) sqrt(5.0265e-3 / (2 * 1e5)) = 4.73e-4 s.
TEST_CASE("The summary of grains agrees with a calculation by hand") {
  const auto lines = grain_summary(grains({{HalfSine{0.4413, 7.5}, 10}}));
  REQUIRE(lines.size() == 2);
  CHECK_THAT(lines[0], Contains("contact time 0.000473 s, time step "));
  // 0.4413 * 0.02 m * (2 pi 7.5 Hz)^2 / (9.81 m/s^2); 0.4413 * 0.02 m * 2 pi 7.5 Hz.
  CHECK_THAT(lines[1], Contains("Gamma 1.998, floor speed 0.416 m/s"));
  // 0.416 m/s * sqrt(5.0265e-3 / 2e5) / 0.02 m.
  CHECK_THAT(
      lines[1],
      Contains("overlap 0.0033 d where two spheres meet at it and up to some 0.013 in beds") &&
          !Contains("stiffness"));
}

// Two spheres of 4 d have 64 times the mass: sqrt(64) / 4 = 2 times the overlap over their
// diameter.
TEST_CASE("Overlaps in a mixture are judged by the diameters of the spheres that meet") {
  Plan plan = grains({{HalfSine{0.4413, 7.5}, 10}});
  plan.container = PeriodicBox{10, 10};
  plan.kinds = {{"small", 18, FixedDiameter{1}}, {"large", 2, FixedDiameter{4}}};
  const auto lines = grain_summary(plan);
  CHECK_THAT(lines.at(1), Contains("overlap 0.0066 of their diameter where two like spheres meet"));
}

TEST_CASE("An acceleration is the amplitude that it asks for") {
  const auto lines = grain_summary(grains({{HalfSine{2, 7.5, FloorStrength::acceleration}, 10}}));
  // 2 * 9.81 m/s^2 / (2 pi 7.5 Hz)^2 / 0.02 m.
  CHECK_THAT(lines.at(1), Contains("a = 0.4418 d, f = 7.5 Hz: Gamma 2.000"));
}

TEST_CASE("Equal taps are listed once, too many are counted, too fast ones warned of") {
  CHECK(grain_summary(grains({{HalfSine{0.1, 10}, 5}, {Dilate{0.1}, 5}, {HalfSine{0.1, 10}, 7}}))
            .size() == 2);
  CHECK(grain_summary(grains({{HalfSine{0.1, 10}, 0}})).size() == 1);
  std::vector<Stage> ramp;
  for (int i = 1; i <= 9; ++i) ramp.push_back({HalfSine{0.1 * i, 10}, 3});
  const auto lines = grain_summary(grains(ramp));
  REQUIRE(lines.size() == 7);
  CHECK(lines.back() == "... and 4 more taps");
  const Plan fast = grains({{Vibration{0.48, 1000, 4}, 1}, {Vibration{0.48, 1000, 4}, 2}});
  const auto warnings = overlap_warnings(fast);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("beds fail at 0.2: raise the stiffness"));
  // 4 times 60.3 m/s * sqrt(5.0265e-3 / 2e5) / 0.02 m.
  CHECK_THAT(warnings[0],
             Contains("amplitude 0.48 d and frequency 1000 Hz") && Contains("up to some 1.9 d"));
  CHECK_THAT(grain_summary(fast).at(1), Contains("and up to some 1.9 in beds"));
  CHECK(overlap_warnings(grains({{HalfSine{0.4413, 7.5}, 10}, {Dilate{0.1}, 1}})).empty());
  Plan monte_carlo = grains({{Dilate{0.1}, 5}});
  monte_carlo.engine = MonteCarlo{};
  CHECK(grain_summary(monte_carlo).empty());
  CHECK(overlap_warnings(monte_carlo).empty());
}
