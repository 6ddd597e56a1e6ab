#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ensemble/analysis/spectra/spectra.hpp"

namespace jostle::inline ensemble {

/// Neighbouring lines put together, about equally wide in log frequency.
struct FrequencyBins {
  std::vector<std::size_t> first;  // [n_bins + 1], lines first[b] .. first[b + 1] - 1 are in bin b
  std::vector<double> frequency;   // [n_bins], geometric means of the lines'

  std::size_t n_bins() const { return frequency.size(); }
  std::size_t n_lines(std::size_t bin) const { return first[bin + 1] - first[bin]; }
};

/// Bins of a spectrum of segments of n taps, from line `first_line` >= 1 to the last before `end`
/// <= n/2 + 1, none empty.
FrequencyBins logarithmic_bins(std::size_t segment, std::size_t first_line, double per_decade,
                               std::size_t end);

/// Frequencies, in 1/taps, both ends included.
struct Band {
  double lowest = 0, highest = 0.5;
  bool operator==(const Band&) const = default;

  static constexpr Bounds form{{0, 0.5, true, false},
                               {0, 0.5, false, true},
                               "frequencies, lowest and highest, in 1/taps",
                               "band",
                               "the lowest frequency comes first"};
};

/// s of density ~ frequency^s by least squares on the logarithms, every point with equal weight.
struct LogLogSlope {
  double slope = 0;
  double error = 0;          // standard error
  double dof = 0;            // degrees of freedom of the error
  std::size_t n_points = 0;  // in the band
};

/// Error from the scatter about the line. Points with a density of 0 are left out; fewer than
/// three points in the band give NaN.
LogLogSlope log_log_slope(std::span<const double> frequency, std::span<const double> density,
                          const Band& band);

/// Means over realizations with the errors of these means: over realizations where there are two
/// or more, else the theoretical error of a Welch estimate of Gaussian noise.
struct EnsembleSpectrum {
  FrequencyBins bins;
  std::vector<double> density, error;  // [n_bins]
  std::size_t realizations = 0, segments = 0;
};

/// Welch spectra of one series after another, all of n_taps, in logarithmic bins.
class SpectrumAverage {
 public:
  /// `options.segment` > 0, of which n_taps holds at least one.
  SpectrumAverage(std::size_t n_taps, const SpectrumOptions& options, double bins_per_decade = 10);

  void add(std::span<const double> series);

  /// After at least one series.
  EnsembleSpectrum result() const;
  /// The slope of the mean spectrum. The mean of k independent exponential variables, chi
  /// squared of 2 k degrees of freedom, has a logarithm that is low by 1/(2 k) + 1/(12 k^2) on
  /// average: this is put right before the fit. The error is a jackknife over realizations, of
  /// M - 1 degrees of freedom; of fewer than 3, that of Gaussian noise, of infinitely many.
  LogLogSlope slope(const Band& band) const;
  /// Returns the mean of slope() for an AR(1) process of autocorrelation time `time` > 0 (below
  /// 1/2: of negative rho), without its scatter, for the windows, bins, band and straight line of
  /// slope().
  double autoregressive_slope(double time, const Band& band) const;

 private:
  std::vector<double> sound_log_density(std::size_t left_out) const;
  double gaussian_error(std::span<const double> log_density, const Band& band) const;

  std::size_t n_taps_;
  SpectrumOptions options_;
  FrequencyBins bins_;
  /// Without line n/2 of an even n, which has one side only and half the density of its neighbours:
  /// it would bend the end of the spectrum down.
  FrequencyBins slope_bins_;
  std::vector<double> relative_errors_, slope_errors_;            // [n_bins], of one realization
  Eigen::MatrixXd slope_covariances_;                             // those of slope_bins_
  std::vector<std::vector<double>> densities_, slope_densities_;  // [n_realizations][n_bins]
};

}  // namespace jostle::inline ensemble
