#pragma once

#include <cstddef>
#include <optional>
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
  double error = 0;        // standard error; of a lower bound that of the scatter alone
  std::size_t window = 0;  // lags summed; 0 where the series are too short: a lower bound
  double variance = 0;     // variance of single taps about the true mean; a lower bound as the time
  double variance_error = 0;  // standard error of it that comes from the time's
  double squares = 0;         // sum of the squared correlation over lags 1 .. window

  bool found() const { return window > 0; }
};

/// Subtracted from every series first: its mean, or its straight line, so that a drift does not
/// count as memory.
enum class Removed { mean, line };

/// Pooled over series of one length, at least 4, each about its own mean or line. The sum ends
/// at the first lag of at least 6 tau (Madras and Sokal 1988, doi:10.1007/BF01022990), up to
/// half a series; the error is that of Wolff 2004, doi:10.1016/S0010-4655(03)00467-3, eq. 42.
/// The bias by subtracting each series' own line is put right to first order (eq. 32); a time below
/// 1/2 is that of the AR(1) process of rho < 0 with the sum that was found, for the sum ends before
/// alternating correlations cancel. The bias
/// by subtracting the mean is removed entirely for AR(1): the time is that of the AR(1) process
/// whose covariances, about the means of series of this length, have the sum that was found.
/// Where no process has it, or where a series has fewer than ten times the time plus its
/// error, the values are lower bounds: one standard error below the time to first order and
/// below the uncorrected variance.
class Autocorrelation {
 public:
  static constexpr double fewest_times = 10;  // in a series

  explicit Autocorrelation(Removed removed = Removed::mean) : removed_(removed) {}

  void add(std::span<const double> series);
  AutocorrelationTime result() const;
  /// The time of the AR(1) process whose covariances, about the means or lines of series of this
  /// length, have the sum that was found, however short the series are against it; a lower bound
  /// where no process has it. Time, error and window only.
  AutocorrelationTime unbiased() const;

 private:
  struct Sum;
  struct Process;
  Sum summed() const;
  std::optional<Process> process_of(const Sum& sum) const;
  double covariance(std::size_t lag) const;
  AutocorrelationTime to_first_order(const Sum& sum) const;
  AutocorrelationTime lower_bound(const Sum& sum) const;
  AutocorrelationTime about_means(const Sum& sum) const;
  AutocorrelationTime about_lines(const Sum& sum) const;

  Removed removed_;
  std::size_t n_ = 0, realizations_ = 0;
  std::vector<double> products_;  // [n / 2 + 1], by lag, summed over taps and realizations
};

}  // namespace jostle::inline ensemble
