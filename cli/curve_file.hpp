#pragma once

#include <string>

#include "fitting/curve.hpp"

namespace jostle {

/// Reads a measured curve from a text file: two columns t, X, or three with the error sigma of X,
/// separated by commas, semicolons, tabs or spaces. Lines that are empty or begin with # are
/// skipped, and one line of column names at the top. Throws BadInput naming the first line that is
/// not so.
Curve read_curve(const std::string& path);

}  // namespace jostle
