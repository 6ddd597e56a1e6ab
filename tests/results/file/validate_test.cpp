#include "results/file/validate.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "results/hdf5/handle.hpp"
#include "tests/results/synthetic.hpp"

using namespace jostle;

TEST_CASE("A restart state is used only where a realization could have stopped so") {
  const StudyPoint point = synthetic::study().points[0];
  RealizationState state;
  state.rows = 1;
  state.centres.assign(point.n_spheres, Vec3{1, 1, 1});
  state.observable_windows.assign(point.observables.size(), HeightWindow{0, 1});
  CHECK_NOTHROW(validate(state, point));
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (const HeightWindow window : {HeightWindow{1, 0}, HeightWindow{none, 1},
                                    HeightWindow{0, std::numeric_limits<double>::infinity()}}) {
    RealizationState forged = state;
    forged.observable_windows.back() = window;
    CHECK_THROWS_AS(validate(forged, point), Hdf5Error);
  }
  // While the start comes to rest nothing is measured yet.
  RealizationState starting = state;
  starting.rows = 0;
  starting.relaxing = true;
  CHECK_THROWS_AS(validate(starting, point), Hdf5Error);
  starting.observable_windows.clear();
  CHECK_NOTHROW(validate(starting, point));
  starting.rows = 1;
  CHECK_THROWS_AS(validate(starting, point), Hdf5Error);
  // The motion is followed as far as the taps go, where the study asks for it.
  StudyPoint followed = point;
  followed.motion =
      MotionSettings{.origins = {0, 3}, .lags = {1, 2}, .overlap_lengths = {0.1}, .layers = 2};
  CHECK_THROWS_AS(validate(state, followed), Hdf5Error);
  RealizationState following = state;
  following.rows = 3;
  following.motion.emplace();
  following.motion->unwrapped = state.centres;
  following.motion->origins = {
      {0, state.centres, std::vector<double>(2 * n_motion_values(*followed.motion))}};
  CHECK_NOTHROW(validate(following, followed));
  CHECK_THROWS_AS(validate(following, point), Hdf5Error);
  const auto refuses = [&](const auto& forge) {
    RealizationState forged = following;
    forge(*forged.motion);
    CHECK_THROWS_AS(validate(forged, followed), Hdf5Error);
  };
  refuses([](MotionState& motion) { motion.unwrapped.pop_back(); });
  refuses([](MotionState& motion) { motion.unwrapped[0].x = none; });
  refuses([](MotionState& motion) { motion.origins[0].tap = 1; });
  refuses([](MotionState& motion) { motion.origins[0].centres.clear(); });
  refuses([](MotionState& motion) { motion.origins[0].values.push_back(0); });
  refuses([](MotionState& motion) { motion.origins.push_back(motion.origins[0]); });
  state.centres.back().z = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(validate(state, point), Hdf5Error);
}
