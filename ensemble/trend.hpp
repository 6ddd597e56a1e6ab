#pragma once

#include <cstddef>
#include <span>
#include <vector>

// Slow drift of series that should be steady. It fakes long correlations, and a spectrum's slope
// of -2 at low frequencies.
namespace jostle {

/// Least squares over the indices 0 .. n - 1, n >= 1: middle + slope (i - center).
struct Line {
  double center = 0;  // (n - 1) / 2
  double middle = 0;  // the mean
  double slope = 0;   // 0 for one value
};
Line fit_line(std::span<const double> series);

/// The straight line through the mean over realizations.
struct Trend {
  double slope = 0;        // a tap
  double slope_error = 0;  // standard error; NaN where nothing gives one
  double dof = 0;          // of the error
  double change = 0;       // slope times the taps of the range
  double share = 0;        // of the total variance in time that the line explains, 0 .. 1
  double tails = 1;        // probability of a slope this far from 0 by chance (Student's t)

  /// Chance would do this less often than 3 standard errors of a normal variable: 0.27 %.
  bool drifts() const { return tails < 0.0027; }
};

/// One series after another, all of one length, at least 32. The error of the slope comes from the
/// scatter over realizations, which are independent; of a single one, from what the means of
/// `single_blocks` blocks leave about their own line, independent where a block is longer than the
/// series' memory.
class TrendTest {
 public:
  static constexpr std::size_t single_blocks = 16;

  void add(std::span<const double> series);
  /// After at least one series.
  Trend result() const;

 private:
  std::size_t n_ = 0;
  std::vector<double> slopes_;  // [n_realizations]
  double variance_ = 0;         // in time, summed over realizations
  double block_error_ = 0;      // of the slope of the first series
};

}  // namespace jostle
