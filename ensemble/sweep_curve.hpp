#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ensemble/plan.hpp"
#include "ensemble/table.hpp"
#include "structure/observables.hpp"

// A steady-state quantity, or a parameter of a fit, against the swept value.
namespace jostle {

/// y(x) with errors; where y is a mean over realizations, with their values, from which errors of
/// all that is read off the curve then come.
class SweepCurve {
 public:
  /// Any values with their standard errors, each [n_points]; errors that are unknown are NaN.
  /// Points are brought into the order of x; those whose y is NaN are dropped.
  SweepCurve(std::vector<double> x, std::vector<double> y, std::vector<double> error);
  /// Means over realizations, [n_points][any number of realizations], NaN skipped. With matched
  /// streams realization r of all points is one packing's fate, and is left out as one.
  SweepCurve(std::vector<double> x, std::vector<std::vector<double>> realizations, Streams streams);

  const std::vector<double>& x() const { return x_; }
  const std::vector<double>& y() const { return y_; }
  const std::vector<double>& error() const { return error_; }
  /// Realizations of each point; 0 where they are not known.
  const std::vector<std::uint64_t>& count() const { return count_; }
  std::size_t n_points() const { return x_.size(); }
  bool has_realizations() const { return !realizations_.empty(); }
  bool errors_known() const;  // of every point, and positive

  /// The curve's y with one realization left out, [n_groups][n_left_out][n_points]: one group of
  /// all realizations where streams are matched, else one a point.
  std::vector<std::vector<std::vector<double>>> left_out() const;

 private:
  void sort_and_drop();

  std::vector<double> x_, y_, error_;
  std::vector<std::uint64_t> count_;
  std::vector<std::vector<double>> realizations_;
  Streams streams_ = Streams::independent;
};

/// The highest point of a parabola through the points about the largest y.
struct SweepMaximum {
  double x, x_error;  // NaN without a maximum inside the points used
  double y, y_error;
  /// Share of 1000 curves, drawn from the errors of the points as independent and normal, that have
  /// a maximum there. NaN where errors are unknown.
  double resolved;
  std::size_t points;   // used
  std::string verdict;  // "maximum", or why it is none or a doubtful one
};

/// A parabola through `points` (3 or more; all of a smaller curve) neighbours of the largest y,
/// weighted by their errors where these are known. Errors are jackknife errors over realizations,
/// or the deviation over those drawn curves that have a maximum.
SweepMaximum maximum(const SweepCurve& curve, std::size_t points = 5);

/// y = intercept + slope x by least squares, weighted by errors where these are known.
struct StraightLine {
  double intercept, slope;  // NaN below two different x
  /// Jackknife over realizations; else from the errors of the points; else from the scatter.
  double intercept_error, slope_error;
  double reduced_chi2;  // NaN without known errors or below three points
};
StraightLine straight_line(const SweepCurve& curve);

/// What is swept: "sqrt_epsilon", its units, and a line for people.
struct SweptValue {
  std::string name, units, long_name;
};

/// The curve with errors, its maximum and its straight line.
Table sweep_table(std::string name, const SweptValue& swept, const ObservableLabel& quantity,
                  const SweepCurve& curve);

}  // namespace jostle
