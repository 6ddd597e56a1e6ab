#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "ensemble/moments.hpp"
#include "ensemble/statistics/autocorrelation.hpp"
#include "ensemble/statistics/student_tests.hpp"

// Slow drift of series that should be steady. It fakes long correlations, and a spectrum's slope
// of -2 at low frequencies.
namespace jostle::inline ensemble {

/// A mean over realizations that is 0 in a steady state, with two independent errors.
struct Change {
  double value = 0;
  ErrorOf scatter_error;  // from the scatter over realizations; none of one
  ErrorOf
      series_error;  // from the memory of each series about its own line; none where blocks of five
                     // autocorrelation times are fewer than four a series, nor where realizations
                     // differ by more (F-test at 25 %): their memory is then longer than the blocks
  /// Over realizations where that is known, else within.
  const ErrorOf& error() const { return scatter_error.known() ? scatter_error : series_error; }
};

/// Tests if the last taps drift: Student's tests of the slope of a straight line and of the
/// difference between the halves, each with both errors where they are known. The smallest p-value
/// counts, times the number of tests (Bonferroni).
struct Trend {
  Change line;                 // change of a straight line over the taps: slope times their number
  Change halves;               // mean of the second half of the taps less that of the first
  double share = 0;            // share of the total variance in time that the line explains, 0 .. 1
  double sigma = 0;            // deviation of single taps about the line of their realization
  AutocorrelationTime memory;  // about these lines
  std::size_t tests = 0;       // made; 0: one series, too short for its memory, or all alike
  double p = 1;                // p-value of all tests together
  std::string decisive;        // the test with the smallest p-value: "slope over realizations"
  double decisive_dof = 0;
  /// The smallest true change of the line that one of the tests would have found with probability
  /// 0.8, by the errors as they are estimated. Infinite without a test.
  double detectable = 0;

  static constexpr double level = significance_level;  // all tests together
  bool drifts() const { return p < level; }
  /// No series changes at all: there is neither a drift nor scatter that could hide one.
  bool is_constant() const { return sigma == 0 && line.value == 0 && halves.value == 0; }
  /// Units of the changes, for statements.
  std::string units = "1";
  /// "it drifts: +0.02 over the taps (p = 0.0003 at the 5 % level, 2 tests, ...)",
  /// "no drift found (p = 0.4 at the 5 % level, ...)", or "no drift: the series is constant".
  std::string statement() const;
  /// "the test finds drifts of 0.01 or more over the taps (80 % power), 0.3 times the scatter of
  /// taps about their line", or with `only` "finds only drifts of". After at least one test, of
  /// series that are not constant. One realization: "(80 % power, unless memory is
  /// underestimated)", as it mostly is where few such series have a test.
  std::string power(const std::string& only = "") const;
  /// `detectable` in deviations `sigma`; 0 where every change is found, infinite without a test.
  double detectable_in_sigma() const { return detectable == 0 ? 0 : detectable / sigma; }
};

/// One series after another, all of one length, at least 32.
class TrendTest {
 public:
  void add(std::span<const double> series);
  /// After at least one series.
  Trend result() const;
  /// The memory about these lines without the bias of short series, for AR(1).
  AutocorrelationTime unbiased_memory() const { return about_lines_.unbiased(); }

 private:
  /// Means of blocks of one length about their own line, pooled over series.
  struct Level {
    std::size_t length = 0, n_blocks = 0;  // taps; blocks of a series
    double squares = 0;
  };
  ErrorOf slope_within(const AutocorrelationTime& memory) const;

  std::size_t n_ = 0, n_series_ = 0;
  Moments slopes_, halves_;
  double variance_ = 0;  // in time, summed over series
  Autocorrelation about_lines_{Removed::line};
  std::vector<Level> levels_;
};

}  // namespace jostle::inline ensemble
