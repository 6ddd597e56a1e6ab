#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "ensemble/analysis/spectra/spectra.hpp"
#include "ensemble/analysis/steady_state.hpp"
#include "ensemble/moments.hpp"
#include "tests/ensemble/noise.hpp"

using namespace jostle;

namespace {

constexpr double level = 1e5, fluctuation = 1e-6;
constexpr std::size_t n_taps = 1'000'000;

/// <Z> near 1e5 diameters with fluctuations of 1e-6, in which one ulp is 1.5e-11.
std::vector<double> deep_bed() {
  std::vector<double> series(n_taps);
  RandomStream random = test_stream(20260104);
  for (double& value : series) value = level + fluctuation * noise(random);
  return series;
}

/// Deviation with 1/M, in two passes of long double.
double exact_sigma(const std::vector<double>& series) {
  long double sum = 0, squares = 0;
  for (const double value : series) sum += value - level;
  const long double mean = sum / series.size();
  for (const double value : series) squares += (value - level - mean) * (value - level - mean);
  return static_cast<double>(std::sqrt(squares / series.size()));
}

}  // namespace

TEST_CASE("a million taps of <Z> near 1e5 with fluctuations of 1e-6 keep their digits",
          "[statistics]") {
  const std::vector<double> series = deep_bed();
  const double sigma = exact_sigma(series);
  Moments moments;
  for (const double value : series) moments.add(value);
  CHECK(moments.sigma() == Approx(sigma).epsilon(1e-10));
  // A mean is rounded to one ulp of 1e5.
  CHECK(moments.mean() == Approx(level).epsilon(0).margin(1e-8));
  CHECK(moments.standard_error() == Approx(sigma / 1e3).epsilon(1e-5));

  SteadyStateTest test;
  test.add(series);
  const SteadyState steady = test.result();
  CHECK(steady.verdict() == Verdict::reached);
  CHECK(steady.sigma == Approx(sigma).epsilon(1e-4));
  // White noise: blocks do not change the error, whose own error is 1 / sqrt(2 blocks).
  const auto plateau = steady.blocking.plateau;
  REQUIRE(plateau);
  const BlockingLevel& found = steady.blocking.levels[*plateau];
  CHECK(std::abs(found.error - sigma / 1e3) <= 3 * found.error_error);
  CHECK(std::abs(steady.autocorrelation.time - 0.5) <= 3 * steady.autocorrelation.error);
  CHECK(std::abs(steady.trend.line.value) <= 3 * steady.trend.line.series_error.error);

  // The spectrum of white noise of deviation sigma is 2 sigma^2 taps.
  const SpectrumOptions options{.segment = 1000, .overlap = 500};
  const Spectrum spectrum = welch(series, options);
  double density = 0;
  const std::size_t first = first_sound_line(options), last = spectrum.n_lines() - 1;
  for (std::size_t k = first; k < last; ++k) density += spectrum.density[k];
  density /= static_cast<double>(last - first);
  const std::vector<std::size_t> lines = {last - first};
  const double error = relative_errors(options, n_segments(n_taps, options), lines)[0];
  CHECK(std::abs(density / (2 * sigma * sigma) - 1) <= 3 * error);
}

TEST_CASE("series whose values are all equal have no spread, at any level") {
  for (const double value : {0.0, 0.6, 1e5, -1e300, 1e-300, 5e-324}) {
    CAPTURE(value);
    const std::vector<double> series(4096, value);
    Moments moments;
    for (const double x : series) moments.add(x);
    CHECK(moments.mean() == value);
    CHECK(moments.sigma() == 0);
    CHECK(moments.standard_error() == 0);

    SteadyStateTest test;
    test.add(series);
    const SteadyState state = test.result();
    CHECK(state.value == value);
    CHECK(state.sigma == 0);
    CHECK_FALSE(state.error.error > 0);
    CHECK_FALSE(state.trend.drifts());
    CHECK(std::isnan(state.realization_sigma));
    test.add(series);
    CHECK(test.result().realization_sigma == 0);

    if (std::abs(value) > 1e100) continue;  // its square is no double
    for (const double density : periodogram(series, Taper::hann, Detrending::mean).density) {
      CHECK(density <= 1e-20 * value * value);
    }
  }
}

TEST_CASE("one realization of one value has no error, and reports it") {
  Moments moments;
  moments.add(0.6);
  CHECK(moments.mean() == 0.6);
  CHECK(moments.sigma() == 0);
  CHECK(std::isnan(moments.standard_error()));
  Blocking blocking;
  blocking.add(std::array{0.6});
  CHECK(std::isnan(blocking.result().error()));
  CHECK_FALSE(blocking.result().plateau);
}
