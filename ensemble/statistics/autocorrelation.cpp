#include "ensemble/statistics/autocorrelation.hpp"

#include <bit>
#include <cassert>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "ensemble/moments.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr double window_in_times = 6;
constexpr double lowest_rho = -0.9995;  // rho of an alternating AR(1)

// Sums of x[i] x[i + lag] for lags 0 .. n / 2, of a series about its mean or its line.
std::vector<double> lagged_products(std::span<const double> series, Removed removed) {
  const Line line = fit_line(series);
  const double slope = removed == Removed::line ? line.slope : 0;
  // Zeros up to here keep the ends of the series apart in the cyclic transform.
  std::vector<double> padded(std::bit_ceil(series.size() + series.size() / 2 + 1), 0.0);
  for (std::size_t i = 0; i < series.size(); ++i) {
    padded[i] = (series[i] - line.middle) - slope * (static_cast<double>(i) - line.center);
  }
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> transform;
  fft.fwd(transform, padded);
  for (auto& power : transform) power = std::norm(power);
  std::vector<double> products;
  fft.inv(products, transform);
  products.resize(series.size() / 2 + 1);
  return products;
}

double wolff_error(double time, std::size_t window, std::size_t n_values) {
  const double excess = std::fmax(0.0, static_cast<double>(window) + 0.5 - time);
  return 2 * time * std::sqrt(excess / static_cast<double>(n_values));
}

double rho_of(double time) {
  return (2 * time - 1) / (2 * time + 1);
}

double time_of(double rho) {
  return 0.5 * (1 + rho) / (1 - rho);
}

/// Standard error of the time of AR(1) whose rho < 0 is the correlation at lag 1 (Bartlett 1946).
double alternating_error(double rho, std::size_t n_values) {
  return std::sqrt((1 + rho) / static_cast<double>(n_values)) / std::pow(1 - rho, 1.5);
}

/// The rho < 0 of AR(1) whose correlations over lags 1 .. last have this negative sum. A window of
/// several lags ends so late only for rho > -1/2, where the sum grows with rho.
double alternating_rho(double sum, std::size_t last) {
  double low = last == 1 ? lowest_rho : -0.5, high = 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const double found = middle * (1 - std::pow(middle, static_cast<double>(last))) / (1 - middle);
    (found < sum ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Expectations of covariances of AR(1) of variance 1 and this autocorrelation time, about the
/// means of series of n taps.
struct ExpectedSum {
  double time = 0.5;    // 1/2 + sum of correlations over lags 1 .. last, as from the covariances
  double variance = 0;  // at lag 0
  std::vector<double> lowered;  // [last + 1], by which the covariances are too small

  ExpectedSum(double autocorrelation_time, std::size_t n, std::size_t last) {
    const double rho = rho_of(autocorrelation_time);
    // With the mean of each tap's covariances with all taps, and the sums of these from the first.
    std::vector<double> powers(n), sums(n + 1, 0.0), shared(n + 1, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      powers[i] = i == 0 ? 1 : powers[i - 1] * rho;
      sums[i + 1] = sums[i] + powers[i];
    }
    const auto length = static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i)
      shared[i + 1] = shared[i] + (sums[i + 1] + sums[n - i] - 1) / length;
    const double of_mean = shared[n] / length;
    for (std::size_t t = 0; t <= last; ++t) {
      lowered.push_back((shared[n - t] + shared[n] - shared[t]) / static_cast<double>(n - t) -
                        of_mean);
      const double covariance = powers[t] - lowered.back();
      if (t == 0) variance = covariance;
      if (t > 0) time += covariance / variance;
    }
  }
};

}  // namespace

void Autocorrelation::add(std::span<const double> series) {
  assert((n_ == 0 || series.size() == n_) && series.size() >= 4);
  n_ = series.size();
  ++realizations_;
  const std::vector<double> products = lagged_products(series, removed_);
  products_.resize(products.size(), 0.0);
  for (std::size_t lag = 0; lag < products.size(); ++lag) products_[lag] += products[lag];
}

/// Lags up to the first of at least 6 times the running sum.
struct Autocorrelation::Sum {
  double time = 0.5;       // from covariances about the means or lines of series
  std::size_t last = 0;    // lag
  bool has_ended = false;  // before half a series
};

double Autocorrelation::covariance(std::size_t lag) const {
  return products_[lag] / static_cast<double>(realizations_ * (n_ - lag));
}

