#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "cli/reports/fit_output.hpp"

// The rows of fits that end a run.
using namespace jostle;

namespace {

/// Four realizations of 0.574 - 0.02 / (1 + 0.02 t), the limit of an inverse log.
Curve hyperbola() {
  std::vector<double> t, values;
  for (int tap = 1; tap <= 400; ++tap) {
    t.push_back(tap);
    for (int r = 0; r < 4; ++r) {
      const double noise = 1e-3 * std::sin(12.9898 * tap + 78.233 * r + 0.5 * tap * r);
      values.push_back(0.574 - 0.02 / (1 + 0.02 * tap) + noise);
    }
  }
  return mean_curve(std::move(t), std::move(values), 4);
}

}  // namespace

TEST_CASE("The summary has the asymptote of the full law, where its limit was fitted") {
  FittedCurve fitted;
  fitted.source.curve = hyperbola();
  fitted.outcomes = fit_models(models_named("inverse_log"), fitted.source.curve, {});
  Fit& fit = std::get<Fit>(fitted.outcomes.at(0).result);
  REQUIRE(fit.limit);
  Estimate& of_law = fit.estimates.at(0);
  REQUIRE(of_law.parameter.name == "X_inf");
  const double open = std::numeric_limits<double>::infinity();
  of_law.intervals[0] = {0.5735, open};
  of_law.intervals[1] = {0.5731, open};
  of_law.identifiability = Identifiability::bounded_below;
  REQUIRE(fit.limit->estimates.at(0).has_value());
  const std::vector<FitSummary> rows = summary_of(fitted);
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].asymptote == "X_inf > 0.5731");
  const std::string text = summary_text(rows, {.width = 200});
  CHECK(text.find("the only 95 % limit") != std::string::npos);
  CHECK(text.find(" Fitted as a limit of the law: inverse_log as hyperbola. --verbose") !=
        std::string::npos);
}
