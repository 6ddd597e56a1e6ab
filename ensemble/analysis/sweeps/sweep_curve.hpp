#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ensemble/analysis/table.hpp"
#include "ensemble/plan.hpp"
#include "ensemble/statistics/student_tests.hpp"
#include "structure/observables.hpp"

// A steady-state quantity, or a parameter of a fit, against the swept value.
namespace jostle::inline ensemble {

/// y(x) with errors; where y is a mean over realizations, with their values, from which errors of
/// all that is read off the curve then come. Points are in the order of x; those whose y is NaN are
/// dropped.
class SweepCurve {
 public:
  /// Below this number of realizations per point, variances are pooled over points: the scatter of
  /// one point is too uncertain.
  static constexpr std::uint64_t fewest_for_own_error = 10;

  /// Any values with their standard errors, each [n_points]; a dof of 0 is an error that is
  /// unknown, an infinite one an error that is known.
  SweepCurve(std::vector<double> x, std::vector<double> y, std::vector<ErrorOf> error);
  /// Means over realizations, [n_points][any number of realizations], NaN where there is none. With
  /// matched streams realization r of all points is one packing's fate.
  SweepCurve(std::vector<double> x, std::vector<std::vector<double>> realizations, Streams streams);

  const std::vector<double>& x() const { return x_; }
  const std::vector<double>& y() const { return y_; }
  /// The error of each point: from its own realizations, or as given.
  const std::vector<ErrorOf>& error() const { return error_; }
  /// Realizations of each point; 0 where they are not known.
  const std::vector<std::uint64_t>& count() const { return count_; }
  std::size_t n_points() const { return x_.size(); }
  bool has_realizations() const { return !realizations_.empty(); }
  Streams streams() const { return streams_; }
  const std::vector<std::vector<double>>& realizations() const { return realizations_; }

  /// The values that lines and maxima are fitted to, [n_points]: y; with matched streams the mean
  /// over the realizations that all points have, if there are any.
  const std::vector<double>& fitted_y() const { return fitted_y_; }
  /// How points count in a fit, [n_points]: 1/error where errors are known or of
  /// `fewest_for_own_error` realizations, else by their number of realizations, never by their
  /// scatter.
  std::vector<double> weights() const;
  /// The error of sum_i c_i fitted_y_i, c: [n_points]. Independent points: their own variances
  /// where all have `fewest_for_own_error` realizations, else one variance, pooled over points.
  /// Matched streams: the scatter of the sums over realizations where there are
  /// `fewest_for_own_error`; else realizations shift all points alike, and what is left has one
  /// variance, pooled over points (a two-way layout without interaction).
  ErrorOf error_of(std::span<const double> coefficients) const;
  /// True if error_of() pools variances over points.
  bool pools() const;
  /// The error of one realization (of one value where realizations are not known), pooled over
  /// points: about the mean of its point, and with matched streams about its own level too. Empty
  /// where no point has two.
  ErrorOf pooled() const { return pooled_; }
  /// -y(x): the curve turned upside down, its errors kept.
  SweepCurve reflected() const;
  /// The p-value of realizations scattering alike at all points, as pooling presumes: Bartlett
  /// 1937, doi:10.1098/rspa.1937.0109. Matched streams: of the residuals of the two-way layout,
  /// with M - 1 degrees of freedom at each of n points, and the statistic divided by 1 - 1/(n -
  /// 1)^2 because they sum to zero over points. NaN where fewer than two points (matched: three)
  /// have a scatter.
  double p_of_equal_scatter() const;

 private:
  void sort_and_drop();
  void pool_independent();
  void pool_matched();
  ErrorOf own_error_of(std::span<const double> coefficients) const;
  ErrorOf matched_error_of(std::span<const double> coefficients) const;