AutocorrelationTime Autocorrelation::to_first_order(const Sum& sum) const {
  AutocorrelationTime result{.time = 0.5};
  // Subtracting the mean of a series lowers every covariance by the variance of that mean, and its
  // slope by as much again at lags that are short against the series.
  const double times = removed_ == Removed::line ? 2 : 1;
  const double memory = sum.last == 1 ? time_of(std::fmax(lowest_rho, sum.time - 0.5)) : sum.time;
  const double lowered = times * 2 * memory * covariance(0) / static_cast<double>(n_);
  result.variance = covariance(0) + lowered;
  for (std::size_t t = 1; t <= sum.last; ++t) {
    const double correlation = (covariance(t) + lowered) / result.variance;
    result.time += correlation;
    result.squares += correlation * correlation;
  }
  result.window = sum.has_ended ? sum.last : 0;
  result.error = wolff_error(result.time, sum.last, realizations_ * n_);
  return result;
}

AutocorrelationTime Autocorrelation::lower_bound(const Sum& sum) const {
  AutocorrelationTime bound = to_first_order(sum);
  bound.window = 0;
  bound.time = std::fmax(0.5, bound.time - bound.error);
  // Bartlett 1946.
  const auto n_values = static_cast<double>(realizations_ * n_);
  const double scatter = std::sqrt(2 * (1 + 2 * bound.squares) / n_values);
  bound.variance = covariance(0) / (1 + scatter);
  return bound;
}

AutocorrelationTime Autocorrelation::about_means(const Sum& sum) const {
  const auto expected = [&](double time) { return ExpectedSum(time, n_, sum.last); };
  const double first_order = to_first_order(sum).time;
  // From below the solution, upwards by steps until the sum is reached; it falls beyond its
  // maximum.
  constexpr double step = 1.1;
  const auto length = static_cast<double>(n_);
  const double lowest = sum.last == 1 ? time_of(lowest_rho) : 0.05;
  double low = std::fmax(lowest, 0.9 * first_order);
  while (low > lowest && expected(low).time > sum.time) low /= step;
  double high = low;
  while (expected(high).time < sum.time) {
    low = high;
    high *= step;
    if (high > length) return lower_bound(sum);
  }
  for (int i = 0; i < 40 && high - low > 1e-9 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (expected(middle).time < sum.time ? low : high) = middle;
  }
  AutocorrelationTime result{.time = 0.5 * (low + high), .window = sum.last};
  const ExpectedSum found = expected(result.time), larger = expected(1.01 * result.time);
  const double gain = (larger.time - found.time) / (0.01 * result.time);
  if (!(gain > 0)) return lower_bound(sum);
  // Means take a part of the sum's scatter with them: about as much of its square as of its gain.
  const double scatter = wolff_error(result.time, sum.last, realizations_ * n_);
  result.error = scatter / std::sqrt(gain);
  if (sum.last == 1 && result.time < 0.5) {
    result.error = alternating_error(rho_of(result.time), realizations_ * n_);
  }
  if (length < fewest_times * (result.time + scatter / gain)) return lower_bound(sum);
  result.variance = covariance(0) / found.variance;
  result.variance_error = result.variance * result.error *
                          std::abs(larger.variance / found.variance - 1) / (0.01 * result.time);
  for (std::size_t t = 1; t <= sum.last; ++t) {
    const double correlation = covariance(t) / result.variance + found.lowered[t];
    result.squares += correlation * correlation;
  }
  return result;
}

AutocorrelationTime Autocorrelation::about_lines(const Sum& sum) const {
  AutocorrelationTime result = to_first_order(sum);
  if (!(result.time < 0.5)) return result;
  // The window ends before the correlations of a series that alternates have cancelled.
  const double rho = alternating_rho(result.time - 0.5, sum.last);
  result.time = time_of(rho);
  result.error = sum.last == 1 ? alternating_error(rho, realizations_ * n_)
                               : wolff_error(result.time, sum.last, realizations_ * n_);
  return result;
}

AutocorrelationTime Autocorrelation::result() const {
  if (!(covariance(0) > 0)) return {.time = 0.5, .error = 0, .window = 1};
  Sum sum;
  while (++sum.last < products_.size()) {
    sum.time += covariance(sum.last) / covariance(0);
    if (static_cast<double>(sum.last) >= window_in_times * sum.time) break;
  }
  sum.has_ended = sum.last < products_.size();
  if (!sum.has_ended) sum.last = products_.size() - 1;
  if (removed_ == Removed::line) return about_lines(sum);
  return sum.has_ended ? about_means(sum) : lower_bound(sum);
}

Line fit_line(std::span<const double> series) {
  const auto n = static_cast<double>(series.size());
  Moments moments;
  for (const double value : series) moments.add(value);
  Line line{.center = 0.5 * (n - 1), .middle = moments.mean()};
  for (std::size_t i = 0; i < series.size(); ++i) {
    line.slope += (static_cast<double>(i) - line.center) * (series[i] - line.middle);
  }
  // Sum of (i - center)^2: n (n^2 - 1) / 12.
  line.slope = series.size() < 2 ? 0 : line.slope / (n * (n * n - 1) / 12);
  return line;
}

}  // namespace jostle::inline ensemble
