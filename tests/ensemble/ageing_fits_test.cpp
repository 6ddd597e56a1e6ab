#include "ensemble/ageing_fits.hpp"

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>

#include "ensemble/ageing_table.hpp"
#include "fitting/models.hpp"
#include "noise.hpp"

namespace jostle {
namespace {

// Laws that the lags determine: they begin well below tau and end close to A_inf. (At B = 0.5 the
// three can make up for each other, and standard errors of the own fits mean little.)
constexpr double b = 2;
constexpr double a_inf[] = {1, 3, 2};
constexpr double tau[] = {20, 100, 500};

const AgeingGrid grid = {.waiting_times = {0, 1000000, 2000000},
                         .lags = logarithmic_taps(1, 100000, 8)};

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

const ObservableLabel height = {"mean_height", "diameter", "mean height", ""};

double scalar(const Table& table, const std::string& name) {
  for (const Quantity& quantity : table.quantities) {
    if (quantity.name == name) return std::get<std::vector<double>>(quantity.values).at(0);
  }
  FAIL("no quantity " << name);
  return 0;
}

void check(double found, double error, double exact) {
  CAPTURE(found, error, exact);
  CHECK(std::abs(found - exact) <= 3 * error);
}

}  // namespace

TEST_CASE("Fits of eq. 6 find the laws that made the curves, apart and with one B",
          "[statistics]") {
  const AgeingFits fits = fit_ageing(eq_6_rows(1, 400), grid);
  CHECK(fits.realizations == 400);
  for (std::size_t k = 0; k < 3; ++k) {
    for (const AgeingLaw& law : {fits.own[k], fits.shared[k]}) {
      CAPTURE(k, law.verdict);
      check(law.a_inf, law.a_inf_error, a_inf[k]);
      check(law.b, law.b_error, b);
      check(law.tau, law.tau_error, tau[k]);
      CHECK(law.misfit < 0.14);  // errors of a point are sqrt(2/400) of it
    }
    CHECK(fits.shared[k].b == fits.shared[0].b);
    CHECK(fits.shared[k].tau_error < fits.own[k].tau_error);
  }
}

TEST_CASE("Scaled curves of one B collapse, unscaled ones do not", "[statistics]") {
  const TapRows rows = eq_6_rows(2, 100);
  const Table table = ageing_table("ageing", height, rows, grid);
  CHECK(scalar(table, "collapse") < 1.5);
  CHECK(scalar(table, "unscaled_collapse") > 3);
  CHECK(scalar(table, "collapse_relative") < 0.3);
}

TEST_CASE("Where B may be 0 curves are scaled by the logarithm", "[statistics]") {
  const TapRows rows = eq_6_rows(7, 100, 1e-9);
  const AgeingFits fits = fit_ageing(rows, grid);
  for (std::size_t k = 0; k < 3; ++k) {
    CAPTURE(k, fits.shared[k].verdict);
    const AgeingLaw& law = fits.shared[k];
    CHECK(law.verdict.find("B may be 0") == 0);
    check(law.a_inf * law.b, law.a_inf_error * law.b, a_inf[k] * b);
    check(law.tau, law.tau_error, tau[k]);
  }
  CHECK(scalar(ageing_table("ageing", height, rows, grid), "collapse") < 1.5);
}

TEST_CASE("Curves that nothing bounds have no shared law, and nothing is scaled by a runaway") {
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
    CHECK(fits.own[k].verdict.find("not identifiable") != std::string::npos);
    CHECK(std::isnan(fits.own[k].a_inf_error));
    CHECK(fits.shared[k].verdict.find("not identifiable") != std::string::npos);
    CHECK(fits.shared[k].verdict.find("nothing to scale by") != std::string::npos);
    for (const double number : {fits.shared[k].a_inf, fits.shared[k].a_inf_error, fits.shared[k].b,
                                fits.shared[k].tau, fits.shared[k].tau_error}) {
      CHECK(std::isnan(number));
    }
  }
  const Table table = ageing_table("ageing", height, rows, grid);
  CHECK(std::isnan(scalar(table, "collapse")));
  CHECK(std::isfinite(scalar(table, "unscaled_collapse")));
  for (const Quantity& quantity : table.quantities) {
    if (quantity.name != "scaled_lag" && quantity.name != "scaled_a") continue;
    const auto& values = std::get<std::vector<double>>(quantity.values);
    CHECK(std::ranges::all_of(values, [](double value) { return std::isnan(value); }));
  }
}

TEST_CASE("Ageing tables do not depend on the number of threads") {
  const TapRows rows = eq_6_rows(3, 12);
  const auto one = numbers(ageing_table("ageing", height, rows, grid, 1));
  CHECK(one == numbers(ageing_table("ageing", height, rows, grid, 2)));
}

TEST_CASE("Too few realizations for a fit are named, with what to do") {
  TapRows rows = eq_6_rows(4, 4);
  for (std::uint32_t r = 0; r < 2; ++r) rows.values[rows.values.size() - 1 - r] = std::nan("");
  const AgeingFits fits = fit_ageing(rows, grid);
  CHECK(fits.realizations == 2);
  CHECK(std::isnan(fits.own[0].tau));
  CHECK(fits.shared[2].verdict ==
        "2 realizations reached every tap asked for: fits need 3, so run more of them, or ask for "
        "earlier taps");
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
