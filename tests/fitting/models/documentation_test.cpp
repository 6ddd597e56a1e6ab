#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "fitting/models/models.hpp"
#include "fitting/report.hpp"
#include "tests/test_files.hpp"

namespace jostle {
namespace {

std::string read_text(const std::string& name) {
  std::ifstream file(source_file(name));
  REQUIRE(file);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("the documentation of fits quotes its example as it is compiled") {
  CHECK(contains(read_text("docs/reference/laws.md"), read_text("docs/examples/own_model.cpp")));
}

TEST_CASE("the documentation of fits lists every model with its parameters") {
  const std::string text = read_text("docs/reference/laws.md");
  for (const auto& model : all_models()) {
    CHECK(contains(text, '`' + model->name() + '`'));
    CHECK(contains(text, model->formula()));
    for (const Parameter& parameter : model->parameters()) {
      CHECK(contains(text, parameter.name));
    }
  }
}

TEST_CASE("a report for people names what it gives") {
  Curve curve;
  const ParameterValues truth = {0.64, 0.056, 0.3, 10};
  for (double t : geometric(1, 100, 30)) {
    curve.t.push_back(t);
    curve.x.push_back(InverseLog().value(t, truth.data()) + 3e-4 * ((curve.t.size() % 3) - 1.0));
  }
  const InverseLog inverse_log;
  const StretchedExponential kww;
  const Fit wide = std::get<Fit>(fit(inverse_log, curve));
  const std::string report = describe(wide, ReportDetail::full);
  for (const char* part :
       {"inverse_log: X = X_inf - dX", "eq. 3", "95 %", "tau", "30 points", "independent points",
        "condition", "runs", "not unique", "linear error"}) {
    INFO(report);
    CHECK(contains(report, part));
  }
  CHECK_FALSE(contains(report, "nan"));
  CHECK(contains(report, "  units: X_inf, dX, Z_inf, Z_0 in [X]; tau in [t]\n"));
  CHECK(contains(describe(wide, ReportDetail::brief, {"mm", "s"}),
                 "  units: X_inf, dX, Z_inf, Z_0 in mm; tau in s\n"));
  CHECK(contains(describe(wide, ReportDetail::brief, {"1", "taps"}), "  units: tau in taps\n"));
  const auto profile = make_model("profile");
  const ParameterValues bed = {0.6, 0.001, 4, 12};
  Curve heights{.t = {}, .x = {}};
  for (double z = 5; z < 15; z += 0.5) {
    heights.t.push_back(z);
    heights.x.push_back(profile->value(z, bed.data()) + 1e-3 * ((heights.t.size() % 3) - 1.0));
  }
  const Fit surface = std::get<Fit>(fit(*profile, heights));
  CHECK(contains(describe(surface, ReportDetail::brief, {"1", "R"}), "beta in 1/R"));
  const Fit second = std::get<Fit>(fit(kww, curve));
  const LawComparison comparison = compare_laws({{&inverse_log, &wide}, {&kww, &second}}, curve);
  CHECK(contains(compare({wide, second}, comparison), "kww"));
  CHECK(verdict({wide, second}, comparison)
            .starts_with(
                "cannot decide: the choice of a law requires 3 independent realizations or more"));
}

TEST_CASE("a report gives a value the error that its interval bears out") {
  Curve curve;
  for (double t : geometric(1, 1000, 30)) {
    curve.t.push_back(t);
    curve.x.push_back(0.6 - 0.05 * std::exp(-t / 100) + 1e-4 * ((curve.t.size() % 3) - 1.0));
  }
  Fit fit = std::get<Fit>(jostle::fit(StretchedExponential(), curve));
  Estimate& estimate = fit.estimates.front();
  estimate.value = 0.6;
  const auto row = [&](double lower, double upper) {
    estimate.intervals[0] = {lower, upper};
    estimate.intervals[1] = {2 * lower - estimate.value, 2 * upper - estimate.value};
    const std::string text = describe(fit);
    const std::size_t start = text.find("\n  " + estimate.parameter.name) + 1;
    return text.substr(start, text.find('\n', start) - start);
  };
  CHECK(contains(row(0.599, 0.601), "0.6000(10)"));
  CHECK(contains(row(0.598, 0.601), "0.6000(15)"));
  // Where half a lopsided interval would reach below the 95 % limit, both sides are given.
  CHECK(contains(row(0.5999, 0.62), "0.60000(+0.02000/-0.00010)"));
  const double infinity = std::numeric_limits<double>::infinity();
  estimate.identifiability = Identifiability::bounded_below;
  CHECK(contains(row(0.59, infinity), " - "));
}

}  // namespace jostle
