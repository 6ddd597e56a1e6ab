#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "fitting/fit.hpp"
#include "fitting/models/limit.hpp"
#include "fitting/models/models.hpp"
#include "fitting/numbers.hpp"
#include "fitting/report.hpp"
#include "tests/fitting/noise.hpp"
#include "tests/test_files.hpp"

namespace jostle {
namespace {

/// A curve whose parameters can nearly make up for each other, with its certified minimum.
struct SloppySet {
  std::unique_ptr<Model> model;
  Curve curve;
  nlohmann::json json;
};

SloppySet read_sloppy(const std::string& name, const std::string& model) {
  std::ifstream file(test_data("fits/" + name + ".json"));
  SloppySet set{make_model(model), {}, nlohmann::json::parse(file)};
  set.curve.t = set.json["x"].get<std::vector<double>>();
  set.curve.x = set.json["y"].get<std::vector<double>>();
  return set;
}

Fit fit_sloppy(const SloppySet& set) {
  return std::get<Fit>(fit(*set.model, set.curve));
}

bool mentions(const std::vector<std::string>& texts, const std::string& words) {
  return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) {
    return text.find(words) != std::string::npos;
  });
}

void check_certified(const SloppySet& set, const Fit& fitted) {
  const std::vector<double> minimum = set.json["certified_params"];
  const std::vector<double> errors = set.json["certified_stderr"];
  const std::vector<double> profile = set.json["profile_95"];
  for (std::size_t j = 0; j < minimum.size(); ++j) {
    INFO(fitted.estimates[j].parameter.name);
    CHECK(fitted.estimates[j].value == Approx(minimum[j]).epsilon(1e-8));
    CHECK(fitted.estimates[j].standard_error == Approx(errors[j]).epsilon(1e-7));
  }
  CHECK(fitted.condition ==
        Approx(set.json["scaled_condition_number"].get<double>()).epsilon(1e-6));
  CHECK(fitted.estimates[0].intervals[1].lower == Approx(profile[0]).epsilon(1e-6));
  CHECK(fitted.estimates[0].intervals[1].upper == Approx(profile[1]).epsilon(1e-6));
}

}  // namespace

TEST_CASE("an inverse log at small excitation is reported as not unique") {
  const SloppySet set = read_sloppy("IL_sloppy", "inverse_log");
  const Fit fitted = fit_sloppy(set);
  check_certified(set, fitted);
  CHECK(fitted.estimates[0].identifiability == Identifiability::wide);
  CHECK(fitted.estimates[1].identifiability == Identifiability::wide);
  CHECK(fitted.estimates[2].identifiability == Identifiability::wide);
  CHECK(mentions(fitted.remarks, "not unique"));
  CHECK(mentions(fitted.remarks, "condition number"));
  // The profile is not the parabola that a standard error draws.
  const Estimate& x_inf = fitted.estimates[0];
  CHECK(x_inf.intervals[1].upper - x_inf.value > 1.5 * (x_inf.value - x_inf.intervals[1].lower));
}

TEST_CASE("every tap of the same curve narrows it, but X_inf stays wide") {
  const SloppySet set = read_sloppy("IL_sloppy_every_tap", "inverse_log");
  const Fit fitted = fit_sloppy(set);
  check_certified(set, fitted);
  CHECK(fitted.estimates[0].identifiability == Identifiability::wide);
}

TEST_CASE("a stretched exponential that is 73 % relaxed is reported as wide") {
  const SloppySet set = read_sloppy("KWW_sloppy", "kww");
  const Fit fitted = fit_sloppy(set);
  check_certified(set, fitted);
  CHECK(fitted.estimates[0].identifiability == Identifiability::wide);
  CHECK(fitted.estimates[3].identifiability == Identifiability::identified);
  CHECK(mentions(fitted.remarks, "not unique"));
}

