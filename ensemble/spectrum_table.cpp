#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "ensemble/analyses.hpp"

namespace jostle {

namespace {

constexpr const char* welch_1967 = "Welch 1967, doi:10.1109/TAU.1967.1161901";

const char* name_of(Taper window) {
  return window == Taper::hann ? "hann" : "boxcar";
}

const char* name_of(Detrending detrending) {
  switch (detrending) {
    case Detrending::none:
      return "none";
    case Detrending::mean:
      return "mean";
    case Detrending::linear:
      return "linear";
  }
  return "";
}

SpectrumOptions prepared(const AnalysedSeries& series, const SpectrumSettings& settings) {
  assert(series.n_taps() >= fewest_spectrum_taps);
  return spectrum_options(settings, series.n_taps());
}

std::string verdict(const Trend& trend, Detrending detrending) {
  if (!trend.drifts()) return "no drift found";
  const std::string drift = fmt::format("drift: {:+.2g} over the taps ({:.0f} % of the variance)",
                                        trend.change, 100 * trend.share);
  if (detrending == Detrending::linear) return drift + "; its straight part was removed";
  return drift + "; it adds a slope of -2 at low frequencies: use linear detrending or later taps";
}

}  // namespace

SpectrumOptions spectrum_options(const SpectrumSettings& settings, std::uint64_t n_taps) {
  assert(n_taps >= fewest_spectrum_taps);
  const std::size_t segment = settings.segment.value_or(
      fast_length(std::max<std::size_t>(n_taps / 4, fewest_spectrum_taps / 2)));
  return {.window = settings.window,
          .detrending = settings.detrending,
          .segment = segment,
          .overlap = settings.window == Taper::hann ? segment / 2 : 0};
}

SpectrumAnalysis::SpectrumAnalysis(const AnalysedSeries& series, const SpectrumSettings& settings)
    : series_(series),
      settings_(settings),
      options_(prepared(series, settings)),
      average_(series.n_taps(), options_) {}

void SpectrumAnalysis::add(std::span<const double> values) {
  average_.add(values);
  trend_.add(values);
}

Table SpectrumAnalysis::table() const {
  const EnsembleSpectrum spectrum = average_.result();
  const Trend trend = trend_.result();
  const Band band =
      settings_.band.value_or(Band{.lowest = static_cast<double>(spectrum.bins.first.front()) /
                                             static_cast<double>(options_.segment),
                                   .highest = 0.5});
  const LogLogSlope slope = average_.slope(band);
  std::vector<std::uint64_t> lines;
  for (std::size_t b = 0; b < spectrum.bins.n_bins(); ++b)
    lines.push_back(spectrum.bins.n_lines(b));
  const std::string density_units =
      series_.units == "1" ? "taps" : fmt::format("{}^2 taps", series_.units);
  const std::vector<std::string> along = {"frequency"};
  Table table{.name = "spectrum/" + series_.observable, .axes = {}, .quantities = {}, .notes = {}};
  table.axes = {{"frequency", along, spectrum.bins.frequency, "1/taps",
                 "geometric mean of the lines of a bin", ""}};
  table.quantities = {
      {"density", along, spectrum.density, density_units, "one-sided power spectral density",
       welch_1967},
      {"density_error", along, spectrum.error, density_units,
       spectrum.realizations > 1 ? "standard error over realizations"
                                 : "standard error for Gaussian noise",
       ""},
      {"lines", along, lines, "1", "lines of a bin", ""},
      {"slope",
       {},
       std::vector{slope.slope},
       "1",
       "log-log slope in the band",
       "Philippe & Bideau 2001, fig. 3: -1 to -1.5"},
      {"slope_error",
       {},
       std::vector{slope.error},
       "1",
       spectrum.realizations > 2 ? "jackknife over realizations"
                                 : "from the scatter about the line",
       ""},
      {"drift",
       {},
       std::vector{trend.change},
       series_.units,
       "change of the mean over the taps, by a straight line",
       ""},
      {"drift_error",
       {},
       std::vector{trend.slope_error * static_cast<double>(series_.n_taps())},
       series_.units,
       "its standard error",
       ""},
      {"drift_share", {}, std::vector{trend.share}, "1", "of the variance in time", ""}};
  table.notes = {{"observable", series_.observable},
                 {"taps", fmt::format("{} to {}", series_.first_tap, series_.last_tap)},
                 {"realizations", fmt::to_string(spectrum.realizations)},
                 {"window", name_of(options_.window)},
                 {"detrending", name_of(options_.detrending)},
                 {"segments", fmt::format("{} of {} taps, {} shared with the next",
                                          spectrum.segments, options_.segment, options_.overlap)},
                 {"band", fmt::format("{:.4g} to {:.4g} per tap, {} points", band.lowest,
                                      band.highest, slope.n_points)},
                 {"verdict", verdict(trend, options_.detrending)}};
  return table;
}

}  // namespace jostle
