#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "ensemble/autocorrelation.hpp"
#include "ensemble/blocking.hpp"
#include "ensemble/moments.hpp"
#include "ensemble/trend.hpp"

namespace jostle {

/// A difference with its standard error and the probability that chance makes it as large
/// (Student's t).
struct Difference {
  double value = 0, error = 0, tails = 1;
};

/// What the last taps of a run say of the state they may have reached.
struct SteadyState {
  std::size_t n_taps = 0, realizations = 0;
  double value = 0;  // mean over taps and realizations
  double error = 0;  // standard error: over realizations where there are two or more, else blocking
  double sigma = 0;  // deviation of single taps about the steady value of their realization
  double sigma_error = 0;
  double realization_sigma = 0;  // deviation of realizations' means, 1/(M - 1); NaN for one
  BlockingResult blocking;
  AutocorrelationTime autocorrelation;
  Trend trend;
  Difference halves;            // second half of the taps less the first
  std::string reasons_against;  // empty where the steady state is reached

  bool reached() const { return reasons_against.empty(); }
};

/// Takes the last taps of one realization after another, all of one length, at least 32. The steady
/// state is "not reached" where the mean drifts, where its halves differ, both judged at 0.27 %, or
/// where the taps are too few to tell: fewer than 20 autocorrelation times, or those of a single
/// realization without a plateau of the blocking error.
class SteadyStateTest {
 public:
  static constexpr std::size_t fewest_taps = 32;
  static constexpr double fewest_times = 20;

  void add(std::span<const double> series);
  /// After at least one series.
  SteadyState result() const;

 private:
  std::size_t n_taps_ = 0;
  Moments means_, halves_, variances_;
  Blocking blocking_;
  Autocorrelation autocorrelation_;
  TrendTest trend_;
};

}  // namespace jostle
