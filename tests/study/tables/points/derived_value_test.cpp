#include "study/tables/points/derived_value.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "ensemble/analysis/analyses.hpp"
#include "ensemble/analysis/sweeps/sweep_curve.hpp"
#include "fitting/intervals/distributions.hpp"
#include "study/bad_input.hpp"
#include "study/tables/fits.hpp"
#include "tests/fitting/noise.hpp"

using namespace jostle;

namespace {

/// A compaction curve of 400 taps, the mean of realizations that scatter by white noise and by a
/// level each, which end at `final`.
Curve compaction(double final, std::size_t realizations, Noise& noise) {
  std::vector<double> t, values, levels;
  for (std::size_t r = 0; r < realizations; ++r) levels.push_back(2e-3 * noise());
  for (int tap = 0; tap <= 400; ++tap) {
    t.push_back(tap);
    const double mean = final - 0.04 * std::exp(-std::sqrt(tap / 30.0));
    for (const double level : levels) values.push_back(mean + level + 2e-3 * noise());
  }
  return mean_curve(std::move(t), std::move(values), realizations);
}

ParameterPoint final_value(const Curve& curve) {
  const FittedCurve fitted{
      {.title = "", .observable = "phi", .label = "", .point = 0, .curve = curve},
      fit_models(models_named("kww"), curve, {})};
  const auto point = parameter_point(fit_tables(fitted, {}).at(0), "rho_inf");
  REQUIRE(point);
  if (point->error.known()) {
    const Estimate& estimate = std::get<Fit>(fitted.outcomes[0].result).estimates[0];
    REQUIRE(estimate.parameter.name == "rho_inf");
    CHECK(point->value == estimate.value);
    const double reach =
        point->error.error * student_two_sided(interval_levels[0], point->error.dof);
    CHECK(reach == Approx(std::max(estimate.intervals[0].upper - estimate.value,
                                   estimate.value - estimate.intervals[0].lower)));
  }
  return *point;
}

/// For sweeps over five points whose final values rise by `slope` a point.
void check(std::size_t realizations, double slope, int sweeps) {
  int bent = 0, covered = 0, made = 0, points = 0;
  for (int number = 0; number < sweeps; ++number) {
    Noise noise(1000 * realizations + static_cast<std::uint64_t>(number));
    std::vector<double> x, y;
    std::vector<ErrorOf> errors;
    for (int i = 0; i < 5; ++i) {
      const ParameterPoint point = final_value(compaction(0.6 + slope * i, realizations, noise));
      if (!point.no_value.empty()) continue;
      x.push_back(i);
      y.push_back(point.value);
      errors.push_back(point.error);
    }
    points += static_cast<int>(x.size());
    if (x.size() < 3) continue;
    ++made;
    const StraightLine line = straight_line(SweepCurve(x, y, errors));
    bent += line.p < 0.05;
    const double reach = two_sided(0.95, line.slope_error.dof) * line.slope_error.error;
    covered += std::abs(line.slope - slope) <= reach;
  }
  fmt::print("M = {:>2}, slope {}: {} of {} points; {} lines, {} called bent, {} hold the slope\n",
             realizations, slope, points, 5 * sweeps, made, bent, covered);
  std::fflush(stdout);
  CAPTURE(realizations, slope, made, bent, covered);
  REQUIRE(made > sweeps / 2);
  const auto margin = [&](double rate) { return 3 * std::sqrt(rate * (1 - rate) * made); };
  CHECK(bent <= 0.05 * made + margin(0.05));
  CHECK(covered >= 0.95 * made - margin(0.95));
}

/// The steady state of three first-order autoregressive series, as a file keeps it.
MadeTables steady_state_of(double memory, std::size_t taps) {
  SteadyStateTest test;
  Noise noise(7);
  for (int r = 0; r < 3; ++r) {
    std::vector<double> series = {noise()};
    while (series.size() < taps) series.push_back(memory * series.back() + noise());
    test.add(series);
  }
  AnalysedSeries last;
  last.observable = "z";
  last.units = "1";
  last.last_tap = taps - 1;
  Table table = steady_table(last, test.result());
  table.name = "point_0000/" + table.name;
  return {.fits = {}, .analyses = {table}};
}

}  // namespace

TEST_CASE("A lower bound of a steady state's quantity is no point of a curve") {
  const MadeTables too_short = steady_state_of(0.95, 60), enough = steady_state_of(0, 400);
  for (const std::string name : {"steady/sigma", "steady/autocorrelation_time"}) {
    CAPTURE(name);
    const DerivedValue bound = derived_value(too_short, 0, "z", name);
    CHECK(std::isnan(bound.value));
    CHECK_FALSE(bound.error.known());
    CHECK(bound.no_value.starts_with("lower bound"));
    const DerivedValue measured = derived_value(enough, 0, "z", name);
    CHECK(measured.value == Approx(name == "steady/sigma" ? 1 : 0.5).epsilon(0.3));
    CHECK(measured.error.known());
    CHECK(measured.no_value.empty());
  }
  CHECK(derived_value(too_short, 0, "z", "steady/value").no_value.empty());
}

TEST_CASE("A quantity that is not kept is answered with those that are, and with the nearest") {
  MadeTables tables = steady_state_of(0, 400);
  tables.fits.push_back({.name = "point_0000/z/kww",
                         .axes = {{"parameter",
                                   {"parameter"},
                                   std::vector<std::string>{"rho_inf", "tau_f"},
                                   "",
                                   "",
                                   ""}}});
  const auto refusal = [&](const char* quantity, const char* observable = "z") -> std::string {
    try {
      derived_value(tables, 0, observable, quantity);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  };
  const std::string typo = refusal("steady/sigm");
  CHECK(typo.starts_with("steady/sigm of z is not kept for sweep point 0; it has steady/"));
  CHECK(typo.find("steady/sigma, steady/") != std::string::npos);
  CHECK(typo.find("_error") == std::string::npos);
  CHECK(typo.find("kww") == std::string::npos);
  CHECK(typo.ends_with("Did you mean \"steady/sigma\"?"));
  CHECK(refusal("stedy/sigma").ends_with("Did you mean \"steady/sigma\"?"));
  CHECK(refusal("kww/rho") ==
        "kww/rho of z is not kept for sweep point 0; it has kww/rho_inf, kww/tau_f. Did you mean "
        "\"kww/rho_inf\"?");
  CHECK(refusal("inverse_log/X_inf").find("kww/tau_f, steady/") != std::string::npos);
  CHECK(refusal("inverse_log/X_inf").find(": make the analysis or the fit first.") !=
        std::string::npos);
  CHECK(refusal("steady/sigma", "x") ==
        "steady/sigma of x is not kept for sweep point 0: make the analysis or the fit first");
}

TEST_CASE(
    "Lines through a fit's parameter hold the truth, and are called bent, at their stated rate",
    "[slow]") {
  check(4, 0.003, 40);
}

TEST_CASE("Lines through a fit's parameter, in many sweeps", "[nightly]") {
  for (const std::size_t realizations : {3u, 4u, 10u, 20u}) check(realizations, 0.003, 400);
}
