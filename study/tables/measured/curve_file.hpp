#pragma once

#include <limits>
#include <string>
#include <vector>

#include "fitting/curve.hpp"
#include "fitting/report.hpp"
#include "study/tables/measured/curve_columns.hpp"

namespace jostle::inline study {

/// The treatment of a t at which some realizations have no value.
enum class Gaps {
  use_others,  // the mean uses those that have one
  drop_row     // it is left out
};

struct CurveReading {
  CurveColumns columns = CurveColumns::errors;
  Gaps gaps = Gaps::use_others;
  double first = -std::numeric_limits<double>::infinity();  // first value of t; others are left out
  double last = std::numeric_limits<double>::infinity();
};

/// A curve of a file, and what a reader must know of how it was read.
struct MeasuredCurve {
  Curve curve;
  std::vector<std::string> notes;  // a sentence each
  CurveUnits units = {};           // units in the heading
};

/// Reads a measured curve from a text file: columns t and X, maybe sigma of X; or t and a column of
/// X per realization, of which the curve is the mean (mean_of_present() where values are missing).
/// A field that is empty, NaN or NA has no value. Columns go by the names of their heading. Throws
/// BadInput naming line, column and name of a fault, and ResultsError where the file cannot be read
/// to its end.
MeasuredCurve read_curve(const std::string& path, const CurveReading& reading = {});

}  // namespace jostle::inline study
