#include "ensemble/analysis/ageing/fits.hpp"

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "engine/numbers.hpp"
#include "ensemble/analysis/ageing/ageing_table.hpp"
#include "ensemble/analysis/ageing/law.hpp"
#include "tests/ensemble/analysis/ageing/ageing_paths.hpp"

namespace jostle {
namespace {

using ageing_paths::grid;
using ageing_paths::Paths;

constexpr double b = 2;
constexpr double a_inf[] = {1, 3, 2};
constexpr double tau[] = {20, 100, 500};

// Rows whose A follows eq. 6 at every waiting time, with changes independent at every lag.
TapRows eq_6_rows(std::uint64_t seed, std::uint32_t realizations, double common_b = b) {
  RandomStream random = test_stream(seed);
  TapRows rows{.taps = taps_of(grid), .realizations = realizations, .values = {}};
  for (const std::uint64_t tap : rows.taps) {
    const std::uint64_t k = tap / 1000000, lag = tap % 1000000;
    const double p[] = {a_inf[k] * b / common_b, common_b, tau[k]};
    const double spread = std::sqrt(Ageing().value(static_cast<double>(lag), p));
    for (std::uint32_t r = 0; r < realizations; ++r) {
      rows.values.push_back(10 + spread * noise(random));
    }
  }
  return rows;
}

std::vector<std::uint32_t> all_of(std::uint32_t n) {
  std::vector<std::uint32_t> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0u);
  return numbers;
}

// All numbers of a table, as bits: NaN are equal to themselves.
std::vector<std::uint64_t> numbers(const Table& table) {
  std::vector<std::uint64_t> bits;
  for (const Quantity& quantity : table.quantities) {
    if (const auto* values = std::get_if<std::vector<double>>(&quantity.values)) {
      for (const double value : *values) bits.push_back(std::bit_cast<std::uint64_t>(value));
    }
  }
  return bits;
}

const Column height = {"mean_height", "diameter", "mean height", ""};

double scalar(const Table& table, const std::string& name) {
  for (const Quantity& quantity : table.quantities) {
    if (quantity.name == name) return std::get<std::vector<double>>(quantity.values).at(0);
  }
  FAIL("no quantity " << name);
  return 0;
}

// ln of what was found, by its own error.
void check(const LogEstimate& found, double exact) {
  CAPTURE(found.value, found.error, exact);
  CHECK(std::abs(std::log(found.value / exact)) <= 3 * found.error / found.value);
}

std::string note(const Table& table, const std::string& name) {
  for (const auto& [key, text] : table.notes) {
    if (key == name) return text;
  }
  FAIL("no note " << name);
  return "";
}

}  // namespace

TEST_CASE("Fits of eq. 6 find the laws that made the curves, apart and with one B",
          "[statistics]") {
  const AgeingFits fits = fit_ageing(eq_6_rows(1, 400), grid);
  CHECK(fits.realizations == 400);
  for (std::size_t k = 0; k < 3; ++k) {
    for (const AgeingLaw& law : {fits.own[k], fits.shared[k]}) {
      CAPTURE(k, law.verdict);
      check(law.a_inf, a_inf[k]);
      check(law.b, b);
      check(law.tau, tau[k]);
      CHECK(law.misfit < 0.14);  // errors of a point are sqrt(2/400) of it
    }
    CHECK(fits.shared[k].is_determined());
    CHECK(fits.shared[k].b.value == fits.shared[0].b.value);
    CHECK(fits.shared[k].tau.error / fits.shared[k].tau.value <
          fits.own[k].tau.error / fits.own[k].tau.value);
  }
}

