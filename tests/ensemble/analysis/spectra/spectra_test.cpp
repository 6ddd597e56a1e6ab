#include "ensemble/analysis/spectra/spectra.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "ensemble/analysis/analyses.hpp"
#include "ensemble/analysis/spectra/ensemble_spectrum.hpp"
#include "ensemble/moments.hpp"
#include "tests/ensemble/synthetic_series.hpp"
#include "tests/test_files.hpp"

using namespace jostle;

namespace {

std::vector<double> numbers_of(const std::string& name) {
  std::ifstream file(test_data("psd/" + name));
  std::vector<double> numbers;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    numbers.push_back(std::stod(line));
  }
  REQUIRE(numbers.size() >= 1024);
  return numbers;
}

// One-sided, of x' = rho x + e with e of variance 1.
double autoregressive_density(double rho, double frequency) {
  return 2 / (1 + rho * rho - 2 * rho * std::cos(2 * std::numbers::pi * frequency));
}

// The value of a bin is the mean of its lines.
double binned(const FrequencyBins& bins, std::size_t bin, std::size_t segment, auto density) {
  double sum = 0;
  for (std::size_t k = bins.first[bin]; k < bins.first[bin + 1]; ++k) {
    sum += density(static_cast<double>(k) / static_cast<double>(segment));
  }
  return sum / static_cast<double>(bins.n_lines(bin));
}

}  // namespace

TEST_CASE("Spectra agree with scipy's own test vectors") {
  std::ifstream file(test_data("psd/scipy_vectors.json"));
  const auto reference = nlohmann::json::parse(file);
  for (const auto& vector : reference.at("vectors")) {
    CAPTURE(vector.at("name").get<std::string>());
    const auto series = vector.at("x").get<std::vector<double>>();
    const auto expected = vector.at("p").get<std::vector<double>>();
    const bool whole = !vector.contains("nperseg");
    const Spectrum spectrum =
        whole ? periodogram(series, Taper::boxcar, Detrending::mean)
              : welch(series, {.window = Taper::hann,
                               .detrending = Detrending::mean,
                               .segment = vector.at("nperseg").get<std::size_t>(),
                               .overlap = vector.at("noverlap").get<std::size_t>()});
    REQUIRE(spectrum.density.size() == expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      CAPTURE(k);
      CHECK(spectrum.density[k] == Approx(expected[k]).epsilon(1e-12).margin(1e-30));
    }
    if (!vector.contains("f")) continue;
    const auto frequencies = vector.at("f").get<std::vector<double>>();
    for (std::size_t k = 0; k < frequencies.size(); ++k) {
      CHECK(spectrum.frequency[k] == Approx(frequencies[k]).epsilon(1e-15));
    }
  }
}

TEST_CASE("A boxcar periodogram gives power-law signals their densities and slopes") {
  const auto [name, alpha] = GENERATE(std::pair<std::string, double>{"powerlaw_alpha1.0.dat", 1.0},
                                      std::pair<std::string, double>{"powerlaw_alpha2.0.dat", 2.0});
  const std::vector<double> series = numbers_of(name);
  const Spectrum spectrum = periodogram(series, Taper::boxcar, Detrending::mean);
  for (std::size_t k = 1; k < spectrum.n_lines() - 1; ++k) {
    const double expected =
        std::pow(static_cast<double>(k), -alpha) * static_cast<double>(series.size()) / 2;
    CHECK(spectrum.density[k] == Approx(expected).epsilon(1e-10));
  }
  const LogLogSlope slope =
      log_log_slope(spectrum.frequency, spectrum.density, {.lowest = 0.0005, .highest = 0.49});
  CHECK(slope.slope == Approx(-alpha).epsilon(1e-12));
  CHECK(slope.error < 1e-10);
}

TEST_CASE("The lines of a boxcar periodogram add up to the variance") {
  const auto n = GENERATE(1000, 1001, 4001);
  const std::vector<double> series = synthetic::autoregressive(0.9, n, 71);
  Moments moments;
  for (const double value : series) moments.add(value);
  double sum = 0;
  for (const double density : periodogram(series, Taper::boxcar, Detrending::mean).density) {
    sum += density / n;
  }
  CHECK(sum == Approx(moments.sigma() * moments.sigma()).epsilon(1e-12));
}

TEST_CASE("Linear detrending leaves nothing of a ramp, on a large level") {
  const std::vector<double> ramp = synthetic::with_ramp(std::vector<double>(500, 1e6), 3);
  const Spectrum kept = periodogram(ramp, Taper::hann, Detrending::mean);
  const Spectrum removed = periodogram(ramp, Taper::hann, Detrending::linear);
  CHECK(kept.density[3] > 1e-3);
  for (const double density : removed.density) CHECK(density < 1e-15);
}

