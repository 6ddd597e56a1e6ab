#include "ensemble/analysis/ageing/time_scaling.hpp"

#include <cmath>
#include <limits>

#include "tests/ensemble/analysis/ageing/ageing_calibration.hpp"

// Calibration of mu of t / t_W^mu: estimates, coverage, and rejections of collapses that hold and
// that do not.

namespace jostle {
namespace {

using namespace ageing_paths;

constexpr double infinite = std::numeric_limits<double>::infinity();
const std::vector<std::uint64_t> ages = {10, 100, 1000};

// Eq. 6 of t / t_W^mu, whatever its scale.
Paths power(double mu) {
  Paths paths;
  paths.a_inf = {1, 1, 1};
  for (std::size_t k = 0; k < 3; ++k) {
    paths.tau[k] = 100 * std::pow(static_cast<double>(ages[k]) / 100, mu);
  }
  return paths;
}

// Brownian motion in the time g beside a drift of all alike:
// A(t, t_W) = g(t_W + t) - g(t_W) + (drift (g(t_W + t) - g(t_W)))^2.
LogCurves one_path(std::uint64_t seed, std::uint32_t m, double (*g)(double), double drift = 0) {
  const AgeingGrid grid = {.waiting_times = ages, .lags = logarithmic_taps(1, 10000, 8)};
  RandomStream random = test_stream(seed);
  TapRows rows{.taps = taps_of(grid), .realizations = m, .values = {}};
  std::vector<double> path(m, 0.0);
  double previous = g(static_cast<double>(rows.taps.front()));
  for (const std::uint64_t tap : rows.taps) {
    const double current = g(static_cast<double>(tap));
    for (double& x : path) {
      x += std::sqrt(current - previous) * noise(random) + drift * (current - previous);
      rows.values.push_back(x);
    }
    previous = current;
  }
  std::vector<std::uint32_t> all(m);
  std::iota(all.begin(), all.end(), 0u);
  return log_curves(rows, grid, all);
}

double logarithm(double tap) {
  return std::log(tap);
}

double twice_logarithm(double tap) {
  return std::log(std::log(tap));
}

struct Rates {
  Held mu{.lowest = -infinite};
  Found power, logarithmic;
  void add(const LogCurves& curves, double exact) {
    const AgeingExponent found = ageing_exponent(curves, ages, "a");
    if (!std::isnan(found.low_95)) mu.add(found, exact);
    power.add(found.collapse, "collapse not rejected");
    logarithmic.add(logarithmic_collapse(curves, ages, "a"), "collapse not rejected");
  }
  void print(const std::string& title, std::uint32_t m) const {
    fmt::print("{:12} {:3}{}{}{}\n", title, m, mu.text(), power.text(), logarithmic.text());
  }
};

Rates rates_of_power(double mu, std::uint32_t m, Paths paths, int n, std::uint64_t seed) {
  Rates rates;
  for (int e = 0; e < n; ++e) {
    rates.add(curves_of(seed + static_cast<std::uint64_t>(e), m, paths), mu);
  }
  rates.print(fmt::format("t/t_W^{}", mu), m);
  return rates;
}

Rates rates_of_path(const char* title, double mu, double (*g)(double), std::uint32_t m, int n,
                    std::uint64_t seed, double drift = 0) {
  Rates rates;
  for (int e = 0; e < n; ++e) {
    rates.add(one_path(seed + static_cast<std::uint64_t>(e), m, g, drift), mu);
  }
  rates.print(title, m);
  return rates;
}

void check_few_alarms(const Found& found) {
  CAPTURE(found.share());
  CHECK(found.share() <= 0.1 + 3 * deviation(0.1, found.n));
}

constexpr const char* heading =
    "\nlaw            M | mu: 68    95 % limited | power refuted excluded | logarithmic\n";

void calibrate(std::uint32_t m, int n) {
  std::uint64_t seed = 110'000 * m;
  for (const double mu : {0.0, 0.6, 1.0}) {
    for (const Memory memory : {Memory::long_, Memory::short_}) {
      Paths paths = power(mu);
      paths.memory = memory;
      CAPTURE(m, mu, memory == Memory::long_);
      const Rates rates = rates_of_power(mu, m, paths, n, seed += 1000);
      rates.mu.check(rates.mu.n);
      check_few_alarms(rates.power);
    }
  }
  CAPTURE(m);
  // A = ln(1 + t/t_W): the ages of one path, which share what it does.
  const Rates full = rates_of_path("ln(1+t/t_W)", 1, logarithm, m, n, seed += 1000);
  full.mu.check(full.mu.n);
  check_few_alarms(full.power);
  // A = ln(ln(t_W + t) / ln t_W).
  check_few_alarms(
      rates_of_path("ln t/ln t_W", 1, twice_logarithm, m, n, seed += 1000).logarithmic);
  // Scales of A that age.
  Paths scaled = power(0.6);
  scaled.a_inf = {1, 4, 16};
  const Rates neither = rates_of_power(0.6, m, scaled, n, seed += 1000);
  CHECK(neither.power.excluded <= 0.1 * n);
  if (m >= 40) CHECK(neither.power.share() > 0.5);
  if (m >= 10) CHECK(rates_of_power(0, m, power(0), n, seed += 1000).logarithmic.share() > 0.5);
  check_few_alarms(
      rates_of_path("and a drift", 1, twice_logarithm, m, n, seed + 2000, 2).logarithmic);
}

}  // namespace

TEST_CASE("mu of ages is found, and both collapses can fail", "[statistics]") {
  fmt::print(heading);
  calibrate(4, 40);
}

TEST_CASE("mu of ten realizations is found, and both collapses can fail", "[slow]") {
  fmt::print(heading);
  calibrate(10, 40);
}

TEST_CASE("mu and collapses are calibrated at every number of realizations", "[nightly]") {
  fmt::print(heading);
  for (const std::uint32_t m : {4u, 10u, 40u}) calibrate(m, 300);
}

TEST_CASE("Many realizations give mu and words, one age or two give none") {
  const AgeingExponent found = ageing_exponent(curves_of(1, 400, power(0.6)), ages, "a");
  CAPTURE(found.verdict, found.collapse.verdict);
  CHECK(std::abs(found.mu - 0.6) < 4 * found.error);
  CHECK(found.error < 0.05);
  CHECK(found.verdict.find("no ageing (0) rejected, full ageing (1) rejected") !=
        std::string::npos);
  CHECK(found.collapse.verdict.starts_with("collapse not rejected (change of a at equal t/t_W^mu"));
  const AgeingExponent full = ageing_exponent(one_path(2, 400, logarithm), ages, "a");
  CHECK(full.verdict.find("full ageing (1) not rejected; collapse not rejected") !=
        std::string::npos);

  // From an age of 0 no power and no logarithm of age can be taken.
  const LogCurves curves = curves_of(3, 20, power(0.6));
  const AgeingExponent none = ageing_exponent(curves, {0, 0, 1000}, "a");
  CHECK(std::isnan(none.mu));
  CHECK(none.verdict ==
        "mu has no estimate; cannot decide: fewer than two waiting times above 0 have curves");
  CHECK(!std::isnan(ageing_exponent(curves, {0, 100, 1000}, "a").low_95));
  CHECK(logarithmic_collapse(curves, {1, 1, 1000}, "a").verdict ==
        "cannot decide: fewer than two waiting times above 1 have curves");
  const LogCurves three = curves_of(3, 3, power(0.6));
  CHECK(logarithmic_collapse(three, ages, "a").verdict ==
        "cannot decide: the logarithms need 4 realizations");
  CHECK(ageing_exponent(three, ages, "a").verdict ==
        "mu has no estimate; cannot decide: mu needs 4 realizations");
}

TEST_CASE("mu has a value where it is limited on both sides, within the range of the search") {
  int open = 0, closed = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    for (const double truth : {-0.95, 1.0}) {
      const AgeingExponent found =
          ageing_exponent(curves_of(7000 + seed, 4, power(truth)), ages, "a");
      if (std::isnan(found.low_95)) continue;
      const bool identified = std::isfinite(found.low_95) || std::isfinite(found.high_95);
      const bool limited =
          identified && std::isfinite(found.low_68) && std::isfinite(found.high_68);
      CAPTURE(seed, truth, found.mu, found.error, found.verdict);
      CHECK(std::isfinite(found.mu) == limited);
      CHECK(std::isfinite(found.error) == limited);
      if (limited) CHECK((found.mu >= -1 && found.mu <= 2));
      ++(limited ? closed : open);
    }
  }
  CHECK(open > 0);
  CHECK(closed > 0);
}

