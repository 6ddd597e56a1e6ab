#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fitting/fit.hpp"

// The choice between laws by realizations that the fits have not seen.
namespace jostle::inline fitting {

/// How one law predicts realizations that were held out, and how that compares with the law that
/// predicts them best. Squares are means over points, in units of the variance of one realization.
struct HeldOutLaw {
  std::string model;
  /// Mean squared error of prediction, less what the error of the law's own fit adds.
  double squared_error = 0;
  double difference = 0;  // squared_error less that of the leading law; 0 for that law
  double error = 0;       // standard error of the difference
  double dof = 0;         // dof of Student's t for the error: M - 1, fewer with gaps
  double t = 0;           // difference / error
  /// p-value of the hypothesis that this law comes at least as close to the mean curve as the
  /// leading law, for as many laws as are compared (Bonferroni); 1 for the leading law.
  double p = 1;
  bool worse = false;  // p < LawComparison::level
  /// True if its curve is that of the leading law, so that nothing can decide between them.
  bool same_curve = false;

  bool operator==(const HeldOutLaw&) const = default;
};

/// Laws fitted to one curve, compared by held-out realizations.
struct LawComparison {
  static constexpr double level = 0.05;
  static constexpr std::size_t least_realizations = 3;

  std::vector<HeldOutLaw> laws;  // in the order of the fits; empty where nothing was compared
  std::size_t leading = 0;       // law with the least squared_error
  std::size_t n_realizations = 0;
  std::string cannot_decide;          // why nothing was compared, a sentence; or empty
  std::vector<std::string> left_out;  // laws that were not compared and why, a sentence each

  /// True if every other law is worse than the leading law.
  bool is_decided() const;
};

/// A law and its fit to the mean curve.
struct FittedLaw {
  const Model* model = nullptr;
  const Fit* fit = nullptr;
};

/// Compares laws by leaving out one realization after another. Each law is fitted to the mean of
/// the other realizations and predicts the one left out. A level of its own that a realization
/// keeps to adds to all predictions alike and cancels in their differences.
///
/// With a and b the curves of two laws fitted to the mean y of M realizations, the difference is an
/// estimate of |f - b|^2 - |f - a|^2, f the mean curve of infinitely many realizations: the spread
/// of the M curves of a law gives the variance of its fit, which is taken off its squared error.
/// Otherwise the law with fewer parameters would win where both are true. To first order, the
/// difference is a mean of -2 <b - a, y_m> over realizations m, which are independent whatever the
/// memory of each: Student's t with M - 1 degrees of freedom. The second order, which alone is left
/// where the laws coincide, adds its variance: that of a U-statistic of the kernel <y_l, (A - B)
/// y_m>, A and B what the fits make of a change of the curve (Hoeffding 1948,
/// doi:10.1214/aoms/1177730196).
///
/// Every other law is compared with the leading law, one-sided, at 5 % over the number of other
/// laws (multiple comparisons with the best, Hsu 1996): the law that is nearest to the mean curve
/// is called worse in at most 5 % of ensembles. Fewer than 3 realizations, realizations without
/// scatter and fewer than two laws of X decide nothing; laws of ln X are left out.
LawComparison compare_laws(const std::vector<FittedLaw>& laws, const Curve& curve);

}  // namespace jostle::inline fitting