TEST_CASE("refits to shorter ranges find their own minima, with one-sided bounds at last") {
  for (const auto& [name, model] :
       {std::pair{"IL_sloppy", "inverse_log"}, std::pair{"IL_sloppy_every_tap", "inverse_log"},
        std::pair{"KWW_sloppy", "kww"}}) {
    const SloppySet set = read_sloppy(name, model);
    for (const auto& refit : set.json["refits"]) {
      const Curve part = restricted(set.curve, 1, refit["last"]);
      const Fit fitted = std::get<Fit>(fit(*set.model, part));
      INFO(name << " to " << refit["last"]);
      CHECK(fitted.residual_sum == Approx(refit["rss"].get<double>()).epsilon(1e-9));
      const std::vector<double> minimum = refit["params"];
      for (std::size_t j = 0; j < minimum.size(); ++j) {
        CHECK(fitted.estimates[j].value == Approx(minimum[j]).epsilon(1e-7));
      }
      const Identifiability last = fitted.estimates[0].identifiability;
      CHECK((last == Identifiability::wide || last == Identifiability::bounded_below));
    }
  }
  const SloppySet set = read_sloppy("IL_sloppy", "inverse_log");
  const Fit shortest = std::get<Fit>(fit(*set.model, restricted(set.curve, 1, 300)));
  CHECK(shortest.estimates[0].identifiability == Identifiability::bounded_below);
  CHECK(shortest.estimates[0].statement.starts_with("X_inf has only a lower limit: X_inf > "));
}

TEST_CASE("no value less its error lies below what 95 % allow") {
  // Half of a 68 % interval that reaches far up is longer than the way down.
  Estimate tau;
  tau.parameter.name = "tau";
  tau.value = 56;
  tau.error = 14;
  tau.intervals[0] = {46, 74};
  tau.intervals[1] = {43.567, 3587.5};
  tau.identifiability = Identifiability::wide;
  CHECK(estimate_text(tau) == "56(+18/-10)");
  tau.intervals[1] = {30, infinite};
  CHECK(estimate_text(tau) == "56(14)");
}

TEST_CASE("the interval of 95 % holds that of 68 %, also where parameters diverge together") {
  // Twenty nearly straight points: they do not determine the bend of the logarithm.
  for (const double noise : {1e-6, 1e-4, 1e-3}) {
    Curve curve;
    for (int t = 1; t <= 20; ++t) {
      curve.t.push_back(t);
      curve.x.push_back(0.541 + 2.3e-4 * t + noise * std::sin(12.9898 * t * t));
      curve.sigma.push_back(2e-3);
    }
    for (const auto& model : all_models()) {
      const auto outcome = fit(*model, curve);
      const auto* fitted = std::get_if<Fit>(&outcome);
      if (fitted == nullptr) continue;
      CAPTURE(noise, model->name());
      for (const Estimate& estimate : fitted->estimates) {
        CHECK(estimate.intervals[1].lower <= estimate.intervals[0].lower);
        CHECK(estimate.intervals[1].upper >= estimate.intervals[0].upper);
      }
    }
  }
}

TEST_CASE("the factor of a power of t is measured by itself, not by the values of the curve") {
  const std::vector<Limit> limits = make_model("kww")->limits();
  const auto power = std::find_if(limits.begin(), limits.end(), [](const Limit& limit) {
    return limit.law->name() == "power_of_t";
  });
  REQUIRE(power != limits.end());
  Noise noise(31);
  for (const double scatter : {1e-3, 1e-7}) {
    CAPTURE(scatter);
    Curve curve;
    for (double t = 1e4; t < 1.1e6; t *= 1.2) {  // beta and r make up for each other
      curve.t.push_back(t);
      curve.x.push_back(0.6 + 1e-4 * std::pow(t, 0.4) + scatter * noise());
    }
    const Fit fitted = std::get<Fit>(fit(*power->law, curve));
    const Estimate& r = fitted.estimates[1];
    CAPTURE(r.statement);
    const Interval& interval = r.intervals[1];
    REQUIRE(interval.closed());
    CHECK(interval.upper - interval.lower < 0.1 * (curve.x.back() - curve.x.front()));
    const bool precise = interval.lower > 0 && interval.upper < 2 * interval.lower;
    CHECK(precise == (scatter < 1e-5));
    CHECK((r.identifiability == Identifiability::identified) == precise);
  }
}

