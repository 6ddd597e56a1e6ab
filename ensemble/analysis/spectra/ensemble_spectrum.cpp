#include "ensemble/analysis/spectra/ensemble_spectrum.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/numbers.hpp"
#include "ensemble/moments.hpp"
#include "ensemble/statistics/jackknife.hpp"

namespace jostle::inline ensemble {

namespace {

struct Points {
  std::vector<double> x, y;
  std::vector<Eigen::Index> bin;
};

Points in_band(std::span<const double> frequency, std::span<const double> log_density,
               const Band& band) {
  constexpr double rounding = 1e-9;  // a bin at an end of the band is inside
  Points points;
  for (std::size_t i = 0; i < frequency.size(); ++i) {
    const bool inside = frequency[i] >= band.lowest * (1 - rounding) &&
                        frequency[i] <= band.highest * (1 + rounding);
    if (!inside || frequency[i] <= 0 || !std::isfinite(log_density[i])) continue;
    points.x.push_back(std::log(frequency[i]));
    points.y.push_back(log_density[i]);
    points.bin.push_back(static_cast<Eigen::Index>(i));
  }
  return points;
}

LogLogSlope straight_line(const Points& points) {
  const std::size_t n = points.x.size();
  if (n < 3) return {not_a_number, not_a_number, 0, n};
  Moments x, y;
  for (std::size_t i = 0; i < n; ++i) x.add(points.x[i]), y.add(points.y[i]);
  double xx = 0, xy = 0, squares = 0;
  for (std::size_t i = 0; i < n; ++i) {
    xx += (points.x[i] - x.mean()) * (points.x[i] - x.mean());
    xy += (points.x[i] - x.mean()) * (points.y[i] - y.mean());
  }
  const double slope = xy / xx;
  for (std::size_t i = 0; i < n; ++i) {
    const double residual = points.y[i] - y.mean() - slope * (points.x[i] - x.mean());
    squares += residual * residual;
  }
  return {slope, std::sqrt(squares / static_cast<double>(n - 2) / xx), static_cast<double>(n - 2),
          n};
}

std::vector<double> bin_means(const Spectrum& spectrum, const FrequencyBins& bins) {
  std::vector<double> means;
  for (std::size_t b = 0; b < bins.n_bins(); ++b) {
    double sum = 0;
    for (std::size_t k = bins.first[b]; k < bins.first[b + 1]; ++k) sum += spectrum.density[k];
    means.push_back(sum / static_cast<double>(bins.n_lines(b)));
  }
  return means;
}

std::vector<double> relative_errors_of(const FrequencyBins& bins, std::size_t n_taps,
                                       const SpectrumOptions& options) {
  std::vector<std::size_t> lines;
  for (std::size_t b = 0; b < bins.n_bins(); ++b) lines.push_back(bins.n_lines(b));
  return relative_errors(options, n_segments(n_taps, options), lines);
}

constexpr std::size_t none_left_out = std::numeric_limits<std::size_t>::max();

}  // namespace

FrequencyBins logarithmic_bins(std::size_t segment, std::size_t first_line, double per_decade,
                               std::size_t end) {
  assert(first_line >= 1 && per_decade > 0);
  FrequencyBins bins;
  const double ratio = std::pow(10.0, 1 / per_decade);
  for (std::size_t first = first_line; first < end;) {
    const auto wide = static_cast<std::size_t>(std::lround(static_cast<double>(first) * ratio));
    const std::size_t next = std::min(end, std::max(first + 1, wide));
    double logarithms = 0;
    for (std::size_t k = first; k < next; ++k) {
      logarithms += std::log(static_cast<double>(k) / static_cast<double>(segment));
    }
    bins.first.push_back(first);
    bins.frequency.push_back(std::exp(logarithms / static_cast<double>(next - first)));
    first = next;
  }
  bins.first.push_back(std::max(first_line, end));
  return bins;
}

LogLogSlope log_log_slope(std::span<const double> frequency, std::span<const double> density,
                          const Band& band) {
  assert(frequency.size() == density.size());
  std::vector<double> logarithms;
  for (const double value : density) logarithms.push_back(std::log(value));
  return straight_line(in_band(frequency, logarithms, band));
}

SpectrumAverage::SpectrumAverage(std::size_t n_taps, const SpectrumOptions& options,
                                 double bins_per_decade)
    : n_taps_(n_taps),
      options_(options),
      bins_(logarithmic_bins(options.segment, first_sound_line(options), bins_per_decade,
                             options.segment / 2 + 1)),
      slope_bins_(logarithmic_bins(options.segment, first_sound_line(options), bins_per_decade,
                                   (options.segment + 1) / 2)),
      relative_errors_(relative_errors_of(bins_, n_taps, options)),
      slope_errors_(relative_errors_of(slope_bins_, n_taps, options)),
      slope_covariances_(
          relative_covariances(options, n_segments(n_taps, options), slope_bins_.first)) {
  assert(options.segment > 0 && n_segments(n_taps, options) > 0);
}

void SpectrumAverage::add(std::span<const double> series) {
  assert(series.size() == n_taps_);
  const Spectrum spectrum = welch(series, options_);
  densities_.push_back(bin_means(spectrum, bins_));
  slope_densities_.push_back(bin_means(spectrum, slope_bins_));
}

EnsembleSpectrum SpectrumAverage::result() const {
  assert(!densities_.empty());
  EnsembleSpectrum spectrum{.bins = bins_,
                            .density = {},
                            .error = {},
                            .realizations = densities_.size(),
                            .segments = n_segments(n_taps_, options_)};
  for (std::size_t b = 0; b < bins_.n_bins(); ++b) {
    Moments moments;
    for (const auto& density : densities_) moments.add(density[b]);
    spectrum.density.push_back(moments.mean());
    spectrum.error.push_back(densities_.size() > 1 ? moments.standard_error()
                                                   : moments.mean() * relative_errors_[b]);
  }
  return spectrum;
}

std::vector<double> SpectrumAverage::sound_log_density(std::size_t left_out) const {
  std::vector<double> logarithms;
  const double n =
      static_cast<double>(slope_densities_.size()) - (left_out == none_left_out ? 0 : 1);
  for (std::size_t b = 0; b < slope_bins_.n_bins(); ++b) {
    double sum = 0;
    for (std::size_t r = 0; r < slope_densities_.size(); ++r) {
      if (r != left_out) sum += slope_densities_[r][b];
    }
    const double inverse = slope_errors_[b] * slope_errors_[b] / n;  // 1 / k
    logarithms.push_back(std::log(sum / n) + inverse / 2 + inverse * inverse / 12);
  }
  return logarithms;
}

LogLogSlope SpectrumAverage::slope(const Band& band) const {
  const auto spectrum_without = [&](std::size_t left_out) {
    return straight_line(in_band(slope_bins_.frequency, sound_log_density(left_out), band));
  };
  LogLogSlope slope = spectrum_without(none_left_out);
  if (slope_densities_.size() < 3) {
    if (slope.n_points >= 3) slope.error = gaussian_error(sound_log_density(none_left_out), band);
    slope.dof = std::numeric_limits<double>::infinity();
    return slope;
  }
  std::vector<double> slopes;
  for (std::size_t r = 0; r < slope_densities_.size(); ++r)
    slopes.push_back(spectrum_without(r).slope);
  slope.dof = static_cast<double>(slope_densities_.size() - 1);
  slope.error = jackknife_error(slopes);
  return slope;
}

double SpectrumAverage::gaussian_error(std::span<const double> log_density,
                                       const Band& band) const {
  const Points points = in_band(slope_bins_.frequency, log_density, band);
  const Eigen::Map<const Eigen::ArrayXd> x(points.x.data(),
                                           static_cast<Eigen::Index>(points.x.size()));
  const Eigen::ArrayXd deviations = x - x.mean();
  const Eigen::VectorXd weights = (deviations / deviations.square().sum()).matrix();
  Eigen::MatrixXd of_logarithms =
      slope_covariances_(points.bin, points.bin) / static_cast<double>(slope_densities_.size());
  for (Eigen::Index b = 0; b < of_logarithms.rows(); ++b) {
    for (Eigen::Index c = 0; c < of_logarithms.cols(); ++c) {
      // The variance of the logarithm of a mean of k = 1/v exponential variables; of two that share
      // the part v, the first terms of the dilogarithm.
      const double v = of_logarithms(b, c);
      of_logarithms(b, c) = b == c ? v + v * v / 2 + v * v * v / 6 : v + v * v / 4;
    }
  }
  return std::sqrt(weights.dot(of_logarithms * weights));
}

double SpectrumAverage::autoregressive_slope(double time, const Band& band) const {
  const double rho = (2 * time - 1) / (2 * time + 1);
  const std::vector<double> lines = expected_welch(
      options_, [rho](std::size_t lag) { return std::pow(rho, static_cast<double>(lag)); });
  std::vector<double> means;
  for (std::size_t b = 0; b < slope_bins_.n_bins(); ++b) {
    Moments bin;
    for (std::size_t k = slope_bins_.first[b]; k < slope_bins_.first[b + 1]; ++k) bin.add(lines[k]);
    means.push_back(bin.mean());
  }
  return log_log_slope(slope_bins_.frequency, means, band).slope;
}

}  // namespace jostle::inline ensemble
