#include <catch2/catch.hpp>
#include <cmath>

#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "fitting/report.hpp"
#include "tests/fitting/noise.hpp"

// Philippe & Bideau's eqs. 3 and 4 are one law: X_inf = Z_inf, dX = Z_inf - Z_0, and B of eq. 3 is
// B of eq. 4 times Z_0 / Z_inf.
namespace jostle {
namespace {

// Mean heights of a bed that sinks, over three realizations.
Curve heights(int number) {
  Noise noise(static_cast<std::uint64_t>(number));
  std::vector<double> t, values;
  for (int tap = 1; tap <= 400; ++tap) {
    t.push_back(tap);
    const double mean = 13.9 + 0.77 / (1 + 0.7581 * std::log1p(tap / 4.0));
    for (int r = 0; r < 3; ++r) values.push_back(mean + 0.01 * noise());
  }
  return mean_curve(std::move(t), std::move(values), 3);
}

Fit fitted(const Model& model, const Curve& curve, const FitOptions& options = {}) {
  return std::get<Fit>(fit(model, curve, options));
}

void check_alike(const Estimate& a, const Estimate& b) {
  CAPTURE(a.parameter.name, a.value, b.value);
  CHECK(a.parameter.name == b.parameter.name);
  CHECK(a.value == Approx(b.value).epsilon(1e-6));
  CHECK(a.error == Approx(b.error).epsilon(1e-4));
  CHECK(a.standard_error == Approx(b.standard_error).epsilon(1e-4));
  CHECK(a.identifiability == b.identifiability);
  for (int level = 0; level < 2; ++level) {
    CHECK(a.intervals[level].lower == Approx(b.intervals[level].lower).epsilon(1e-4));
    CHECK(a.intervals[level].upper == Approx(b.intervals[level].upper).epsilon(1e-4));
  }
}

}  // namespace

TEST_CASE("Equivalent laws draw the same curves, and are each other's equivalent") {
  int pairs = 0;
  for (const auto& model : all_models()) {
    const auto equivalent = model->equivalent();
    if (!equivalent) continue;
    ++pairs;
    INFO(model->name());
    const auto back = equivalent->law->equivalent();
    REQUIRE(back);
    CHECK(back->law->name() == model->name());
    const ParameterValues p = model->name() == "inverse_log" ? ParameterValues{13.9, -0.77, 0.7, 4}
                                                             : ParameterValues{13.9, 14.67, 0.8, 4};
    const ParameterValues q = equivalent->restate(p), repeated = back->restate(q);
    REQUIRE(q.size() == equivalent->equal.size());
    for (const double t : {0.0, 1.0, 30.0, 4000.0}) {
      CHECK(equivalent->law->value(t, q.data()) ==
            Approx(model->value(t, p.data())).epsilon(1e-14));
    }
    for (std::size_t j = 0; j < p.size(); ++j) CHECK(repeated[j] == Approx(p[j]).epsilon(1e-14));
    for (std::size_t j = 0; j < q.size(); ++j) {
      if (equivalent->equal[j]) CHECK(q[j] == p[*equivalent->equal[j]]);
    }
  }
  CHECK(pairs == 2);
}

TEST_CASE("Eqs. 3 and 4 are fitted once, with values, errors and intervals of both") {
  for (int number = 1; number <= 3; ++number) {
    const Curve curve = heights(number);
    const Fit eq_3 = fitted(InverseLog(), curve), eq_4 = fitted(InverseLogHeight(), curve);
    CHECK(eq_3.residual_sum == Approx(eq_4.residual_sum).epsilon(1e-10));
    REQUIRE(eq_3.restated);
    REQUIRE(eq_4.restated);
    CHECK(eq_3.restated->model == "inverse_log_height");
    CHECK(eq_4.restated->model == "inverse_log");
    for (std::size_t j = 0; j < 4; ++j) {
      check_alike(eq_3.restated->estimates[j], eq_4.estimates[j]);
      check_alike(eq_4.restated->estimates[j], eq_3.estimates[j]);
    }
    const double ratio = eq_4.estimates[0].value / eq_4.estimates[1].value;
    CHECK(eq_4.estimates[2].value / ratio == Approx(eq_3.estimates[2].value).epsilon(1e-6));
  }
}

TEST_CASE("A fixed parameter is restated where both laws have it, and nothing is where not") {
  const Curve curve = heights(1);
  FitOptions options;
  options.fixed = {{"tau", 4.0}};
  const Fit fit_of_law = fitted(InverseLog(), curve, options);
  REQUIRE(fit_of_law.restated);
  CHECK(fit_of_law.restated->estimates[3].identifiability == Identifiability::fixed);
  options.fixed = {{"dX", -0.77}};
  CHECK_FALSE(fitted(InverseLog(), curve, options).restated);
  // A law of heights has no curve that falls below 0.
  Curve lowered = curve;
  for (double& x : lowered.x) x -= 14;
  for (double& x : lowered.values) x -= 14;
  CHECK_FALSE(fitted(InverseLog(), lowered).restated);
}

TEST_CASE("One law under two names is ranked once and reported under both") {
  const Curve curve = heights(2);
  const std::vector<Fit> fits = {fitted(InverseLog(), curve), fitted(InverseLogHeight(), curve),
                                 fitted(StretchedExponential(), curve)};
  const InverseLog eq_3;
  const InverseLogHeight eq_4;
  const StretchedExponential kww;
  const LawComparison comparison =
      compare_laws({{&eq_3, &fits[0]}, {&eq_4, &fits[1]}, {&kww, &fits[2]}}, curve);
  const std::string table = compare(fits, comparison);
  CHECK(table.find("inverse_log ") != std::string::npos);
  CHECK(table.find("inverse_log_height") == std::string::npos);
  CHECK(comparison.laws.size() == 2);
  CHECK(verdict(fits, comparison).find("inverse_log_height") == std::string::npos);
  const std::string report = describe(fits[0]);
  for (const char* name : {"X_inf", "dX", "inverse_log_height", "Z_inf", "Z_0", "eq. 4"}) {
    CAPTURE(name);
    CHECK(report.find(name) != std::string::npos);
  }
}

}  // namespace jostle