  std::vector<double> x_, y_, fitted_y_;
  std::vector<ErrorOf> error_;
  std::vector<std::uint64_t> count_;
  std::vector<std::vector<double>> realizations_;
  Streams streams_ = Streams::independent;
  bool own_errors_ = false;  // serve by themselves
  ErrorOf pooled_;
  std::vector<ErrorOf> scatter_;     // deviation of one realization at each point, as pooled
  ErrorOf level_;                    // matched: of the mean over points of one realization
  std::vector<std::size_t> common_;  // matched: realizations that all points have
};

/// The highest point of a parabola through the points about the largest y, which describes them,
/// and where the truth can have its maximum, whatever its shape. For a minimum: the lowest point,
/// the least y.
struct SweepExtremum {
  double x = 0, y = 0;  // NaN without one inside the points used
  /// 95 % interval of the place, of a curve that rises to one maximum and falls from it: from the
  /// last point below to the first one above those that no other is known to exceed (t-tests, each
  /// at 5 % over the number of other points: multiple comparisons with the best, Hsu 1996). NaN
  /// where it reaches an end of the sweep.
  double x_low = 0, x_high = 0;
  /// Probability that chance makes a curve without a maximum inside look like this: straight lines
  /// through the points used rise up to the largest and fall from it (Simonsohn 2018,
  /// doi:10.1177/2515245918805755: the larger of two one-sided p-values), times the number of
  /// points that could have been the largest. It does not rest on the parabola, which overshoots
  /// where a curve only levels off. NaN without errors.
  double p = 1;
  std::size_t points = 0;  // used
  std::string verdict;     // "found", "cannot decide" or "none", and why

  static constexpr double level = significance_level;
  bool found() const { return p < level; }
};

/// A parabola through `points` (3 or more; all of a smaller curve) neighbours of the largest y.
SweepExtremum maximum(const SweepCurve& curve, std::size_t points = 5);
/// The maximum of the reflected curve: found as often, with the same p-values and intervals.
SweepExtremum minimum(const SweepCurve& curve, std::size_t points = 5);

/// y = intercept + slope x by least squares.
struct StraightLine {
  double intercept, slope;  // NaN below two different x
  /// From the curve's errors; without them from the scatter about the line.
  ErrorOf intercept_error, slope_error;
  double reduced_chi2;  // squares about the line over what the errors make of them; NaN without
  double p;             // p-value of the F-test of a straight line (Box 1954)
};
StraightLine straight_line(const SweepCurve& curve);

/// The difference of two points of a curve of means over realizations.
struct SweepDifference {
  std::size_t start = 0, end = 0;  // points
  double value = 0;                // value at `end` minus value at `start`
  ErrorOf error{};
  std::uint64_t pairs = 0;      // realizations that both have; 0 for independent streams
  double p = 1, corrected = 1;  // by itself, and for the number of differences (Holm 1979)
};

/// Returns the differences of all points to one, `reference`, or of neighbours. Matched streams:
/// paired Student's t-test with M - 1 degrees of freedom; independent streams: Welch's test.
std::vector<SweepDifference> differences(const SweepCurve& curve,
                                         std::optional<std::size_t> reference);

/// The pairs of points to compare: every pair, or each point with the first.
enum class ComparedPairs { all_pairs, with_first };

/// Differences of these pairs, by the tests of the overload above. A difference whose realizations
/// do not scatter at all has no error and no p-value: M equal values do not show that others would
/// be equal.
std::vector<SweepDifference> differences(const SweepCurve& curve, ComparedPairs pairs);

/// The swept quantity: "sqrt_epsilon", its units, and a line of description.
struct SweptValue {
  std::string name, units, long_name;
};

/// The curve with errors, its maximum and minimum, its straight line and, where realizations are
/// known, the differences between its points.
Table sweep_table(std::string name, const SweptValue& swept, const Column& quantity,
                  const SweepCurve& curve, std::optional<std::size_t> reference = std::nullopt);

}  // namespace jostle::inline ensemble
