#include "ensemble/analysis/ageing/ageing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "ensemble/statistics/jackknife.hpp"
#include "tests/ensemble/noise.hpp"

namespace jostle {
namespace {

struct Ensemble {
  std::uint64_t n_taps;
  std::uint32_t realizations;
  std::vector<double> series;  // [n_taps, n_realizations]

  double value_at(std::uint64_t tap, std::uint32_t r) const {
    return series[tap * realizations + r];
  }
};

// One value a tap: step(x before, tap, random).
template <class Start, class Step>
Ensemble walk(std::uint64_t seed, std::uint64_t n_taps, std::uint32_t realizations, Start start,
              Step step) {
  RandomStream random = test_stream(seed);
  Ensemble ensemble{n_taps, realizations, std::vector<double>(n_taps * realizations)};
  for (std::uint32_t r = 0; r < realizations; ++r) {
    double x = start(random);
    for (std::uint64_t t = 0; t < n_taps; ++t) {
      if (t > 0) x = step(x, t, random);
      ensemble.series[t * realizations + r] = x;
    }
  }
  return ensemble;
}

AgeingCurves curves_of(const Ensemble& ensemble, const AgeingGrid& grid) {
  return ageing_curves(choose_taps(ensemble.series, ensemble.realizations, taps_of(grid)), grid);
}

// For independent increments of variance 1: A = 2 D t with D = 1/2.
Ensemble random_walk(std::uint64_t seed, std::uint64_t n_taps, std::uint32_t realizations) {
  return walk(
      seed, n_taps, realizations, [](RandomStream&) { return 0.0; },
      [](double x, std::uint64_t, RandomStream& random) { return x + noise(random); });
}

constexpr double memory = 0.9;

// In its steady state, of variance 1, from the start.
Ensemble autoregression(std::uint64_t seed, std::uint64_t n_taps, std::uint32_t realizations) {
  return walk(
      seed, n_taps, realizations, [](RandomStream& random) { return noise(random); },
      [](double x, std::uint64_t, RandomStream& random) {
        return memory * x + std::sqrt(1 - memory * memory) * noise(random);
      });
}

double drift_at(std::uint64_t tap) {
  return 0.5 * std::log1p(static_cast<double>(tap) / 2);
}

constexpr double fluctuation = 0.1;

Ensemble logarithmic_drift(std::uint64_t seed, std::uint64_t n_taps, std::uint32_t realizations) {
  return walk(
      seed, n_taps, realizations, [](RandomStream& random) { return fluctuation * noise(random); },
      [](double, std::uint64_t tap, RandomStream& random) {
        return drift_at(tap) + fluctuation * noise(random);
      });
}

const AgeingGrid grid = {.waiting_times = {0, 10, 100}, .lags = {1, 10, 100}};

// Checks of a reference known exactly: within 3 standard errors of the estimate.
void check(double found, double error, double exact) {
  CAPTURE(found, error, exact);
  CHECK(std::abs(found - exact) <= 3 * error);
}

}  // namespace

TEST_CASE("Two-time functions agree with sums written out") {
  Ensemble ensemble = autoregression(1, 40, 7);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (std::uint64_t t = 0; t < 40; ++t) ensemble.series[t * 7 + 3] = none;   // failed
  for (std::uint64_t t = 20; t < 40; ++t) ensemble.series[t * 7 + 5] = none;  // not that far
  const AgeingGrid all = {.waiting_times = {0, 3, 15, 19}, .lags = {1, 2, 7, 20, 30}};
  const AgeingCurves curves = curves_of(ensemble, all);
  for (std::size_t k = 0; k < all.waiting_times.size(); ++k) {
    for (std::size_t j = 0; j < all.lags.size(); ++j) {
      const std::uint64_t wait = all.waiting_times[k], late = wait + all.lags[j];
      double n = 0, a = 0, x = 0, y = 0, xx = 0, xy = 0, d = 0;
      for (std::uint32_t r = 0; r < 7 && late < 40; ++r) {
        const double previous = ensemble.value_at(wait, r), following = ensemble.value_at(late, r);
        if (std::isnan(previous) || std::isnan(following)) continue;
        n += 1;
        a += (following - previous) * (following - previous);
        x += previous;
        y += following;
        xx += previous * previous;
        xy += previous * following;
        d += following - previous;
      }
      const std::size_t i = curves.index_of(k, j);
      CAPTURE(wait, all.lags[j]);
      CHECK(static_cast<double>(curves.count[i]) == n);
      if (n == 0) {
        CHECK(std::isnan(curves.a[i].value));
        CHECK(std::isnan(curves.c[i]));
        continue;
      }
      CHECK(curves.a[i].value == Approx(a / n).epsilon(1e-13));
      CHECK(curves.change[i] == Approx(d / n).epsilon(1e-12));
      CHECK(curves.v[i].value == Approx((a - d * d / n) / (n - 1)).epsilon(1e-12));
      CHECK(curves.c[i] == Approx((xy - x * y / n) / (xx - x * x / n)).epsilon(1e-11));
    }
  }
}

TEST_CASE("Errors of two-time functions are those of leaving realizations out one by one") {
  const Ensemble ensemble = autoregression(2, 30, 9);
  const AgeingGrid grid = {.waiting_times = {5}, .lags = {4}};
  const AgeingCurves curves = curves_of(ensemble, grid);
  std::vector<double> a, v, c;
  for (std::uint32_t left_out = 0; left_out < 9; ++left_out) {
    Ensemble rest = ensemble;
    for (std::uint64_t t = 0; t < 30; ++t) rest.series[t * 9 + left_out] = std::nan("");
    const AgeingCurves rest_curves = curves_of(rest, grid);
    a.push_back(rest_curves.a[0].value);
    v.push_back(std::log(rest_curves.v[0].value));
    c.push_back(rest_curves.c[0]);
  }
  const auto error = [](const std::vector<double>& values) {
    double mean = 0, sum = 0;
    for (const double value : values) mean += value / 9;
    for (const double value : values) sum += (value - mean) * (value - mean);
    return std::sqrt(8.0 / 9 * sum);
  };
  for (double& value : a) value = std::log(value);
  const LogEstimate& found = curves.a[0];
  CHECK(found.error == Approx(found.value * error(a)).epsilon(1e-12));
  CHECK(curves.v[0].error == Approx(curves.v[0].value * error(v)).epsilon(1e-12));
  CHECK(curves.c_error[0] == Approx(error(c)).epsilon(1e-12));
  // Student's t of 8 degrees of freedom.
  CHECK(std::log(found.high_68 / found.value) == Approx(1.0665 * error(a)).epsilon(1e-4));
  CHECK(std::log(found.value / found.low_68) == Approx(1.0665 * error(a)).epsilon(1e-4));
  CHECK(std::log(found.high_95 / found.value) == Approx(2.3060 * error(a)).epsilon(1e-4));
}

TEST_CASE("A random walk spreads alike at every age", "[statistics]") {
  const AgeingCurves curves = curves_of(random_walk(3, 201, 1000), grid);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i = curves.index_of(k, j);
      check(curves.a[i].value, curves.a[i].error, static_cast<double>(grid.lags[j]));
      if (k == 0) {
        CHECK(std::isnan(curves.c[i]));  // all start at 0
      } else {
        check(curves.c[i], curves.c_error[i], 1);
      }
    }
  }
}

