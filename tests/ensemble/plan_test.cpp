#include "ensemble/plan.hpp"

#include <catch2/catch.hpp>

using namespace jostle;

TEST_CASE("The taps of a plan are numbered through its stages") {
  Plan plan;
  CHECK(total_taps(plan) == 0);
  plan.protocol = {{Dilate{.epsilon = 0.1}, 2}, {Lift{}, 0}, {Lift{.gamma = 0.3}, 1}};
  CHECK(total_taps(plan) == 3);
  CHECK(tap_number(plan, 1) == Tap{Dilate{.epsilon = 0.1}});
  CHECK(tap_number(plan, 2) == Tap{Dilate{.epsilon = 0.1}});
  CHECK(tap_number(plan, 3) == Tap{Lift{.gamma = 0.3}});
}