TEST_CASE("Logarithmic bins hold every sound line once") {
  const auto segment = GENERATE(7, 8, 50, 1000, 4097);
  const FrequencyBins bins = logarithmic_bins(segment, 3, 10, segment / 2 + 1);
  REQUIRE(bins.n_bins() >= 1);
  CHECK(bins.first.front() == 3);
  CHECK(bins.first.back() == static_cast<std::size_t>(segment) / 2 + 1);
  for (std::size_t b = 0; b < bins.n_bins(); ++b) {
    CHECK(bins.n_lines(b) >= 1);
    const double wide = static_cast<double>(bins.first[b + 1]) / static_cast<double>(bins.first[b]);
    if (bins.n_lines(b) > 1) CHECK(wide < 1.4);
  }
}

TEST_CASE("Fast lengths have no prime factor above 5") {
  CHECK(fast_length(1) == 1);
  CHECK(fast_length(7) == 6);
  CHECK(fast_length(1000) == 1000);
  CHECK(fast_length(4001) == 4000);
  CHECK(fast_length(99991) == 98415);
}

TEST_CASE(
    "The spectrum of the stored AR(1) series is the exact one within its theoretical errors") {
  const std::vector<double> series = numbers_of("ar1_rho0.9_N4096.dat");
  SpectrumAverage average(series.size(), {.segment = 512, .overlap = 256});
  average.add(series);
  const EnsembleSpectrum spectrum = average.result();
  double squares = 0;
  for (std::size_t b = 0; b < spectrum.bins.n_bins(); ++b) {
    const double exact =
        binned(spectrum.bins, b, 512, [](double f) { return autoregressive_density(0.9, f); });
    const double deviation =
        (spectrum.density[b] - exact) / (exact * spectrum.error[b]) * spectrum.density[b];
    CHECK(std::abs(deviation) < 4);
    squares += deviation * deviation;
  }
  // Chi squared, neighbouring bins sharing little: within 3 of its deviations.
  const auto n = static_cast<double>(spectrum.bins.n_bins());
  CHECK(std::abs(squares - n) < 3 * std::sqrt(2 * n));
}

TEST_CASE("The theoretical error of a Welch estimate is the scatter of white noise",
          "[statistics]") {
  const auto window = GENERATE(Taper::hann, Taper::boxcar);
  const SpectrumOptions options{.window = window, .segment = 64, .overlap = 32};
  constexpr std::size_t n_taps = 256, realizations = 4000;
  const std::size_t lines = GENERATE(1, 2, 6);
  Moments means;
  for (std::size_t r = 0; r < realizations; ++r) {
    const Spectrum spectrum = welch(synthetic::autoregressive(0, n_taps, 5, r), options);
    double sum = 0;
    for (std::size_t k = 0; k < lines; ++k) sum += spectrum.density[10 + k];
    means.add(sum / static_cast<double>(lines));
  }
  // Density of white noise of variance 1: 2. A relative deviation from M values of this skewness
  // has a relative error below sqrt(2 / M): within 3 of these.
  const double scatter = means.sigma() / means.mean();
  const double theory =
      relative_errors(options, n_segments(n_taps, options), std::vector{lines})[0];
  CAPTURE(lines, scatter, theory);
  CHECK(means.mean() == Approx(2).margin(3 * means.standard_error()));
  CHECK(scatter == Approx(theory).epsilon(3 * std::sqrt(2.0 / realizations)));
}

TEST_CASE("Averages over realizations give AR(1) its spectrum and a random walk its slope",
          "[statistics]") {
  constexpr std::size_t n_taps = 2048, segment = 1000;
  const SpectrumOptions options{.segment = segment, .overlap = segment / 2};
  SpectrumAverage stationary(n_taps, options), walk(n_taps, options);
  for (std::uint64_t r = 0; r < 100; ++r) {
    stationary.add(synthetic::autoregressive(0.9, n_taps, 6, r));
    walk.add(synthetic::random_walk(n_taps, 7, r));
  }
  const EnsembleSpectrum spectrum = stationary.result();
  double squares = 0;
  for (std::size_t b = 0; b < spectrum.bins.n_bins(); ++b) {
    const double exact =
        binned(spectrum.bins, b, segment, [](double f) { return autoregressive_density(0.9, f); });
    const double deviation = (spectrum.density[b] - exact) / spectrum.error[b];
    CHECK(std::abs(deviation) < 4);
    squares += deviation * deviation;
  }
  const auto n = static_cast<double>(spectrum.bins.n_bins());
  CHECK(std::abs(squares - n) < 3 * std::sqrt(2 * n));

  const Band band{.lowest = 0.004, .highest = 0.05};
  const LogLogSlope slope = walk.slope(band);
  std::vector<double> exact;
  for (std::size_t b = 0; b < walk.result().bins.n_bins(); ++b) {
    exact.push_back(binned(walk.result().bins, b, segment, [](double f) {
      return 1 / (2 * std::pow(std::sin(std::numbers::pi * f), 2));
    }));
  }
  const double expected = log_log_slope(walk.result().bins.frequency, exact, band).slope;
  CAPTURE(slope.slope, slope.error, expected);
  CHECK(expected == Approx(-2).margin(0.02));
  CHECK(slope.error < 0.03);
  CHECK(std::abs(slope.slope - expected) < 3 * slope.error);
}

