#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/column.hpp"
#include "engine/numbers.hpp"
#include "ensemble/analysis/steady_state.hpp"
#include "ensemble/analysis/table.hpp"
#include "ensemble/statistics/student_tests.hpp"

// A number of a sweep point from tables of analyses and fits, with its error.
namespace jostle::inline study {

/// Tables just made of a file, not yet stored in it.
struct MadeTables {
  std::vector<Table> fits = {}, analyses = {};
};

/// Value of a kept fit for a curve of a parameter against the swept value.
struct ParameterPoint {
  double value;          // NaN without one
  ErrorOf error;         // Student's t makes the longer side of its 68 % interval of it
  std::string no_value;  // why there is none
  std::string units;     // in units X of the observable and t of taps: "X/t"
};

/// A value where the 95 % interval is closed; what has no limit on one side is no point of a curve.
/// None of a table that has no such parameter.
std::optional<ParameterPoint> parameter_point(const Table& fit, const std::string& name);

inline const std::string parameter_of_a_fit = "parameter of a fit";  // its label's long name

struct DerivedValue {
  double value = not_a_number;  // without one
  ErrorOf error;
  Column label;
  std::string no_value;    // why there is none
  bool error_is_no_basis = false;  // a fit's, of too few realizations
  /// Steady states alone: the taps that they were taken from, and whether these are steady.
  std::string taps = {};
  std::optional<Verdict> steady = {};
  /// Parameters of fits alone: the formula that was fitted without blanks, empty for a restated
  /// law's; the range of t, and what was fixed: "1:60, b = -0.02".
  std::string law = {}, conditions = {};
};

/// "steady/sigma" of analyses, "kww/rho_inf" of fits. Throws BadInput where it is not among the
/// tables, or is no such name.
DerivedValue derived_value(const MadeTables& tables, std::uint32_t point,
                           const std::string& observable, const std::string& quantity);

}  // namespace jostle::inline study