TEST_CASE(
    "Curves that eq. 6 cannot follow set no limits to it, and neither hold nor refute a collapse",
    "[statistics]") {
  // Faster than in proportion to the lag: A = v^2 lag^p, v of a realization and a waiting time;
  // with noise at every lag the best point is anywhere on a flat ridge, not at its end.
  struct Rise {
    std::uint32_t realizations;
    double power, spread;
  };
  for (const auto& [realizations, power, spread] :
       {Rise{3, 1.3, 0}, Rise{10, 1.3, 0}, Rise{40, 1.3, 0}, Rise{16, 1.15, 0.1},
        Rise{40, 1.1, 0.1}}) {
    RandomStream random = test_stream(realizations);
    std::vector<double> speeds;
    for (std::uint32_t i = 0; i < 3 * realizations; ++i) speeds.push_back(1 + 0.3 * noise(random));
    TapRows rows{.taps = taps_of(grid), .realizations = realizations, .values = {}};
    for (const std::uint64_t tap : rows.taps) {
      const std::uint64_t k = tap / 1000000, lag = tap % 1000000;
      for (std::uint32_t r = 0; r < realizations; ++r) {
        const double way = std::pow(static_cast<double>(lag), power / 2);
        rows.values.push_back(10 +
                              speeds[k * realizations + r] * way * (1 + spread * noise(random)));
      }
    }
    const AgeingFits fits = fit_ageing(rows, grid);
    CAPTURE(realizations, power, fits.collapse.verdict);
    CHECK(fits.collapse.verdict == "cannot decide: eq. 6 does not describe these curves");
    for (std::size_t k = 0; k < 3; ++k) {
      for (const AgeingLaw& law : {fits.own[k], fits.shared[k]}) {
        CAPTURE(k, law.verdict);
        CHECK(law.verdict.find("does not describe") != std::string::npos);
        for (const LogEstimate& estimate : {law.a_inf, law.b}) {
          CHECK(estimate.low_95 == 0);
          CHECK(std::isinf(estimate.high_95));
        }
        CHECK_FALSE(law.is_determined());
      }
    }
  }
}

TEST_CASE("No limit of eq. 6 is an end of its search, where curves rise as eq. 6 at its corner") {
  // In proportion to the lag or faster: tau grows and B falls without an end.
  const AgeingGrid short_lags{.waiting_times = grid.waiting_times,
                              .lags = logarithmic_taps(1, 48, 10)};
  constexpr std::uint32_t realizations = 6;
  const double longest_tau = 1e4 * 48, least_b = 1e-3;
  RandomStream random = test_stream(31);
  int at_corner = 0, rejected = 0;
  for (int ensemble = 0; ensemble < 60; ++ensemble) {
    const double power = ensemble % 2 == 0 ? 1 : 1.3;
    TapRows rows{.taps = taps_of(short_lags), .realizations = realizations, .values = {}};
    std::vector<double> speeds;
    for (std::uint32_t i = 0; i < 3 * realizations; ++i) speeds.push_back(1 + 0.3 * noise(random));
    for (const std::uint64_t tap : rows.taps) {
      const std::uint64_t k = tap / 1000000, lag = tap % 1000000;
      const double way = std::pow(static_cast<double>(lag), power / 2);
      for (std::uint32_t r = 0; r < realizations; ++r)
        rows.values.push_back(10 + speeds[k * realizations + r] * way * (1 + 0.3 * noise(random)));
    }
    for (const AgeingLaw& law : fit_ageing(rows, short_lags).own) {
      CAPTURE(ensemble, law.verdict, law.tau.high_95, law.b.low_95);
      for (const double end : {law.tau.high_68, law.tau.high_95})
        CHECK((std::isinf(end) || end < 0.99 * longest_tau));
      for (const double end : {law.b.low_68, law.b.low_95})
        CHECK((end == 0 || end > 1.01 * least_b));
      at_corner += !std::isfinite(law.tau.high_95) && law.b.low_95 == 0;
      if (power > 1) rejected += law.verdict.find("does not describe") != std::string::npos;
    }
  }
  CHECK(at_corner > 60);
  CHECK(rejected >= 81);  // nine in ten curves that eq. 6 cannot follow
}

