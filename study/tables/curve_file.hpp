#pragma once

#include <string>

#include "fitting/curve.hpp"

namespace jostle::inline study {

/// What stands beside t and X.
enum class CurveColumns {
  errors,       // nothing, or sigma of X
  realizations  // X of a second realization, and of any number more
};

/// Reads a measured curve from a text file: two columns t, X, or three with the error sigma of X;
/// or t and a column of X a realization, two or more, of which the curve is the mean. Separated by
/// commas, semicolons, tabs or spaces. Lines that are empty or begin with # are skipped, and one
/// line of column names at the top. Throws BadInput naming the first line that is not so, and
/// ResultsError where the file cannot be read to its end.
Curve read_curve(const std::string& path, CurveColumns columns = CurveColumns::errors);

}  // namespace jostle::inline study
