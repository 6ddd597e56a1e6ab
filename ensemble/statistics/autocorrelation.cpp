#include "ensemble/statistics/autocorrelation.hpp"

#include <algorithm>
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

/// Covariances of AR(1) of variance 1 with a weighted sum of n taps, [n]: forwards and backwards,
/// each tap once.
std::vector<double> with_weighted_sum(double rho, std::span<const double> weights) {
  std::vector<double> found(weights.begin(), weights.end());
  double forward = 0, backward = 0;
  for (std::size_t i = 0, n = weights.size(); i < n; ++i) {
    found[i] += forward;
    forward = rho * (forward + weights[i]);
    found[n - 1 - i] += backward;
    backward = rho * (backward + weights[n - 1 - i]);
  }
  return found;
}

/// Sums of a[i] b[i + lag] + b[i] a[i + lag] for lags 0 .. last: of many lags by transforms.
std::vector<double> crossed_products(std::span<const double> a, std::span<const double> b,
                                     std::size_t last) {
  constexpr std::size_t few_lags = 64;
  if (last <= few_lags) {
    std::vector<double> products(last + 1, 0.0);
    for (std::size_t lag = 0; lag <= last; ++lag) {
      for (std::size_t i = 0; i + lag < a.size(); ++i)
        products[lag] += a[i] * b[i + lag] + b[i] * a[i + lag];
    }
    return products;
  }
  const std::size_t padded = std::bit_ceil(a.size() + last + 1);
  const auto transform_of = [padded](std::span<const double> values) {
    std::vector<double> longer(values.begin(), values.end());
    longer.resize(padded, 0.0);
    std::vector<std::complex<double>> transform;
    Eigen::FFT<double>().fwd(transform, longer);
    return transform;
  };
  const std::vector<std::complex<double>> of_b = transform_of(b);
  std::vector<std::complex<double>> product = transform_of(a);
  for (std::size_t k = 0; k < product.size(); ++k)
    product[k] = 2 * (product[k] * std::conj(of_b[k])).real();
  std::vector<double> products;
  Eigen::FFT<double>().inv(products, product);
  products.resize(last + 1);
  return products;
}

/// Expectations of covariances of AR(1) of variance 1 and this autocorrelation time, about the
/// means or lines of series of n taps.
struct ExpectedSum {
  double time = 0.5;    // 1/2 + sum of correlations over lags 1 .. last, as from the covariances
  double variance = 0;  // at lag 0
  std::vector<double> lowered;  // [last + 1], by which the covariances are too small

  ExpectedSum(double autocorrelation_time, std::size_t n, std::size_t last, Removed removed) {
    const double rho = rho_of(autocorrelation_time);
    lower_by_mean(rho, n, last);
    if (removed == Removed::line) lower_by_slope(rho, n, last);
    double power = 1;
    for (std::size_t t = 0; t <= last; ++t, power *= rho) {
      const double covariance = power - lowered[t];
      if (t == 0) variance = covariance;
      if (t > 0) time += covariance / variance;
    }
  }