TEST_CASE("A stationary autoregression does not age", "[statistics]") {
  const AgeingCurves curves = curves_of(autoregression(4, 201, 1000), grid);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i = curves.index_of(k, j);
      const double c = std::pow(memory, static_cast<double>(grid.lags[j]));
      check(curves.a[i].value, curves.a[i].error, 2 * (1 - c));
      check(curves.c[i], curves.c_error[i], c);
    }
  }
}

TEST_CASE("A logarithmic drift ages", "[statistics]") {
  const AgeingCurves curves = curves_of(logarithmic_drift(5, 201, 1000), grid);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i = curves.index_of(k, j);
      const std::uint64_t wait = grid.waiting_times[k];
      const double drift = drift_at(wait + grid.lags[j]) - drift_at(wait);
      check(curves.a[i].value, curves.a[i].error, drift * drift + 2 * fluctuation * fluctuation);
      check(curves.c[i], curves.c_error[i], 0);
      if (k > 0 && j > 0) {
        const std::size_t younger = curves.index_of(k - 1, j);
        CHECK(curves.a[younger].value - curves.a[i].value >
              3 * std::hypot(curves.a[younger].error, curves.a[i].error));
      }
    }
  }
}

TEST_CASE("Intervals of A hold the truth at their stated rate", "[statistics]") {
  // A is a mean of squares, which are skewed: A +- t error, beside it, does not.
  constexpr int ensembles = 1000;
  const AgeingGrid grid = {.waiting_times = {5}, .lags = {10}};
  std::string table =
      "\nprocess          M   68 %   95 %   of A +- t error: 68 %   95 %   (share that holds the "
      "truth)\n";
  for (const std::uint32_t m : {2u, 3u, 4u, 10u, 20u}) {
    for (const bool steady : {false, true}) {
      const double exact = steady ? 2 * (1 - std::pow(memory, 10)) : 10;
      int held[2] = {}, plain[2] = {};
      for (int e = 0; e < ensembles; ++e) {
        const std::uint64_t seed = 100'000 * m + static_cast<std::uint64_t>(e);
        const Ensemble ensemble = steady ? autoregression(seed, 16, m) : random_walk(seed, 16, m);
        const LogEstimate a = curves_of(ensemble, grid).a[0];
        held[0] += a.low_68 <= exact && exact <= a.high_68;
        held[1] += a.low_95 <= exact && exact <= a.high_95;
        double squares = 0;
        for (std::uint32_t r = 0; r < m; ++r) {
          const double change = ensemble.value_at(15, r) - ensemble.value_at(5, r);
          squares += std::pow(change * change - a.value, 2);
        }
        const double error = std::sqrt(squares / (m * (m - 1)));
        for (int level = 0; level < 2; ++level) {
          plain[level] +=
              std::abs(a.value - exact) <= student_half_width(error, m, interval_levels[level]);
        }
      }
      const auto percent = [](int count) { return 100.0 * count / ensembles; };
      table += fmt::format("{:14} {:4} {:6.1f} {:6.1f} {:23.1f} {:6.1f}\n",
                           steady ? "autoregression" : "random walk", m, percent(held[0]),
                           percent(held[1]), percent(plain[0]), percent(plain[1]));
      CAPTURE(m, steady);
      CHECK(percent(held[0]) >= 60);
      CHECK(percent(held[0]) <= 80);
      CHECK(percent(held[1]) >= 90);
      CHECK(percent(held[1]) <= 100);
    }
  }
  fmt::print("{}", table);
}

