#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "ensemble/moments.hpp"
#include "ensemble/statistics/autocorrelation.hpp"
#include "ensemble/statistics/blocking.hpp"
#include "ensemble/statistics/trend.hpp"

namespace jostle::inline ensemble {

/// True if the state is steady. "Cannot decide" where no drift was found, but the taps and the
/// realizations would not have shown one that matters.
enum class Verdict { reached, not_reached, cannot_decide };

/// Analysis of the last taps of a run for a steady state.
struct SteadyState {
  std::size_t n_taps = 0, realizations = 0;
  double value = 0;  // mean over taps and realizations
  /// With two or more realizations, their standard error. For one, averaged over the memories that
  /// its taps allow (statistics/mean_error.hpp); where these leave fewer than four independent
  /// values, a lower bound without degrees of freedom.
  ErrorOf error{};
  double independent_values = 0;  // see MeanError; NaN for several realizations
  /// Deviation of single taps about the steady value of their realization; a lower bound where the
  /// autocorrelation time is one.
  double sigma = 0;
  ErrorOf sigma_error{};  // over realizations; of one, Bartlett's, dof infinite; none of a bound
  double realization_sigma = 0;  // deviation of realizations' means, 1/(M - 1); NaN for one
  BlockingResult blocking;
  AutocorrelationTime autocorrelation;
  Trend trend;

  /// Smallest change over the taps that would have been found, in deviations of single taps.
  double detectable() const;
  Verdict verdict() const;
  /// The verdict with its test, and what would have refuted it.
  std::string statement() const;
};

/// Takes the last taps of one realization after another, all of one length, at least 32. The steady
/// state is "not reached" where the mean drifts (TrendTest). It is "reached" where no drift is
/// found, one as large as the deviation of single taps would have been found with 80 % probability,
/// and the taps are at least 20 autocorrelation times and, of a single realization, many more than
/// it remembers. Else they cannot decide.
class SteadyStateTest {
 public:
  static constexpr std::size_t fewest_taps = 32;
  static constexpr double fewest_times = 20;
  static constexpr double largest_unseen = 1;  // change over the taps, in deviations of single taps

  void add(std::span<const double> series);
  /// After at least one series.
  SteadyState result() const;

 private:
  std::size_t n_taps_ = 0;
  Moments means_, variances_;
  std::vector<double> only_;  // means of a few taps each of the first series
  Blocking blocking_;
  Autocorrelation autocorrelation_;
  TrendTest trend_;
};

}  // namespace jostle::inline ensemble
