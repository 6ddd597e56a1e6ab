#include "fitting/summary.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace jostle {
namespace {

Fit fit_with_asymptote(const std::string& model, Interval interval) {
  Estimate estimate;
  estimate.parameter.name = "X_inf";
  estimate.value = 0.6;
  estimate.intervals[0] = {0.595, 0.605};
  estimate.intervals[1] = interval;
  estimate.identifiability = Identifiability::wide;
  Fit fit;
  fit.model = model;
  fit.estimates = {estimate};
  fit.reason = EndReason::cost;
  fit.error_dof = 10;
  return fit;
}

HeldOutLaw law_with(const std::string& model, double p, bool worse) {
  HeldOutLaw law;
  law.model = model;
  law.p = p;
  law.worse = worse;
  return law;
}

TEST_CASE("A summary has one interval for the asymptotes of all laws that are not rejected") {
  const std::vector<Fit> fits = {fit_with_asymptote("a", {0.58, 0.62}),
                                 fit_with_asymptote("b", {0.59, 0.64}),
                                 fit_with_asymptote("c", {0.1, 0.9})};
  LawComparison comparison;
  comparison.laws = {law_with("a", 1, false), law_with("b", 0.4, false), law_with("c", 0.01, true)};
  FitsSummary found = summary(fits, comparison, {"d", "taps"});
  CHECK(found.choice ==
        "undecided: a and b (p = 0.4) predict held-out realizations equally well, within the "
        "errors; c (p = 0.01) predicts worse");
  CHECK(found.asymptote == "0.58 to 0.64 d (95 %, over the laws that are not rejected)");
  CHECK(found.warning.empty());
  comparison.laws[1].worse = true;
  found = summary(fits, comparison, {});
  CHECK(found.choice ==
        "a predicts held-out realizations better than b (p = 0.4) and c (p = 0.01)");
  CHECK(found.asymptote == "X_inf 0.6000(50), 95 %: 0.58 to 0.62 (a)");
}

TEST_CASE("A summary reports an asymptote without a value in words, with its limits") {
  std::vector<Fit> fits = {fit_with_asymptote("a", {-INFINITY, 0.62})};
  Estimate& asymptote = fits[0].estimates[0];
  asymptote.intervals[0] = {-INFINITY, 0.605};
  asymptote.identifiability = Identifiability::bounded_above;
  REQUIRE_FALSE(asymptote.has_value());
  CHECK(summary(fits, {}, {"d", "taps"}).asymptote == "X_inf has no value, 95 %: < 0.62 d");
  asymptote.intervals[1] = {-INFINITY, INFINITY};
  CHECK(summary(fits, {}, {}).asymptote == "X_inf has no limit on either side");
  asymptote.identifiability = Identifiability::not_examined;
  asymptote.standard_error = 1e20;
  CHECK(summary(fits, {}, {}).asymptote == "X_inf has no value");
}

TEST_CASE("A summary of fixed parameters identifies none of them") {
  std::vector<Fit> fits = {fit_with_asymptote("a", {0.58, 0.62})};
  fits[0].estimates[0].identifiability = Identifiability::fixed;
  CHECK(summary(fits, {}, {"mm", "s"}).choice == "a: all parameters fixed");
  CHECK(summary(fits, {}, {"mm", "s"}).asymptote == "X_inf 0.6 mm fixed");
  Estimate time;
  time.parameter.name = "tau";
  time.identifiability = Identifiability::identified;
  fits[0].estimates.push_back(time);
  fits[0].n_free = 1;
  CHECK(summary(fits, {}, {}).choice == "a: all free parameters identified");
}

TEST_CASE("A summary has the unit of an asymptote beside its number") {
  std::vector<Fit> fits = {fit_with_asymptote("a", {0.58, 0.62})};
  CHECK(summary(fits, {}, {"mm", "s"}).asymptote == "X_inf 0.6000(50) mm, 95 %: 0.58 to 0.62");
  fits[0].estimates[0].intervals[0] = {-INFINITY, INFINITY};
  fits[0].estimates[0].intervals[1] = {-INFINITY, INFINITY};
  fits[0].estimates[0].identifiability = Identifiability::not_examined;
  CHECK(summary(fits, {}, {"mm", "s"}).asymptote == "X_inf 0.6 mm, error unknown");
}

TEST_CASE("A summary has the most severe warning of the laws that are not rejected") {
  std::vector<Fit> fits = {fit_with_asymptote("a", {0.58, 0.62}),
                           fit_with_asymptote("b", {0.59, 0.64})};
  fits[1].runs.z = -5;
  fits[1].runs.p = 1e-6;
  LawComparison comparison;
  CHECK(summary(fits, comparison, {}).warning == "the residuals are correlated about b");
  fits[0].scatter_ratio = 2;
  CHECK(summary(fits, comparison, {}).warning ==
        "the points scatter more than the errors given about a");
  fits[1].memory.time = 100;
  fits[1].error_dof = 2;
  CHECK(summary(fits, comparison, {}).warning ==
        "the residuals are correlated for too long: no errors for b");
  fits[0].reason = EndReason::iteration_limit;
  CHECK(summary(fits, comparison, {}).warning == "no minimum was found for a");
  comparison.laws = {law_with("a", 0.001, true), law_with("b", 1, false)};
  comparison.leading = 1;
  CHECK(summary(fits, comparison, {}).warning ==
        "the residuals are correlated for too long: no errors for b");
}

}  // namespace
}  // namespace jostle
