#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace jostle::inline ensemble {

/// Least squares over the indices 0 .. n - 1, n >= 1: middle + slope (i - center).
struct Line {
  double center = 0;  // (n - 1) / 2
  double middle = 0;  // the mean
  double slope = 0;   // 0 for one value
};
Line fit_line(std::span<const double> series);

/// tau = 1/2 + sum of the correlation over lags 1, 2, ...: the mean of n taps has the variance
/// 2 tau sigma^2 / n. 1/2 for independent taps, (1 + rho) / (1 - rho) / 2 for AR(1).
struct AutocorrelationTime {
  double time = 0;         // taps
  double error = 0;        // standard error
  std::size_t window = 0;  // lags summed; 0 where no window was found: the time is a lower bound
  double variance = 0;     // variance of single taps about the true mean
  double squares = 0;      // sum of the squared correlation over lags 1 .. window

  bool found() const { return window > 0; }
};

/// Subtracted from every series first: its mean, or its straight line, so that a drift does not
/// count as memory.
enum class Removed { mean, line };

/// Pooled over series of one length, at least 4, each about its own mean or line. The sum ends at
/// the first lag of at least 6 tau (Madras and Sokal 1988, doi:10.1007/BF01022990), up to half a
/// series; the bias by subtracting each series' own mean or line is put right to first order, and
/// the error is that of Wolff 2004, doi:10.1016/S0010-4655(03)00467-3, eqs. 32 and 42.
class Autocorrelation {
 public:
  explicit Autocorrelation(Removed removed = Removed::mean) : removed_(removed) {}

  void add(std::span<const double> series);
  AutocorrelationTime result() const;

 private:
  Removed removed_;
  std::size_t n_ = 0, realizations_ = 0;
  std::vector<double> products_;  // [n / 2 + 1], by lag, summed over taps and realizations
};

}  // namespace jostle::inline ensemble