TEST_CASE("Printed ends of mu are on the side of no and of full ageing that they are on") {
  int near = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const AgeingExponent found =
        ageing_exponent(curves_of(8000 + seed, 40, power(0.02)), ages, "a");
    CAPTURE(seed, found.verdict, found.low_95, found.high_95);
    if (!std::isfinite(found.low_95) || !std::isfinite(found.high_95)) continue;
    REQUIRE(found.verdict.starts_with("mu is "));
    const double printed = std::stod(found.verdict.substr(6));
    CHECK((printed > 0) == (found.low_95 > 0));
    CHECK(printed == Approx(found.low_95).epsilon(0.01));
    near += std::abs(found.low_95) < 0.005;
  }
  CHECK(near > 0);
}

TEST_CASE("Curves with no more points than F has parameters do not constrain mu") {
  // Two ages of four lags each, far apart: whatever mu, F can be anything.
  LogCurves few = curves_of(4, 20, power(0.6));
  std::vector<Eigen::Index> rows;
  LogCurves kept;
  kept.first = {0};
  for (std::size_t k = 0; k < 2; ++k) {
    kept.waiting_times.push_back(k);
    for (std::size_t i = few.first[k]; i < few.first[k] + 4; ++i) {
      kept.lag_indices.push_back(few.lag_indices[i]);
      kept.lags.push_back(few.lags[i]);
      rows.push_back(static_cast<Eigen::Index>(i));
    }
    kept.first.push_back(rows.size());
  }
  kept.ln_a = few.ln_a(rows);
  kept.influences = few.influences(rows, Eigen::seqN(0, few.influences.cols()));
  const AgeingExponent found = ageing_exponent(kept, {1, 1'000'000'000}, "a");
  CAPTURE(found.verdict, found.mu, found.low_95, found.high_95);
  CHECK_FALSE((std::isfinite(found.low_95) && std::isfinite(found.high_95)));
  CHECK(found.verdict == "mu has no estimate; cannot decide: the curves do not constrain mu");
}

}  // namespace jostle
