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

TEST_CASE("sizes are drawn per realization, matched over sweep points as starts are") {
  Plan plan;
  plan.seed = 3;
  plan.n_spheres = 60;
  plan.kinds = {{"small", 50, LognormalDiameter{1, 0.1}}, {"large", 10, FixedDiameter{2}, 3}};
  Plan second = plan;
  second.point_id = 77;
  REQUIRE(sizes_of(plan, 0)->size() == 60);
  CHECK(*sizes_of(plan, 0) == *sizes_of(plan, 0));
  CHECK_FALSE(*sizes_of(plan, 0) == *sizes_of(plan, 1));
  CHECK_FALSE(*sizes_of(plan, 0) == *sizes_of(second, 0));
  CHECK(has_drawn_sizes(plan));
  plan.streams = second.streams = Streams::matched;
  CHECK(*sizes_of(plan, 4) == *sizes_of(second, 4));
  plan.kinds[0].diameter = FixedDiameter{1};
  CHECK_FALSE(has_drawn_sizes(plan));
  CHECK(*sizes_of(plan, 0) == *sizes_of(plan, 1));
  plan.kinds = {};
  CHECK(sizes_of(plan, 0) == nullptr);
}

TEST_CASE("places are those of the spheres of their kinds") {
  Plan plan;
  plan.kinds = {{"a", 3}, {"intruder", 1, FixedDiameter{2}, 1, {{4, 5}}}, {"b", 2}};
  plan.n_spheres = 6;
  plan.pour_order = PourOrder::large_first;
  const StartSpheres spheres = start_spheres(plan, sizes_of(plan, 0));
  CHECK(spheres.placed == std::vector<PlacedSphere>{{3, 4, 5}});
  CHECK(spheres.order == PourOrder::large_first);
  CHECK(spheres.n == 6);
}
