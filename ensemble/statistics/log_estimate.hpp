#pragma once

#include <span>
#include <vector>

#include "ensemble/statistics/student_tests.hpp"

namespace jostle::inline ensemble {

/// A positive estimate whose logarithm is about normal: means of few squares, and what is fitted to
/// them, are too skewed for value +- error. NaN where there is none.
struct LogEstimate {
  double value, error;     // error: value times the standard error of ln value
  double low_68, high_68;  // value exp(-+ t error / value), Student's t
  double low_95, high_95;
};

/// Without errors where `of_logarithm` is not finite.
LogEstimate log_estimate(double value, const ErrorOf& of_logarithm);

/// Where there is no estimate at all.
LogEstimate no_estimate();

/// True if both limits of its 95 % interval are finite: other parameters are neither stored nor
/// printed.
bool is_limited(const LogEstimate& estimate);

/// ln of the mean of values, none negative, with each left out in turn: for the jackknife. Empty
/// below two values, minus infinity where only the one left out is above 0.
std::vector<double> ln_means_without_one(std::span<const double> values);

/// Sum of squares about the mean over n - 1. NaN below two values.
double variance(std::span<const double> values);

/// ln of the variance (sum of squares about the mean over n - 2) with each value left out in turn:
/// for the jackknife. Empty below four values, which are too few; minus infinity where only
/// the one left out differs.
std::vector<double> ln_variances_without_one(std::span<const double> values);

/// Quantile p in (0, 1) of chi2 with dof > 0 degrees of freedom.
double chi_squared_quantile(double p, double dof);

/// The variance of normal values over realizations (of n - 1) with the intervals of chi2, exact for
/// any number of them from two on; error: value sqrt(2 / (n - 1)). NaN values are left out. Without
/// errors where all are equal.
LogEstimate variance_estimate(std::span<const double> values);

}  // namespace jostle::inline ensemble
