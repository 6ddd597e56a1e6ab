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

}  // namespace

void Autocorrelation::add(std::span<const double> series) {
  assert((n_ == 0 || series.size() == n_) && series.size() >= 4);
  n_ = series.size();
  ++realizations_;
  const std::vector<double> products = lagged_products(series, removed_);
  products_.resize(products.size(), 0.0);
  for (std::size_t lag = 0; lag < products.size(); ++lag) products_[lag] += products[lag];
}

AutocorrelationTime Autocorrelation::result() const {
  const auto covariance = [&](std::size_t lag) {
    return products_[lag] / static_cast<double>(realizations_ * (n_ - lag));
  };
  const double biased_variance = covariance(0);
  if (!(biased_variance > 0)) return {.time = 0.5, .error = 0, .window = 1};
  AutocorrelationTime result{.time = 0.5};
  std::size_t lag = 0;
  while (++lag < products_.size()) {
    result.time += covariance(lag) / biased_variance;
    if (static_cast<double>(lag) >= window_in_times * result.time) break;
  }
  const bool found = lag < products_.size();
  const std::size_t last = found ? lag : products_.size() - 1;
  // Subtracting the mean of a series lowers every covariance by the variance of that mean, and its
  // slope by as much again at lags that are short against the series.
  const double times = removed_ == Removed::line ? 2 : 1;
  const double lowered = times * 2 * result.time * biased_variance / static_cast<double>(n_);
  result.variance = biased_variance + lowered;
  result.time = 0.5;
  for (std::size_t t = 1; t <= last; ++t) {
    const double correlation = (covariance(t) + lowered) / result.variance;
    result.time += correlation;
    result.squares += correlation * correlation;
  }
  result.window = found ? last : 0;
  const double n_values = static_cast<double>(realizations_ * n_);
  const double excess = std::fmax(0.0, static_cast<double>(last) + 0.5 - result.time);
  result.error = 2 * result.time * std::sqrt(excess / n_values);
  return result;
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
