#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "ensemble/analysis/analyses.hpp"
#include "ensemble/analysis/steady_state.hpp"
#include "ensemble/statistics/counted.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline ensemble {

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

std::string drift_verdict(const Trend& trend, Detrending detrending) {
  if (!trend.drifts()) {
    if (trend.tests == 0 || trend.is_constant()) return trend.statement();
    return trend.detectable_in_sigma() <= SteadyStateTest::largest_unseen
               ? trend.statement() + "; " + trend.power()
               : fmt::format("cannot decide whether it drifts: {}, but {}", trend.statement(),
                             trend.power("only "));
  }
  const std::string drift =
      finite_text("{}, {:.0f} % of the variance", trend.statement(), 100 * trend.share);
  if (detrending == Detrending::linear) return drift + "; its straight part was removed";
  return drift + "; it adds a slope of -2 at low frequencies: use linear detrending or later taps";
}

/// The slope that memory alone gives.
struct AutoregressiveSlope {
  double slope = 0;
  ErrorOf error{};  // from that of the time
  double p = 1;     // p-value for this value of the measured slope
  /// Difference of the slopes that is found with 80 % power. NaN of one realization: where it hides
  /// a memory, both the difference and its error are too small.
  double detectable = not_a_number;
};

AutoregressiveSlope autoregressive(const SpectrumAverage& average, const LogLogSlope& measured,
                                   const AutocorrelationTime& memory, const Band& band,
                                   std::size_t n_realizations) {
  // Below 1/2, rho is negative and the spectrum rises with the frequency.
  constexpr double shortest = 1e-4;
  const auto value_at = [&](double time) {
    return average.autoregressive_slope(std::max(time, shortest), band);
  };
  if (!memory.found()) return {not_a_number, {}, not_a_number};
  AutoregressiveSlope found{.slope = value_at(memory.time)};
  // By so much slopes of true AR(1) are off in short series, however many realizations there are.
  constexpr double bias = 0.03;
  // A time that is below 1/2 by less than two errors may be that of white noise, whose slope is 0.
  const bool may_be_white = memory.time < 0.5 && memory.time + 2 * memory.error > 0.5;
  found.error = {std::hypot(0.5 * (value_at(memory.time + memory.error) -
                                   value_at(memory.time - memory.error)),
                            bias, may_be_white ? found.slope : 0),
                 std::numeric_limits<double>::infinity()};
  const ErrorOf difference_error = combined({measured.error, measured.dof}, found.error);
  found.p = p_value(measured.slope - found.slope, difference_error);
  if (n_realizations > 1 && difference_error.known())
    found.detectable =
        difference_error.error * smallest_effect_found(significance_level, difference_error.dof);
  return found;
}