// Sum of squares of ln A about eq. 6 with the best A_inf.
double squares_at(const LogCurves& curve, double ln_b, double ln_tau) {
  Eigen::VectorXd residual = curve.ln_a;
  for (std::size_t i = 0; i < curve.lags.size(); ++i) {
    residual[static_cast<Eigen::Index>(i)] -= ln_eq_6(curve.lags[i], ln_b, ln_tau);
  }
  return (residual.array() - residual.mean()).square().sum();
}

TEST_CASE("Estimates of eq. 6 are the least squares of the search, strictly inside their intervals",
          "[statistics]") {
  // The valley of short curves runs to the largest B.
  const AgeingGrid short_grid = {.waiting_times = {0}, .lags = {1, 2, 3, 4, 6, 8, 12, 20, 32, 50}};
  int at_largest_b = 0;
  for (std::uint32_t e = 0; e < 60; ++e) {
    RandomStream random = test_stream(700 + e);
    TapRows rows{.taps = taps_of(short_grid), .realizations = 6, .values = {}};
    const double p[] = {0.1, e % 2 == 0 ? 0.5 : 30.0, e % 2 == 0 ? 4.0 : 300.0};
    std::vector<double> own(6, 0);
    double previous = 0;
    for (const std::uint64_t tap : rows.taps) {
      const double now = tap == 0 ? 0 : Ageing().value(static_cast<double>(tap), p);
      for (double& x : own) rows.values.push_back(x += std::sqrt(now - previous) * noise(random));
      previous = now;
    }
    const LogCurves curve = log_curves(rows, short_grid, all_of(6));
    const AgeingLeastSquares fit(curve);
    double least = infinite;
    for (double ln_b = -6.9; ln_b <= 6.9; ln_b += 0.3) {
      for (double ln_tau = std::log(0.01); ln_tau <= std::log(5e5); ln_tau += 0.05) {
        least = std::min(least, squares_at(curve, ln_b, ln_tau));
      }
    }
    CAPTURE(e, fit.best()[0], fit.best()[1], fit.best()[2]);
    CHECK(fit.residuals(fit.best()).squaredNorm() <= least * (1 + 1e-9));
    at_largest_b += fit.best()[2] > 6.9;
    const LogEstimate a = fit.estimate(AgeingLeastSquares::a_inf(0));
    const double place = (1 - 1e-9) * a.value;
    CHECK(a.low_95 <= a.low_68);
    CHECK(a.low_68 < place);
    CHECK(place * (1 + 2e-9) < a.high_68);
    CHECK(a.high_68 <= a.high_95);
  }
  CHECK(at_largest_b >= 10);
}

TEST_CASE("Scaled curves of one B collapse, unscaled ones do not", "[statistics]") {
  const Table table = ageing_table("ageing", height, eq_6_rows(2, 100), grid);
  CHECK(scalar(table, "collapse_relative") < 0.3);
  CHECK(scalar(table, "unscaled_collapse_relative") > 0.5);
  CHECK(scalar(table, "collapse_p") >= 0.005);
  CHECK(scalar(table, "ageing_p") < 0.05);
  CHECK(scalar(table, "ageing_factor_high_95") < 1);
  CHECK(note(table, "ageing_verdict").starts_with("A changes with age"));
  CHECK(note(table, "collapse_verdict").find("p = ") != std::string::npos);
}

TEST_CASE("Errors of scaled curves include those of their scales", "[statistics]") {
  const TapRows rows = eq_6_rows(8, 100);
  const AgeingFits fits = fit_ageing(rows, grid);
  const AgeingCurves curves = ageing_curves(rows, grid);
  for (std::size_t k = 0; k < 3; ++k) {
    // At one lag its own error and those of the scales, a slope of 1 at most, add up or cancel.
    const auto relative = [](const LogEstimate& x) { return x.error / x.value; };
    const std::size_t i = curves.index_of(k, 20);
    const double point = relative(curves.a[i]);
    const double scales = relative(fits.shared[k].a_inf) + relative(fits.shared[k].tau);
    CAPTURE(k, scales, point, fits.scaled_error[i]);
    CHECK(fits.scaled_error[i] > 0.5 * point);
    CHECK(fits.scaled_error[i] != Approx(point).epsilon(1e-3));
    CHECK(fits.scaled_error[i] < point + scales);
  }
}

