#include "ensemble/analysis/spectra/spectra.hpp"

#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "ensemble/statistics/autocorrelation.hpp"

namespace jostle::inline ensemble {

namespace {

std::vector<double> weights_of(Taper window, std::size_t n) {
  std::vector<double> weights(n, 1.0);
  if (window == Taper::hann) {
    for (std::size_t i = 0; i < n; ++i) {
      const double s = std::sin(std::numbers::pi * static_cast<double>(i) / static_cast<double>(n));
      weights[i] = s * s;
    }
  }
  return weights;
}

std::vector<double> detrended(std::span<const double> series, Detrending detrending) {
  std::vector<double> values(series.begin(), series.end());
  if (detrending == Detrending::none) return values;
  const Line line = fit_line(series);
  const double slope = detrending == Detrending::linear ? line.slope : 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = (values[i] - line.middle) - slope * (static_cast<double>(i) - line.center);
  }
  return values;
}

/// Adds up periodograms of segments of one length.
class Periodograms {
 public:
  Periodograms(std::size_t n, Taper window, Detrending detrending)
      : window_(weights_of(window, n)), detrending_(detrending), sum_(n / 2 + 1, 0.0) {
    fft_.SetFlag(fft_.HalfSpectrum);
    for (const double weight : window_) power_ += weight * weight;
  }

  void add(std::span<const double> segment) {
    std::vector<double> values = detrended(segment, detrending_);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] *= window_[i];
    fft_.fwd(transform_, values);
    for (std::size_t k = 0; k < sum_.size(); ++k) sum_[k] += std::norm(transform_[k]);
    ++count_;
  }

  Spectrum mean() const {
    const std::size_t n = window_.size();
    Spectrum spectrum;
    for (std::size_t k = 0; k < sum_.size(); ++k) {
      const double sides = k == 0 || 2 * k == n ? 1 : 2;
      spectrum.frequency.push_back(static_cast<double>(k) / static_cast<double>(n));
      spectrum.density.push_back(sides * sum_[k] / (power_ * count_));
    }
    return spectrum;
  }

 private:
  std::vector<double> window_;
  Detrending detrending_;
  double power_ = 0, count_ = 0;
  std::vector<double> sum_;
  std::vector<std::complex<double>> transform_;
  Eigen::FFT<double> fft_;
};

std::size_t segment_of(std::size_t n_taps, const SpectrumOptions& options) {
  return options.segment == 0 ? n_taps : options.segment;
}

// Covariance of the powers at two lines, summed over all pairs of `segments` segments and divided
// by their number: by distance of the lines, [n / 2 + 1]. For a pair of segments `shift` taps apart
// it is the squared modulus of the transform of their windows' product.
std::vector<double> shared_power(const SpectrumOptions& options, std::size_t segments) {
  const std::size_t n = options.segment;
  const std::vector<double> weights = weights_of(options.window, n);
  Eigen::FFT<double> fft;
  fft.SetFlag(fft.HalfSpectrum);
  std::vector<double> shared(n / 2 + 1, 0.0);
  double power = 0;
  for (const double weight : weights) power += weight * weight;
  for (std::size_t j = 0; j < segments && j * (n - options.overlap) < n; ++j) {
    const std::size_t shift = j * (n - options.overlap);
    std::vector<double> product(n, 0.0);
    for (std::size_t i = 0; i + shift < n; ++i) product[i] = weights[i] * weights[i + shift];
    std::vector<std::complex<double>> transform;
    fft.fwd(transform, product);
    const double share = 1 - static_cast<double>(j) / static_cast<double>(segments);
    for (std::size_t m = 0; m < shared.size(); ++m) {
      shared[m] += (j == 0 ? 1 : 2) * share * std::norm(transform[m]) / (power * power);
    }
  }
  return shared;
}

}  // namespace

std::size_t n_segments(std::size_t n_taps, const SpectrumOptions& options) {
  const std::size_t n = segment_of(n_taps, options);
  return n_taps < n || n < 2 ? 0 : 1 + (n_taps - n) / (n - options.overlap);
}

