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
  state.centres.back().z = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(validate(state, point), Hdf5Error);
}