 private:
  void lower_by_mean(double rho, std::size_t n, std::size_t last) {
    // With the mean of each tap's covariances with all taps, and the sums of these from the first.
    std::vector<double> sums(n + 1, 0.0), shared(n + 1, 0.0);
    double power = 1;
    for (std::size_t i = 0; i < n; ++i, power *= rho) sums[i + 1] = sums[i] + power;
    const auto length = static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i)
      shared[i + 1] = shared[i] + (sums[i + 1] + sums[n - i] - 1) / length;
    const double of_mean = shared[n] / length;
    for (std::size_t t = 0; t <= last; ++t) {
      lowered.push_back((shared[n - t] + shared[n] - shared[t]) / static_cast<double>(n - t) -
                        of_mean);
    }
  }

  // The slope is the product with taps about their middle, of length 1; it does not correlate with
  // the mean.
  void lower_by_slope(double rho, std::size_t n, std::size_t last) {
    const auto length = static_cast<double>(n);
    const double scale = 1 / std::sqrt(length * (length * length - 1) / 12);
    std::vector<double> taps(n);
    for (std::size_t i = 0; i < n; ++i)
      taps[i] = (static_cast<double>(i) - 0.5 * (length - 1)) * scale;
    std::vector<double> shared = with_weighted_sum(rho, taps);
    double of_slope = 0;
    for (std::size_t i = 0; i < n; ++i) of_slope += taps[i] * shared[i];
    // Each tap's covariance with the slope, less half of the slope's own share.
    for (std::size_t i = 0; i < n; ++i) shared[i] -= 0.5 * of_slope * taps[i];
    const std::vector<double> products = crossed_products(taps, shared, last);
    for (std::size_t t = 0; t <= last; ++t) lowered[t] += products[t] / static_cast<double>(n - t);
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

/// An AR(1) process, and by how much its expected sum grows with its time.
struct Autocorrelation::Process {
  double time = 0, error = 0;
  double gain = 0, scatter = 0;  // those of the sum
};

std::optional<Autocorrelation::Process> Autocorrelation::process_of(const Sum& sum) const {
  const auto expected = [&](double time) { return ExpectedSum(time, n_, sum.last, removed_).time; };
  const double first_order = to_first_order(sum).time;
  // From below the solution, upwards by steps until the sum is reached; it falls beyond its
  // maximum.
  constexpr double step = 1.1;
  const double lowest = sum.last == 1 ? time_of(lowest_rho) : 0.05;
  double low = std::fmax(lowest, 0.9 * first_order);
  while (low > lowest && expected(low) > sum.time) low /= step;
  double high = low;
  while (expected(high) < sum.time) {
    low = high;
    high *= step;
    if (high > static_cast<double>(n_)) return std::nullopt;
  }
  for (int i = 0; i < 40 && high - low > 1e-9 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (expected(middle) < sum.time ? low : high) = middle;
  }
  Process found{.time = 0.5 * (low + high)};
  found.gain = (expected(1.01 * found.time) - expected(found.time)) / (0.01 * found.time);
  if (!(found.gain > 0)) return std::nullopt;
  // Means take a part of the sum's scatter with them: about as much of its square as of its gain.
  found.scatter = wolff_error(found.time, sum.last, realizations_ * n_);
  found.error = sum.last == 1 && found.time < 0.5
                    ? alternating_error(rho_of(found.time), realizations_ * n_)
                    : found.scatter / std::sqrt(found.gain);
  return found;
}

AutocorrelationTime Autocorrelation::about_means(const Sum& sum) const {
  const std::optional<Process> process = process_of(sum);
  if (!process ||
      static_cast<double>(n_) < fewest_times * (process->time + process->scatter / process->gain))
    return lower_bound(sum);
  AutocorrelationTime result{.time = process->time, .error = process->error, .window = sum.last};
  const ExpectedSum found(result.time, n_, sum.last, removed_);
  const ExpectedSum larger(1.01 * result.time, n_, sum.last, removed_);
  result.variance = covariance(0) / found.variance;
  result.variance_error = result.variance * result.error *
                          std::abs(larger.variance / found.variance - 1) / (0.01 * result.time);
  for (std::size_t t = 1; t <= sum.last; ++t) {
    const double correlation = covariance(t) / result.variance + found.lowered[t];
    result.squares += correlation * correlation;
  }
  if (sum.last == 1 && result.time < 0.5) {
    // The squares of a series that alternates go on beyond the window of one lag.
    const double square = rho_of(result.time) * rho_of(result.time);
    result.squares = square / (1 - square);
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

Autocorrelation::Sum Autocorrelation::summed() const {
  Sum sum;
  while (++sum.last < products_.size()) {
    sum.time += covariance(sum.last) / covariance(0);
    if (static_cast<double>(sum.last) >= window_in_times * sum.time) break;
  }
  sum.has_ended = sum.last < products_.size();
  if (!sum.has_ended) sum.last = products_.size() - 1;
  return sum;
}

AutocorrelationTime Autocorrelation::result() const {
  if (!(covariance(0) > 0)) return {.time = 0.5, .error = 0, .window = 1};
  const Sum sum = summed();
  if (removed_ == Removed::line) return about_lines(sum);
  return sum.has_ended ? about_means(sum) : lower_bound(sum);
}

AutocorrelationTime Autocorrelation::unbiased() const {
  if (!(covariance(0) > 0)) return {.time = 0.5, .error = 0, .window = 1};
  const Sum sum = summed();
  const std::optional<Process> process = sum.has_ended ? process_of(sum) : std::nullopt;
  if (!process) return lower_bound(sum);
  AutocorrelationTime result{.time = process->time, .error = process->error, .window = sum.last};
  if (result.time < 0.5) return result;
  // In series that are short against it the sum ends before the process's would on average.
  const auto window = std::max(sum.last, static_cast<std::size_t>(window_in_times * result.time));
  result.error = wolff_error(result.time, window, realizations_ * n_) / std::sqrt(process->gain);
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
