#pragma once

#include <cstdint>
#include <string>

#include "engine/numbers.hpp"
#include "ensemble/analysis/sweeps/sweep_curve.hpp"
#include "results/file/results_file.hpp"

// Where a sweep point lies on a curve against what is swept.
namespace jostle::inline study {

class PointScenes;

/// Place of a sweep point on a curve.
struct SweptPlace {
  double x = not_a_number;
  SweptValue swept;          // name of x; a strength of taps is given by its control parameter
  std::string fixed_values;  // values of the sweep that do not vary with x
};

/// `against`: JSON pointer, or the name of what is swept; empty: the first of the sweep, the
/// strength of the last stage's taps without one. Throws BadInput.
SweptPlace swept_place(const StudyPoint& swept, const PointScenes& scenes, std::uint32_t point,
                       std::string against);

}  // namespace jostle::inline study