TEST_CASE("Where B has no limit it is held, and curves keep their scales", "[statistics]") {
  const TapRows rows = eq_6_rows(7, 100, 1e-9);
  const AgeingFits fits = fit_ageing(rows, grid);
  for (std::size_t k = 0; k < 3; ++k) {
    const AgeingLaw& law = fits.shared[k];
    CAPTURE(k, law.verdict);
    CHECK(law.verdict.starts_with("B has only an upper limit: B < "));
    CHECK(law.verdict.find("it is held at ") != std::string::npos);
    CHECK(law.verdict.ends_with("only ratios between waiting times mean something"));
    CHECK(law.b_is_held);
    CHECK(law.b.low_95 == 0);
    REQUIRE(law.is_determined());
    // B is small, so that eq. 6 is the logarithm A_inf B ln(1 + t/tau).
    CHECK(law.b.value < 0.1);
    check(law.tau, tau[k]);
  }
  // Its value is not stored, nor errors of the scales.
  const Table table = ageing_table("ageing", height, rows, grid);
  CHECK(std::isnan(scalar(table, "shared_b")));
  CHECK(std::isnan(scalar(table, "shared_tau_low_95")));
  CHECK(scalar(table, "shared_tau") == fits.shared[0].tau.value);
  CHECK(std::isfinite(scalar(table, "scaled_a_error")));
}

TEST_CASE("Where B is at the end of its range, scales and times are fitted to it") {
  // A power above 1 of the logarithm over all lags: eq. 6 comes closest with the least B.
  TapRows rows{.taps = taps_of(grid), .realizations = 4, .values = {}};
  for (const std::uint64_t tap : rows.taps) {
    const std::uint64_t k = tap / 1000000, lag = tap % 1000000;
    const double spread = std::pow(std::log1p(static_cast<double>(lag) / (0.01 * tau[k])), 0.55);
    for (const int sign : {-1, 1, -1, 1}) rows.values.push_back(10 + sign * spread);
  }
  const AgeingLeastSquares fit(log_curves(rows, grid, all_of(4)));
  const Eigen::VectorXd best = fit.best();
  const auto b_place = static_cast<Eigen::Index>(fit.b());
  REQUIRE(std::exp(best[b_place]) == Approx(0.001).epsilon(1e-9));
  const double least = fit.residuals(best).squaredNorm();
  for (Eigen::Index i = 0; i < b_place; ++i) {
    for (const double change : {-0.01, 0.01}) {
      CAPTURE(i, change);
      Eigen::VectorXd moved = best;
      moved[i] += change;
      CHECK(fit.residuals(moved).squaredNorm() > least);
    }
  }
}

TEST_CASE(
    "Curves that nothing bounds have no shared law, and nothing is scaled by a fit that diverged") {
  // Changes whose spread grows with the lag itself: A goes with its square, and never bends.
  RandomStream random = test_stream(6);
  TapRows rows{.taps = taps_of(grid), .realizations = 20, .values = {}};
  for (const std::uint64_t tap : rows.taps) {
    const auto lag = static_cast<double>(tap % 1000000);
    for (std::uint32_t r = 0; r < rows.realizations; ++r) {
      rows.values.push_back(10 + lag * noise(random));
    }
  }
  const AgeingFits fits = fit_ageing(rows, grid);
  for (std::size_t k = 0; k < 3; ++k) {
    CAPTURE(k, fits.own[k].verdict, fits.shared[k].verdict);
    CHECK(fits.own[k].verdict == "eq. 6 does not describe this curve");
    CHECK(!fits.own[k].is_determined());
    CHECK(fits.shared[k].verdict ==
          "eq. 6 with one B does not describe these curves together: no shared law, nothing to "
          "scale by");
  }
  const Table table = ageing_table("ageing", height, rows, grid);
  CHECK(std::isnan(scalar(table, "collapse_relative")));
  CHECK(std::isfinite(scalar(table, "unscaled_collapse_relative")));
  for (const Quantity& quantity : table.quantities) {
    const auto* values = std::get_if<std::vector<double>>(&quantity.values);
    if (values == nullptr) continue;
    CAPTURE(quantity.name);
    const bool of_shared =
        (quantity.name.starts_with("scaled_") && quantity.name != "scaled_a_dof") ||
        (quantity.name.starts_with("shared_") && quantity.name != "shared_misfit");
    for (const double value : *values) {
      CHECK(!std::isinf(value));  // no overflow and no open end is stored
      if (of_shared) CHECK(std::isnan(value));
    }
  }
}