Spectrum welch(std::span<const double> series, const SpectrumOptions& options) {
  const std::size_t n = segment_of(series.size(), options);
  assert(n >= 2 && series.size() >= n && options.overlap < n);
  Periodograms periodograms(n, options.window, options.detrending);
  for (std::size_t s = 0; s < n_segments(series.size(), options); ++s) {
    periodograms.add(series.subspan(s * (n - options.overlap), n));
  }
  return periodograms.mean();
}

Spectrum periodogram(std::span<const double> series, Taper window, Detrending detrending) {
  return welch(series, {.window = window, .detrending = detrending});
}

std::size_t first_sound_line(const SpectrumOptions& options) {
  const std::size_t lobe = options.window == Taper::hann ? 3 : 1;
  return options.detrending == Detrending::linear ? lobe + 1 : lobe;
}

std::vector<double> relative_errors(const SpectrumOptions& options, std::size_t segments,
                                    std::span<const std::size_t> lines) {
  assert(options.segment >= 2 && segments >= 1);
  const std::vector<double> shared = shared_power(options, segments);
  std::vector<double> errors;
  for (const std::size_t n : lines) {
    const auto n_lines = static_cast<double>(n);
    double sum = shared[0];
    for (std::size_t m = 1; m < n; ++m) {
      sum += 2 * (1 - static_cast<double>(m) / n_lines) * shared[m];
    }
    errors.push_back(std::sqrt(sum / (static_cast<double>(segments) * n_lines)));
  }
  return errors;
}

Eigen::MatrixXd relative_covariances(const SpectrumOptions& options, std::size_t segments,
                                     std::span<const std::size_t> first) {
  assert(options.segment >= 2 && segments >= 1 && !first.empty());
  constexpr std::size_t farthest = 64;  // lines, beyond which no window makes them share anything
  const std::vector<double> shared = shared_power(options, segments);
  const auto n_bins = static_cast<Eigen::Index>(first.size() - 1);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(n_bins, n_bins);
  const auto lines_of = [&](Eigen::Index b) {
    return first[static_cast<std::size_t>(b + 1)] - first[static_cast<std::size_t>(b)];
  };
  std::vector<Eigen::Index> bin_of;
  for (Eigen::Index b = 0; b < n_bins; ++b) bin_of.insert(bin_of.end(), lines_of(b), b);
  for (std::size_t k = 0; k < bin_of.size(); ++k) {
    for (std::size_t l = k - std::min(k, farthest); l <= k; ++l) {
      sums(bin_of[k], bin_of[l]) += shared[k - l];
      if (l < k) sums(bin_of[l], bin_of[k]) += shared[k - l];
    }
  }
  for (Eigen::Index b = 0; b < n_bins; ++b) {
    for (Eigen::Index c = 0; c < n_bins; ++c)
      sums(b, c) /= static_cast<double>(segments * lines_of(b) * lines_of(c));
  }
  return sums;
}

std::vector<double> expected_welch(const SpectrumOptions& options,
                                   const std::function<double(std::size_t)>& covariance) {
  const std::size_t n = options.segment;
  assert(n >= 2);
  // The correlation of the window with itself, by its transform; zeros keep its ends apart.
  std::vector<double> padded = weights_of(options.window, n);
  padded.resize(2 * n, 0.0);
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> transform;
  fft.fwd(transform, padded);
  for (auto& line : transform) line = std::norm(line);
  std::vector<double> overlap;
  fft.inv(overlap, transform);
  // Lags of both signs, folded on to a period of n: lines k / n do not distinguish them.
  std::vector<double> folded(n, 0.0);
  folded[0] = overlap[0] * covariance(0);
  for (std::size_t lag = 1; lag < n; ++lag) {
    const double term = overlap[lag] * covariance(lag);
    folded[lag] += term;
    folded[n - lag] += term;
  }
  fft.fwd(transform, folded);
  std::vector<double> lines;
  for (std::size_t k = 0; k <= n / 2; ++k) lines.push_back(transform[k].real());
  return lines;
}

std::size_t fast_length(std::size_t n) {
  for (;; --n) {
    std::size_t rest = n;
    for (const std::size_t prime : {2, 3, 5}) {
      while (rest % prime == 0) rest /= prime;
    }
    if (rest == 1) return n;
  }
}

}  // namespace jostle::inline ensemble
