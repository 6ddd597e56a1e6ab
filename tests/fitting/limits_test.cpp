#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "fitting/fit.hpp"
#include "fitting/intervals/distributions.hpp"
#include "fitting/models/limit.hpp"
#include "fitting/models/models.hpp"
#include "fitting/report.hpp"
#include "tests/fitting/noise.hpp"

// Laws whose least squares lie where some of their parameters are 0 or infinite.
namespace jostle {
namespace {

const Estimate* named(const std::vector<Estimate>& estimates, const std::string& name) {
  const auto found = std::ranges::find_if(
      estimates, [&](const Estimate& estimate) { return estimate.parameter.name == name; });
  return found == estimates.end() ? nullptr : &*found;
}

// 0.574 - 0.02 / (1 + c t), or with a logarithm that sets in at tau: realizations of 400 taps with
// AR(1) noise of 0.001, and levels of their own with a deviation of `level` times the noise.
Curve approach(int n_realizations, double rho, double tau, int number, double level = 0) {
  constexpr double c = 0.02;
  Noise noise(static_cast<std::uint64_t>(number));
  std::vector<double> t, values, memory(static_cast<std::size_t>(n_realizations));
  for (double& state : memory) state = noise();
  std::vector<double> levels(memory.size(), 0.0);
  for (double& own : levels) own = level > 0 ? 1e-3 * level * noise() : 0;
  for (int tap = 1; tap <= 400; ++tap) {
    t.push_back(tap);
    const double grown = std::isfinite(tau) ? c * tau * std::log1p(tap / tau) : c * tap;
    for (std::size_t r = 0; r < memory.size(); ++r) {
      values.push_back(0.574 - 0.02 / (1 + grown) + levels[r] + 1e-3 * memory[r]);
      memory[r] = rho * memory[r] + std::sqrt(1 - rho * rho) * noise();
    }
  }
  return mean_curve(std::move(t), std::move(values), static_cast<std::size_t>(n_realizations));
}

constexpr double never = std::numeric_limits<double>::infinity();

bool holds(const Interval& interval, double truth) {
  return interval.lower <= truth && truth <= interval.upper;
}

// X_inf of the inverse log, at both levels, and where the curve is a hyperbola that of the limit;
// and how many of the fits were at the limit.
void check_coverage(int n_realizations, double rho, double tau, int ensembles) {
  constexpr double truth = 0.574;
  int held[2] = {0, 0}, held_at_limit[2] = {0, 0}, hyperbolas = 0, at_limit = 0;
  for (int number = 1; number <= ensembles; ++number) {
    const Fit found = std::get<Fit>(fit(InverseLog(), approach(n_realizations, rho, tau, number)));
    at_limit += found.limit.has_value();
    const bool hyperbola = found.limit && found.limit->name == "hyperbola";
    hyperbolas += hyperbola;
    for (int level = 0; level < 2; ++level) {
      held[level] += holds(found.estimates[0].intervals[level], truth);
      held_at_limit[level] +=
          hyperbola && holds(named(found.limit->estimates, "X_inf")->intervals[level], truth);
    }
  }
  std::printf(
      "inverse_log near its limit, M %2d  rho %4.2f  tau %5.0f  at the limit %3d of %3d  "
      "68 %%: %5.1f  95 %%: %5.1f  as a hyperbola %3d  68 %%: %5.1f  95 %%: %5.1f\n",
      n_realizations, rho, tau, at_limit, ensembles, 100.0 * held[0] / ensembles,
      100.0 * held[1] / ensembles, hyperbolas, 100.0 * held_at_limit[0] / hyperbolas,
      100.0 * held_at_limit[1] / hyperbolas);
  std::fflush(stdout);
  INFO(n_realizations << " realizations, rho " << rho << ", tau " << tau);
  const auto margin = [&](double rate) { return 3 * std::sqrt(rate * (1 - rate) * ensembles); };
  CHECK(at_limit > 0.2 * ensembles);
  CHECK(held[0] >= 0.60 * ensembles - margin(0.60));
  CHECK(held[1] >= 0.90 * ensembles - margin(0.90));
  // 1/tau >= 0 is a bound that equals the truth, and the estimate of half of the ensembles:
  // intervals hold the truth in up to (1 + level) / 2 of them (Chernoff 1954,
  // doi:10.1214/aoms/1177728725).
  CHECK(held[0] <= 0.84 * ensembles + margin(0.84));
}

// X_inf and dX of a hyperbola whose realizations keep to levels of their own.
void check_coverage_with_levels(int n_realizations, double level, int ensembles) {
  constexpr double truth[] = {0.574, 0.02};
  int held[2][2] = {{0, 0}, {0, 0}}, at_limit = 0;
  for (int number = 1; number <= ensembles; ++number) {
    const Fit found =
        std::get<Fit>(fit(InverseLog(), approach(n_realizations, 0, never, number, level)));
    at_limit += found.limit.has_value();
    for (std::size_t j = 0; j < 2; ++j) {
      for (std::size_t confidence = 0; confidence < 2; ++confidence) {
        held[j][confidence] += holds(found.estimates[j].intervals[confidence], truth[j]);
      }
    }
  }
  const auto percent = [&](int count) { return 100.0 * count / ensembles; };
  std::printf(
      "hyperbola, M %2d  level %3.1f  at the limit %3d of %3d  X_inf 68 %%: %5.1f  95 %%: %5.1f  "
      "dX 68 %%: %5.1f  95 %%: %5.1f\n",
      n_realizations, level, at_limit, ensembles, percent(held[0][0]), percent(held[0][1]),
      percent(held[1][0]), percent(held[1][1]));
  std::fflush(stdout);
  INFO(n_realizations << " realizations, level " << level);
  const auto margin = [&](double rate) { return 3 * std::sqrt(rate * (1 - rate) * ensembles); };
  for (std::size_t j = 0; j < 2; ++j) {
    CHECK(held[j][0] >= 0.62 * ensembles - margin(0.62));
    CHECK(held[j][1] >= 0.95 * ensembles - margin(0.95));
  }
}

}  // namespace

TEST_CASE("Laws near their limits draw the curves of the limits") {
  const std::vector<double> t = geometric(1, 400, 30);
  int checked = 0;
  for (const auto& model : all_models()) {
    for (const Limit& limit : model->limits()) {
      if (!limit.near) continue;
      const std::size_t n = limit.law->parameters().size();
      // The variables of a height: level, change or start, and what is left in the order of each
      // law.
      ParameterValues p = {14, 15, 0.02, 30};
      if (limit.law->parameters().back().unit == ParameterUnit::time) p = {14, 0.5, 30, 0};
      if (limit.law->name() == "exponential_and_line") p = {14, 0.01, 0.5, 30};
      if (limit.law->name() == "saturation") p = {14, 0.02};
      if (limit.law->name() == "power_of_t") p = {14, 0.5, 0.4};
      if (limit.law->name() == "logarithm_from_0") p = {0.5, 30};
      p.resize(n);
      CAPTURE(model->name(), limit.law->name());
      double last = never;
      for (const double distance : {1e2, 1e3, 1e4}) {
        const ParameterValues q = limit.near(p, distance, 1, 400);
        REQUIRE(q.size() == model->parameters().size());
        double misfit = 0, range = 0;
        for (const double tap : t) {
          const double x = limit.law->value(tap, p.data());
          misfit = std::max(misfit, std::abs(model->value(tap, q.data()) - x));
          range = std::max(range, std::abs(x - limit.law->value(1, p.data())));
        }
        CHECK(misfit <= 8 / distance * range);
        CHECK(misfit < 0.2 * last);
        last = misfit;
        ++checked;
      }
    }
  }
  CHECK(checked >= 45);
}

TEST_CASE("A law at its limit is fitted as the limit, and what is lost has bounds") {
  int at_limit = 0;
  for (int number = 1; number <= 8; ++number) {
    const Fit found = std::get<Fit>(fit(InverseLog(), approach(4, 0, never, number)));
    if (!found.limit) continue;
    ++at_limit;
    CHECK(found.limit->name == "hyperbola");
    CHECK(found.n_free == 3);
    CHECK(found.condition < 1e8);
    const Estimate* x_inf = named(found.limit->estimates, "X_inf");
    REQUIRE(x_inf);
    CHECK(x_inf->intervals[1].closed());
    REQUIRE(named(found.combinations, "B/tau"));
    CHECK(named(found.combinations, "B/tau")->value == Approx(0.02).epsilon(0.3));
    for (const std::size_t lost : {2, 3}) {
      const Estimate& estimate = found.estimates[lost];
      CAPTURE(estimate.statement);
      CHECK(estimate.identifiability == Identifiability::bounded_below);
      CHECK_FALSE(estimate.has_value());
      CHECK(estimate.intervals[1].lower > 0);
    }
    // The law may leave its limit after the last tap: it allows what the limit does, and more.
    CHECK(found.estimates[0].value == x_inf->value);
    CHECK(found.estimates[0].intervals[1].lower <= x_inf->intervals[1].lower);
    CHECK(found.estimates[0].intervals[1].upper >= x_inf->intervals[1].upper);
    const std::string report = describe(found);
    CHECK(report.find("fitted as its limit, X = X_inf - dX / (1 + (B/tau) t)") !=
          std::string::npos);
    CHECK(report.find("and not B and tau separately") != std::string::npos);
  }
  CHECK(at_limit >= 2);
}

TEST_CASE("The limit is as well known as the same curve fitted as a law of its own") {
  for (int number = 1; number <= 8; ++number) {
    const Curve curve = approach(4, 0.9, never, number);
    const Fit found = std::get<Fit>(fit(InverseLog(), curve));
    if (!found.limit) continue;
    const Fit own = std::get<Fit>(fit(*found.limit->law, curve));
    for (std::size_t j = 0; j < own.estimates.size(); ++j) {
      const Estimate& a = own.estimates[j];
      const Estimate& b = found.limit->estimates[j];
      CHECK(a.value == Approx(b.value).epsilon(1e-8));
      CHECK(a.error == Approx(b.error).epsilon(1e-6));
      CHECK(a.intervals[1].lower == Approx(b.intervals[1].lower).epsilon(1e-6));
      CHECK(a.intervals[1].upper == Approx(b.intervals[1].upper).epsilon(1e-6));
    }
  }
}

TEST_CASE("One error: half of the 68 % interval is Student's t times it") {
  for (const double tau : {3.0, 800.0, never}) {
    const Fit found = std::get<Fit>(fit(InverseLog(), approach(4, 0.5, tau, 3)));
    std::vector<Estimate> all = found.estimates;
    all.insert(all.end(), found.combinations.begin(), found.combinations.end());
    if (found.restated) {
      all.insert(all.end(), found.restated->estimates.begin(), found.restated->estimates.end());
    }
    for (const Estimate& estimate : all) {
      CAPTURE(tau, estimate.parameter.name);
      CHECK(std::isfinite(estimate.error) == estimate.intervals[0].closed());
      if (!estimate.intervals[0].closed()) continue;
      CHECK(student_two_sided(interval_levels[0], 3) * estimate.error ==
            Approx(estimate.half_width()).epsilon(1e-12));
    }
  }
}

TEST_CASE("X_inf near the limit: intervals hold the truth at their stated rate", "[slow]") {
  check_coverage(4, 0, never, 16);
  check_coverage(4, 0, 800, 16);
  check_coverage(3, 0.99, never, 16);
}

TEST_CASE("X_inf near the limit, in many ensembles", "[nightly]") {
  for (const int n_realizations : {3, 4, 10, 20}) {
    for (const double rho : {0.0, 0.99}) {
      for (const double tau : {400.0, 800.0, never}) check_coverage(n_realizations, rho, tau, 200);
    }
  }
}

TEST_CASE("X_inf near the limit where realizations keep to levels of their own", "[statistics]") {
  check_coverage_with_levels(4, 3, 24);
}

TEST_CASE("X_inf near the limit where realizations keep to levels that hardly differ", "[slow]") {
  check_coverage_with_levels(4, 0.5, 24);
}

TEST_CASE("X_inf near the limit with levels, in many ensembles", "[nightly]") {
  for (const int n_realizations : {3, 4, 6}) {
    for (const double level : {0.0, 0.5, 3.0}) {
      check_coverage_with_levels(n_realizations, level, 200);
    }
  }
}

TEST_CASE("Curves without noise reach their limits in few evaluations") {
  Curve curve;
  for (int tap = 1; tap <= 400; ++tap) {
    curve.t.push_back(tap);
    curve.x.push_back(0.5 + 0.01 * std::log(tap));
  }
  for (const char* law : {"inverse_log", "inverse_log_height", "kww"}) {
    CAPTURE(law);
    const Fit found = std::get<Fit>(fit(*make_model(law), curve));
    REQUIRE(found.limit);
    CHECK(found.limit->name == "line_in_ln_t");
    CHECK(found.limit->estimates[0].value == Approx(0.5).epsilon(1e-12));
    CHECK(found.limit->estimates[1].value == Approx(0.01).epsilon(1e-10));
    CHECK(found.total_evaluations < 2000);
    for (const Estimate& estimate : found.estimates) CHECK_FALSE(estimate.has_value());
  }
}

TEST_CASE("A fit stops after its limit of evaluations, and reports it") {
  const Curve curve = approach(4, 0, 3, 1);
  FitOptions options;
  for (const long long most : {50LL, 1500LL}) {
    options.max_evaluations = most;
    const Fit found = std::get<Fit>(fit(InverseLog(), curve, options));
    // The step under way is finished: a Jacobian, and one evaluation a descent.
    CHECK(found.total_evaluations < most + 400);
    CHECK(std::ranges::any_of(found.remarks, [](const std::string& remark) {
      return remark.starts_with("The fit stopped at its limit of evaluations (");
    }));
    CHECK(std::ranges::none_of(found.remarks, [](const std::string& remark) {
      return remark.find("did not settle") != std::string::npos;
    }));
    if (most == 50) CHECK_FALSE(is_minimum(found.reason));
  }
  CHECK(std::get<Fit>(fit(InverseLog(), curve)).total_evaluations < 100000);
}

TEST_CASE("Errors that weigh nothing or everything are refused with the reason") {
  Curve curve{.t = geometric(1, 400, 30), .x = {}};
  for (const double t : curve.t) curve.x.push_back(0.6 - 0.05 / (1 + std::log1p(t / 3)));
  const auto refusal = [&](double first, double rest) {
    Curve weighted = curve;
    weighted.sigma.assign(30, rest);
    weighted.sigma[4] = first;
    const auto outcome = fit(InverseLog(), weighted);
    const auto* refused = std::get_if<Refusal>(&outcome);
    return refused ? refused->message : std::string();
  };
  for (const auto& [first, rest] : {std::pair{1e308, 1e308},
                                    {1e308, 1e-3},
                                    {1e-3, 1e308},
                                    {1e-308, 1e-308},
                                    {1e-308, 1e-3},
                                    {1e-308, 1e308},
                                    {1e200, 1e-3},
                                    {1e-200, 1e-3},
                                    {1e40, 1e-3},
                                    {1e-60, 1e-3}}) {
    CAPTURE(first, rest);
    const std::string message = refusal(first, rest);
    CHECK(message.find("sigma") != std::string::npos);
    CHECK(message.find("nan") == std::string::npos);
  }
  CHECK(refusal(1e-3, 1e-3).empty());
  CHECK(refusal(1, 1e-6).empty());
  Curve large = curve;
  for (double& x : large.x) x *= 1e200;
  const auto outcome = fit(InverseLog(), large);
  REQUIRE(std::holds_alternative<Refusal>(outcome));
  CHECK(std::get<Refusal>(outcome).message.find("choose a unit") != std::string::npos);
}

}  // namespace jostle