TEST_CASE("A of a power law is measured by itself where t = 1 is far from the curve") {
  const auto fitted_A = [](double first, double scatter) {
    Noise noise(32);
    Curve curve;
    for (double t = first; t < 1e3 * first; t *= 1.4) {
      curve.t.push_back(t);
      curve.x.push_back(std::pow(t / first, -1.5) * std::exp(scatter * noise()));
    }
    const Fit fitted = std::get<Fit>(fit(*make_model("power_law"), curve));
    REQUIRE(fitted.estimates[0].intervals[1].closed());
    return fitted.estimates[0];
  };
  const Estimate at_small_t = fitted_A(1e-4, 0.8);
  CAPTURE(at_small_t.statement);
  CHECK(at_small_t.intervals[1].upper > 2 * at_small_t.intervals[1].lower);
  CHECK(at_small_t.intervals[1].upper - at_small_t.intervals[1].lower <
        0.01);  // little of the range, 1
  CHECK(at_small_t.identifiability == Identifiability::wide);
  const Estimate at_large_t = fitted_A(1e4, 0.02);
  CAPTURE(at_large_t.statement);
  CHECK(at_large_t.intervals[1].upper < 2 * at_large_t.intervals[1].lower);
  CHECK(at_large_t.intervals[1].upper - at_large_t.intervals[1].lower > 1);
  CHECK(at_large_t.identifiability == Identifiability::identified);
}

TEST_CASE("a good curve is reported as identified, without remarks") {
  const SloppySet set = read_sloppy("IL_easy", "inverse_log");
  const Fit fitted = fit_sloppy(set);
  for (const Estimate& estimate : fitted.estimates) {
    INFO(estimate.statement);
    CHECK(estimate.identifiability == Identifiability::identified);
    CHECK(estimate.intervals[1].closed());
    CHECK(estimate.intervals[1].lower < estimate.intervals[0].lower);
    CHECK(estimate.intervals[0].upper < estimate.intervals[1].upper);
  }
  CHECK(fitted.remarks.empty());
}

TEST_CASE("intervals of a fit that stopped are unfinished, and the data are not blamed") {
  Curve curve;
  Noise noise(17);
  for (int tap = 1; tap <= 400; ++tap) {
    curve.t.push_back(tap);
    curve.x.push_back(0.6 - 0.05 / (1 + std::log1p(tap / 10.0)) + 1e-5 * noise());
  }
  const auto model = make_model("inverse_log");
  const auto fit_within = [&](long long evaluations) {
    FitOptions options;
    options.max_evaluations = evaluations;
    return std::get<Fit>(fit(*model, curve, options));
  };
  const Fit whole = fit_within(100000);
  for (const Estimate& estimate : whole.estimates)
    REQUIRE(estimate.identifiability == Identifiability::identified);
  int unfinished = 0, identified_after_a_stop = 0;
  for (long long most = 20; most < whole.total_evaluations; most += 20) {
    CAPTURE(most);
    const Fit found = fit_within(most);
    const bool stopped = mentions(found.remarks, "stopped at its limit of evaluations");
    CHECK_FALSE(mentions(found.remarks, "The data hardly constrain"));
    for (const Estimate& estimate : found.estimates) {
      CAPTURE(estimate.statement);
      const bool closed = estimate.intervals[1].closed();
      CHECK(estimate.identifiability ==
            (closed ? Identifiability::identified : Identifiability::unfinished));
      CHECK((closed || stopped));
      if (!closed) {
        ++unfinished;
        CHECK(std::isfinite(estimate.error) == estimate.has_value());
        CHECK(estimate.statement.find("the fit stopped before") != std::string::npos);
      } else if (stopped) {
        ++identified_after_a_stop;
      }
    }
  }
  CHECK(unfinished > 20);
  CHECK(identified_after_a_stop > 0);
}

}  // namespace jostle