TEST_CASE("Ageing tables do not depend on the number of threads") {
  const TapRows rows = eq_6_rows(3, 12);
  const auto single = numbers(ageing_table("ageing", height, rows, grid, 1));
  CHECK(single == numbers(ageing_table("ageing", height, rows, grid, 2)));
}

TEST_CASE("Too few realizations for a fit are named, with what to do") {
  TapRows rows = eq_6_rows(4, 4);
  for (std::uint32_t r = 0; r < 2; ++r) rows.values[rows.values.size() - 1 - r] = std::nan("");
  const AgeingFits fits = fit_ageing(rows, grid);
  CHECK(fits.realizations == 2);
  CHECK(std::isnan(fits.own[0].tau.value));
  CHECK(
      fits.shared[2].verdict ==
      "laws and tests of ageing need 3 realizations that reached every tap asked for, 2 of 4 did: "
      "run more realizations, or ask for earlier taps");
  CHECK(fits.collapse.verdict.starts_with("cannot decide: laws and tests of ageing need 3"));
  // Earlier taps do not help where all reached every tap.
  const AgeingFits two = fit_ageing(eq_6_rows(4, 2), grid);
  CHECK(two.ageing.verdict ==
        "cannot decide: laws and tests of ageing need 3 realizations that reached every tap asked "
        "for, there are 2: run more realizations");
}

TEST_CASE("Waiting times without a law have a reason") {
  const AgeingGrid few{.waiting_times = grid.waiting_times, .lags = {grid.lags[0], grid.lags[1]}};
  const TapRows rows = eq_6_rows(4, 4);
  const std::string lags =
      "2 lags with a change, 4 needed for a law of three parameters: ask for more lags, or tap "
      "longer";
  const AgeingFits fits = fit_ageing(rows, few);
  CHECK(fits.own[0].verdict == lags);
  CHECK(fits.shared[1].verdict == lags);
  CHECK(fits.ageing.verdict == "cannot decide: " + lags);
  AgeingGrid late = grid;
  late.waiting_times.back() = rows.taps.back();
  CHECK(fit_ageing(rows, late).own.back().verdict == "the series ends before");
  TapRows still = rows;
  for (double& value : still.values) value = 1;
  CHECK(fit_ageing(still, grid).own[0].verdict == "nothing changes after this waiting time");
}

TEST_CASE("A table of ageing has values for all places of its axes") {
  const Table table = ageing_table("point_0000/ageing/mean_height", height, eq_6_rows(5, 5), grid);
  const auto length = [](const Quantity& quantity) {
    return std::visit([](const auto& values) { return values.size(); }, quantity.values);
  };
  for (const Quantity& quantity : table.quantities) {
    std::size_t places = 1;
    for (const std::string& axis : quantity.axes) {
      for (const Quantity& known : table.axes) places *= known.name == axis ? length(known) : 1;
    }
    CAPTURE(quantity.name);
    CHECK(length(quantity) == places);
    CHECK(!quantity.units.empty());
    CHECK(!quantity.long_name.empty());
  }
}

}  // namespace jostle
