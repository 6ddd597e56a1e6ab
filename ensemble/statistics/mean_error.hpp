#pragma once

#include <span>

#include "ensemble/statistics/student_tests.hpp"

namespace jostle::inline ensemble {

/// Error of the mean of one series, whose values remember each other.
struct MeanError {
  /// Limits of the intervals of 68 % and of 95 % are `error` times Student's t of its degrees of
  /// freedom.
  ErrorOf error;
  /// Independent values whose mean would have an equal variance: one over the posterior mean of
  /// (variance of the mean / variance of a value).
  double independent_values = 0;
};

/// Bayesian average over memories that are not known: noise of which a share forgets exponentially,
/// white noise beside it, a mean and a variance of flat priors (1 / variance). Half of the prior
/// is for white noise, half for times from 0.3 to n / 2 steps, uniform in ln time, of share 1 (40
/// %) or one of nine from 0.8 to 0.025 (60 % together). For each memory the deviation of the mean
/// is Student's t of n - 1 degrees of freedom; the mixture's limits of 68 % and 95 % give error and
/// degrees of freedom. A memory that is chosen as the likeliest is too short on average, the
/// average is not. series: equally spaced, n >= 3.
MeanError mean_error(std::span<const double> series);

}  // namespace jostle::inline ensemble
