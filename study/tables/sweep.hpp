#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/scene.hpp"
#include "ensemble/analysis/table.hpp"
#include "ensemble/statistics/student_tests.hpp"
#include "results/results_file.hpp"

namespace jostle::inline study {

class PointScenes;

/// Tables just made of a file, not yet stored in it.
struct MadeTables {
  std::vector<Table> fits = {}, analyses = {};
};

/// What a kept fit gives to a curve of a parameter against what is swept.
struct ParameterPoint {
  double value;          // NaN without one
  ErrorOf error;         // Student's t makes the longer side of its 68 % interval of it
  std::string no_value;  // why there is none
};

/// A value where the 95 % interval is closed; what has no limit on one side is no point of a curve.
/// None of a table that has no such parameter.
std::optional<ParameterPoint> parameter_point(const Table& fit, const std::string& name);

/// Where a sweep point stands on a curve.
struct SweptPlace {
  double x = 0;
  std::string name, units;  // of x: a strength of taps as its control parameter
  std::string others;       // values of the sweep that do not vary with it
};

/// `against`: JSON pointer, or the name of what is swept; empty: the first of the sweep, the
/// strength of the taps without one. Throws BadInput.
SweptPlace swept_place(const StudyPoint& swept, const PointScenes& scenes, std::uint32_t point,
                       const std::string& against);

/// Quantities against the swept value, sweep/<observable>/<quantity> with '_' for '/': over the
/// points of all files together, each file with its own sweep or none. A strength of taps is drawn
/// as its control parameter, eps^(1/2) for a dilation. Where other values are swept too, one table
/// for every combination of them, numbered. Fits and analyses are taken from `made`, of the first
/// file, else from what the files keep. What is not possible, as of an observable that there is
/// not, gives a table with the note "refused" alone. Throws ResultsError.
std::vector<Table> sweep_tables(std::span<const ResultsFile* const> files, const MadeTables& made,
                                const std::vector<AnalysisRequest<SweepSettings>>& requests);

}  // namespace jostle::inline study
