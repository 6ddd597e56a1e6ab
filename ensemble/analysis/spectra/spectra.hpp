#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "engine/fields.hpp"

// Power spectra of one evenly spaced series, in the conventions of scipy.signal: densities,
// one-sided, the window periodic. Frequencies are in 1/taps.
namespace jostle::inline ensemble {

enum class Taper { boxcar, hann };  // the window: engine/bed/window.hpp has another Window
enum class Detrending { none, mean, linear };  // detrending of every segment, before the window
inline constexpr NameTable<Taper, 2> taper_names{
    {{"hann", Taper::hann}, {"boxcar", Taper::boxcar}}};
inline constexpr NameTable<Detrending, 3> detrending_names{
    {{"mean", Detrending::mean}, {"linear", Detrending::linear}, {"none", Detrending::none}}};

struct SpectrumOptions {
  Taper window = Taper::hann;
  Detrending detrending = Detrending::mean;
  std::size_t segment = 0;  // taps of one, at least 2; 0: the whole series in one
  std::size_t overlap = 0;  // taps shared by neighbouring segments, below `segment`
};

/// Lines k = 0 .. n/2 of segments of n taps.
struct Spectrum {
  std::vector<double> frequency;  // k / n
  std::vector<double> density;    // taps times the square of the series' units

  std::size_t n_lines() const { return frequency.size(); }
};

/// |FFT(w (x - trend))|^2 / sum w^2, doubled but for the lines 0 and n/2: the sum of the lines
/// times 1/n is the variance of a series that boxcar and mean leave as it is. Cost grows with the
/// largest prime factor of the length.
Spectrum periodogram(std::span<const double> series, Taper window, Detrending detrending);

/// The mean of the periodograms of overlapping segments (Welch 1967, doi:10.1109/TAU.1967.1161901);
/// taps at the end that fill no segment are left out. The series holds at least one segment.
Spectrum welch(std::span<const double> series, const SpectrumOptions& options);

/// Segments that welch() averages in a series of n taps.
std::size_t n_segments(std::size_t n_taps, const SpectrumOptions& options);

/// The first line of a spectrum that neither the detrending nor the window's main lobe around the
/// removed trend spoils: 3 for Hann, 1 for boxcar, one more with linear detrending.
std::size_t first_sound_line(const SpectrumOptions& options);

/// Standard errors of means of `lines` neighbouring lines of a Welch estimate, relative to them,
/// for Gaussian noise with a spectrum that is smooth over them: 1 for one line of one segment.
/// Counts what overlapping segments and neighbouring lines share through the window (Welch 1967).
/// `options.segment` > 0; every element of `lines` in 1 .. n/2 + 1.
std::vector<double> relative_errors(const SpectrumOptions& options, std::size_t segments,
                                    std::span<const std::size_t> lines);

/// Covariances, relative to both means, of means of lines first[b] .. first[b + 1] - 1 and of lines
/// first[c] .. first[c + 1] - 1 of a Welch estimate, as relative_errors(). Symmetric, [n_bins,
/// n_bins].
Eigen::MatrixXd relative_covariances(const SpectrumOptions& options, std::size_t segments,
                                     std::span<const std::size_t> first);

/// Means of the lines of welch(), up to a common factor, for a stationary process with this
/// covariance at lags 0 .. segment - 1; what detrending takes from the first sound line on is
/// left out. [segment / 2 + 1].
std::vector<double> expected_welch(const SpectrumOptions& options,
                                   const std::function<double(std::size_t)>& covariance);

/// The largest length of at most n that has no prime factor above 5, so that its transform is
/// fast. n >= 1.
std::size_t fast_length(std::size_t n);

}  // namespace jostle::inline ensemble