std::string slope_verdict(const LogLogSlope& slope, const AutoregressiveSlope& memory,
                          const AutocorrelationTime& time, const Trend& trend) {
  if (trend.is_constant()) return "no slope: the series is constant";
  if (std::isnan(slope.slope)) return "no slope: fewer than three points in the band";
  if (!time.found())
    return finite_text(
        "no test: the taps are too few to estimate the autocorrelation time ({:.3g} taps or more), "
        "and with it the slope of a stationary AR(1)",
        time.time);
  if (!std::isfinite(memory.slope)) return "no stationary AR(1) to compare the slope with";
  const std::string alone = finite_text(
      "a stationary AR(1) with the same autocorrelation time, {:.3g} taps, has {:.2f} here",
      time.time, memory.slope);
  if (std::isnan(memory.p)) return alone + "; no test";
  if (memory.p < significance_level)
    return finite_text("{}: the slope differs from it ({})", alone, p_text(memory.p));
  const std::string no_difference = finite_text(
      "{}: the slope does not differ significantly from it ({})", alone, p_text(memory.p));
  if (std::isnan(memory.detectable))
    return "cannot decide: " + no_difference + "; what one realization would find is not known";
  // Half the range of AR(1), from 0 of white noise to -2.
  constexpr double largest_unseen = 1;
  return finite_text("{}{}; the test finds most differences of {:.2g} or more",
                     memory.detectable <= largest_unseen ? "" : "cannot decide: ", no_difference,
                     memory.detectable);
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
  Trend trend = trend_.result();
  trend.units = series_.units;
  const Band band =
      settings_.band.value_or(Band{.lowest = static_cast<double>(spectrum.bins.first.front()) /
                                             static_cast<double>(options_.segment),
                                   .highest = 0.5});
  const LogLogSlope slope = average_.slope(band);
  const AutocorrelationTime time = trend_.unbiased_memory();
  const AutoregressiveSlope memory =
      autoregressive(average_, slope, time, band, spectrum.realizations);
  const double dof = spectrum.realizations > 1 ? static_cast<double>(spectrum.realizations - 1)
                                               : std::numeric_limits<double>::infinity();
  std::vector<std::uint64_t> lines;
  for (std::size_t b = 0; b < spectrum.bins.n_bins(); ++b)
    lines.push_back(spectrum.bins.n_lines(b));
  const std::string density_units =
      series_.units == "1" ? "taps" : fmt::format("{}^2 taps", series_.units);
  const std::vector<std::string> axes = {"frequency"};
  Table table{.name = "spectrum/" + series_.observable, .axes = {}, .quantities = {}, .notes = {}};
  table.axes = {{"frequency", axes, spectrum.bins.frequency, "1/taps",
                 "geometric mean of the lines of a bin", ""}};
  table.quantities = {{"density", axes, spectrum.density, density_units,
                       "one-sided power spectral density", welch_1967},
                      {"density_error", axes, spectrum.error, density_units,
                       spectrum.realizations > 1 ? "standard error over realizations"
                                                 : "standard error for Gaussian noise",
                       ""},
                      {"lines", axes, lines, "1", "lines of a bin", ""}};
  const auto add = [&](const char* name, double value, const std::string& units,
                       const char* meaning, const char* source = "") {
    table.quantities.push_back({name, {}, std::vector{value}, units, meaning, source});
  };
  add("density_dof", dof, "1", "degrees of freedom of density_error");
  add("slope", slope.slope, "1", "log-log slope in the band",
      "Philippe & Bideau 2001, fig. 3: -1 to -1.5");
  add("slope_error", slope.error, "1",
      spectrum.realizations > 2 ? "jackknife over realizations" : "for Gaussian noise");
  add("slope_dof", slope.dof, "1", "degrees of freedom of slope_error");
  add("ar1_slope", trend.is_constant() ? std::nan("") : memory.slope, "1",
      "in the same band, of an AR(1) process of the same autocorrelation time");
  add("ar1_slope_error", trend.is_constant() ? std::nan("") : memory.error.error, "1",
      "standard error, from that of the time, and 0.03 for the bias of short series");
  add("ar1_slope_dof", memory.error.dof, "1", "degrees of freedom of ar1_slope_error");
  add("ar1_slope_p", memory.p, "1", "p-value of the slope being ar1_slope, Student's t");
  add("ar1_slope_detectable", memory.detectable, "1",
      "difference from ar1_slope that most ensembles would find at 5 %: nominal power 0.8");
  add("drift", trend.line.value, series_.units,
      "change of the mean over the taps, by a straight line");
  add("drift_error", error_or_nan(trend.line.error()), series_.units,
      trend.line.scatter_error.known() ? "standard error over realizations"
                                       : "standard error within the series");
  add("drift_dof", trend.line.error().dof, "1", "degrees of freedom of drift_error");
  add("drift_p", trend.tests > 0 ? trend.p : std::nan(""), "1",
      "p-value for no drift as the null hypothesis; tests of line and halves, Bonferroni");
  add("drift_share", trend.share, "1",
      "share of the variance in time that the straight line explains");
  table.notes = {{"observable", series_.observable},
                 {"taps", fmt::format("{} to {}", series_.first_tap, series_.last_tap)},
                 {"realizations", fmt::to_string(spectrum.realizations)},
                 {"window", name_of(options_.window)},
                 {"detrending", name_of(options_.detrending)},
                 {"segments", fmt::format("{} of {} taps each; neighbours share {} taps",
                                          counted(spectrum.segments, "segment"), options_.segment,
                                          options_.overlap)},
                 {"band", finite_text("{:.4g} to {:.4g} per tap, {} points", band.lowest,
                                      band.highest, slope.n_points)},
                 {"drift", drift_verdict(trend, options_.detrending)},
                 {"verdict", slope_verdict(slope, memory, time, trend)}};
  return table;
}

}  // namespace jostle::inline ensemble