TEST_CASE("Expected Welch spectra are those of long averages") {
  const auto window = GENERATE(Taper::hann, Taper::boxcar);
  const SpectrumOptions options{.window = window, .detrending = Detrending::none, .segment = 60};
  // Without memory every line has the same, but for the two that have one side.
  const auto white = expected_welch(options, [](std::size_t lag) { return lag == 0 ? 1.0 : 0.0; });
  REQUIRE(white.size() == 31);
  for (const double line : white) CHECK(line == Approx(white[0]).epsilon(1e-12));
  // Against the sum over all pairs of taps.
  const auto memory = [](std::size_t lag) { return std::pow(0.9, static_cast<double>(lag)); };
  const auto lines = expected_welch(options, memory);
  for (const std::size_t k : {0, 1, 7, 30}) {
    double sum = 0;
    for (std::size_t i = 0; i < 60; ++i) {
      for (std::size_t j = 0; j < 60; ++j) {
        const auto weight = [&](std::size_t t) {
          const double s = std::sin(std::numbers::pi * static_cast<double>(t) / 60);
          return window == Taper::hann ? s * s : 1.0;
        };
        const double lag = static_cast<double>(i) - static_cast<double>(j);
        sum += weight(i) * weight(j) * std::pow(0.9, std::abs(lag)) *
               std::cos(2 * std::numbers::pi * static_cast<double>(k) * lag / 60);
      }
    }
    CHECK(lines[k] == Approx(sum).epsilon(1e-10));
  }
}

TEST_CASE("A constant series has neither drift nor slope, in words without a number") {
  for (const std::size_t realizations : {1, 2, 3}) {
    SpectrumAnalysis analysis({.observable = "x", .units = "1", .first_tap = 1, .last_tap = 128},
                              SpectrumSettings{});
    for (std::size_t r = 0; r < realizations; ++r) analysis.add(std::vector<double>(128, 0.1));
    const Table table = analysis.table();
    const auto note = [&](const std::string& name) {
      return std::ranges::find(table.notes, name, [](const auto& entry) { return entry.first; })
          ->second;
    };
    CHECK(note("drift") == "no drift: the series is constant");
    CHECK(note("verdict") == "no slope: the series is constant");
    for (const char* const none : {"slope", "ar1_slope", "ar1_slope_p"}) {
      const auto found = std::ranges::find(table.quantities, none, &Quantity::name);
      CHECK(std::isnan(std::get<std::vector<double>>(found->values).at(0)));
    }
  }
}

TEST_CASE("A slope is compared with AR(1) only where the test can find a difference") {
  const auto verdict_of = [](std::size_t n_taps, std::size_t realizations) {
    SpectrumAnalysis analysis({.observable = "x", .units = "1", .first_tap = 1, .last_tap = n_taps},
                              SpectrumSettings{});
    for (std::size_t r = 0; r < realizations; ++r)
      analysis.add(synthetic::autoregressive(0.9, n_taps, 20261129, r));
    const Table table = analysis.table();
    return std::ranges::find(table.notes, "verdict", [](const auto& entry) { return entry.first; })
        ->second;
  };
  const std::string decided = verdict_of(4000, 10);
  CHECK(decided.starts_with("a stationary AR(1) with the same autocorrelation time"));
  CHECK(decided.find("; the test finds most differences of ") != std::string::npos);
  const std::string undecided = verdict_of(100, 3);
  CAPTURE(undecided);
  CHECK(undecided.starts_with(
      "cannot decide: a stationary AR(1) with the same autocorrelation time"));
  CHECK(undecided.find("; the test finds most differences of ") != std::string::npos);
  const std::string single = verdict_of(4000, 1);
  CAPTURE(single);
  CHECK(single.starts_with("cannot decide: "));
  CHECK(single.ends_with("; what one realization would find is not known"));
}

TEST_CASE("Bands with too few points give no slope") {
  const std::vector<double> frequency{0.1, 0.2, 0.3, 0.4}, density{4, 3, 0, 1};
  CHECK(std::isnan(log_log_slope(frequency, density, {0.1, 0.35}).slope));
  CHECK(log_log_slope(frequency, density, {0.1, 0.5}).n_points == 3);
}

TEST_CASE("A bin at the end of a band is inside, whatever its rounding") {
  const double end = 3.0 / 64;
  const std::vector<double> frequency{end * (1 - 2e-16), 0.1, 0.2, 0.5 * (1 + 2e-16)},
      density{4, 3, 2, 1};
  CHECK(log_log_slope(frequency, density, {end, 0.5}).n_points == 4);
}