TEST_CASE("Intervals of V hold the truth at their stated rate", "[statistics]") {
  constexpr int ensembles = 1000;
  const AgeingGrid grid = {.waiting_times = {5}, .lags = {10}};
  std::string table = "\nprocess               M   68 %   95 %   (share that holds the truth)\n";
  for (const std::uint32_t m : {4u, 10u, 20u}) {
    for (const bool steady : {false, true}) {
      const double exact = steady ? 2 * (1 - std::pow(memory, 10)) : 10;
      int held_68 = 0, held_95 = 0;
      for (int e = 0; e < ensembles; ++e) {
        const std::uint64_t seed = 900'000 * m + static_cast<std::uint64_t>(e);
        Ensemble ensemble = steady ? autoregression(seed, 16, m) : random_walk(seed, 16, m);
        for (std::uint32_t r = 0; r < m; ++r) ensemble.series[15 * m + r] += 7;  // all alike
        const LogEstimate v = curves_of(ensemble, grid).v[0];
        held_68 += v.low_68 <= exact && exact <= v.high_68;
        held_95 += v.low_95 <= exact && exact <= v.high_95;
      }
      const auto percent = [](int count) { return 100.0 * count / ensembles; };
      table +=
          fmt::format("{:14} {:8} {:6.1f} {:6.1f}\n", steady ? "autoregression" : "random walk", m,
                      percent(held_68), percent(held_95));
      CAPTURE(m, steady);
      CHECK(percent(held_68) >= 60);
      CHECK(percent(held_68) <= 80);
      CHECK(percent(held_95) >= 90);
    }
  }
  fmt::print("{}", table);
  const LogEstimate three = curves_of(random_walk(1, 16, 3), grid).v[0];
  CHECK(three.value > 0);
  CHECK(std::isnan(three.error));
}

TEST_CASE("The default grid fits into its series and needs each tap once") {
  for (const std::uint64_t n_taps : {3, 4, 50, 4001, 100001}) {
    const AgeingGrid chosen = ageing_grid(n_taps);
    CHECK(chosen.waiting_times.front() == 0);
    CHECK(chosen.waiting_times.back() <= std::max<std::uint64_t>(1, (n_taps - 1) / 10));
    CHECK(chosen.lags.front() == 1);
    CHECK(chosen.lags.back() == n_taps - 1);
    const std::vector<std::uint64_t> taps = taps_of(chosen);
    CHECK(std::ranges::is_sorted(taps, std::ranges::less_equal{}));
  }
}

}  // namespace jostle
