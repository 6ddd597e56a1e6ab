#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "noise.hpp"

// Every hard case ends in a right answer or a named refusal, and no number of a fit is NaN.
namespace jostle {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

Curve sampled(const Model& model, const ParameterValues& p, const std::vector<double>& t,
              double noise_size = 0) {
  Noise noise(3);
  Curve curve{t, {}, {}};
  for (double time : t) curve.x.push_back(model.value(time, p.data()) + noise_size * noise());
  return curve;
}

bool has_nan(const Fit& fit) {
  std::vector<double> numbers = {fit.residual_sum, fit.reduced_chi2,  fit.r2,
                                 fit.condition,    fit.runs.expected, fit.runs.z,
                                 fit.runs.p,       fit.error_factor,  fit.effective_size};
  for (const Estimate& e : fit.estimates) {
    numbers.insert(numbers.end(), {e.value, e.standard_error});
    for (const Interval& i : e.intervals) numbers.insert(numbers.end(), {i.lower, i.upper});
  }
  numbers.insert(numbers.end(), fit.fitted.begin(), fit.fitted.end());
  numbers.insert(numbers.end(), fit.residuals.begin(), fit.residuals.end());
  for (double c : fit.covariance.reshaped()) numbers.push_back(c);
  for (double c : fit.correlation.reshaped()) numbers.push_back(c);
  return std::any_of(numbers.begin(), numbers.end(), [](double v) { return std::isnan(v); });
}

// The kind of the refusal, its message given out where the test fails.
RefusalKind refused(const Model& model, const Curve& curve, const FitOptions& options = {}) {
  const auto result = fit(model, curve, options);
  REQUIRE(std::holds_alternative<Refusal>(result));
  const Refusal& refusal = std::get<Refusal>(result);
  CHECK_FALSE(refusal.message.empty());
  return refusal.kind;
}

Fit fitted(const Model& model, const Curve& curve, const FitOptions& options = {}) {
  auto result = fit(model, curve, options);
  if (const auto* refusal = std::get_if<Refusal>(&result)) FAIL(refusal->message);
  Fit good = std::get<Fit>(std::move(result));
  CHECK_FALSE(has_nan(good));
  // A limit of the law leaves some of its parameters without any value.
  for (const Estimate& estimate : good.estimates) {
    CHECK((std::isfinite(estimate.value) || (good.limit && !estimate.has_value())));
  }
  return good;
}

const ParameterValues plain = {0.64, 0.056, 0.3, 10};

}  // namespace

TEST_CASE("every model refuses what is no curve, and survives what is a poor one") {
  for (const auto& model : all_models()) {
    INFO(model->name());
    const std::size_t n = model->parameters().size();
    CHECK(refused(*model, {}) == RefusalKind::bad_curve);
    CHECK(refused(*model, {{1, 2, 3}, {1, 2}, {}}) == RefusalKind::bad_curve);
    CHECK(refused(*model, {{1, 2, 3}, {1, nan, 2}, {}}) == RefusalKind::bad_curve);
    CHECK(refused(*model, {{1, infinity, 3}, {1, 2, 3}, {}}) == RefusalKind::bad_curve);
    for (double bad : {nan, infinity, 0.0, -1.0}) {
      CHECK(refused(*model, {{1, 2, 3}, {1, 2, 4}, {1, bad, 1}}) == RefusalKind::bad_curve);
    }
    CHECK(refused(*model, {{1}, {1}, {}}) == RefusalKind::too_few_points);
    // Many points, but at one t.
    CHECK(refused(*model, {std::vector<double>(9, 2.0), {1, 2, 3, 4, 5, 6, 7, 8, 9}, {}}) ==
          RefusalKind::too_few_points);
    Curve constant;
    for (int t = 1; t <= 50; ++t) {
      constant.t.push_back(t);
      constant.x.push_back(0.6);
    }
    CHECK(refused(*model, constant) == RefusalKind::constant_curve);
    // Two points, and as many points as parameters.
    if (n > 2) CHECK(refused(*model, {{1, 2}, {1, 2}, {}}) == RefusalKind::too_few_points);
    Curve few;
    for (std::size_t i = 1; i <= n; ++i) {
      few.t.push_back(static_cast<double>(i));
      few.x.push_back(1 + 0.1 * std::sqrt(static_cast<double>(i)));
    }
    const Fit exact = fitted(*model, few);
    CHECK(exact.dof == 0);
    CHECK_FALSE(exact.remarks.empty());
    // Pure noise, rising and falling straight lines.
    Noise noise(11);
    for (double slope : {0.0, 1.0, -1.0}) {
      Curve line;
      for (int t = 1; t <= 60; ++t) {
        line.t.push_back(t);
        line.x.push_back(100 + slope * t + 0.1 * noise());
      }
      fitted(*model, line);
    }
  }
}

TEST_CASE("refusals name the fault and its place") {
  const auto message = [](const Curve& curve, const FitOptions& options = {}) {
    return std::get<Refusal>(fit(InverseLog(), curve, options)).message;
  };
  CHECK(message({{1, 2, 3}, {1, nan, nan}, {}}) ==
        "X is not finite at 2 of 3 points, the first being number 2 (nan)");
  CHECK(message({{1, 2, 3}, {1, 2, 4}, {1, 0, 1}}) ==
        "sigma is not positive at 1 of 3 points, the first being number 2 (0)");
  CHECK(message({{1, 2, 2}, {1, 2, 4}, {}}) ==
        "3 points at 2 different t cannot determine 4 parameters: fix some, or use a wider range");
  const Curve good = sampled(InverseLog(), plain, geometric(1, 4000, 40));
  CHECK(message(good, {.fixed = {{"t0", 1}}}) ==
        "inverse_log has no parameter t0 (it has X_inf, dX, B, tau)");
  CHECK(message(good, {.fixed = {{"tau", -1}}}) == "tau = -1 is outside its range (0, inf)");
  CHECK(refused(InverseLog(), good, {.start = ParameterValues{1, 2}}) == RefusalKind::bad_options);
  CHECK(refused(InverseLog(), good, {.start = ParameterValues{1, 2, 3, nan}}) ==
        RefusalKind::bad_options);
  Curve early = good;
  early.t[0] = -1;
  CHECK(message(early) == "t must not be negative: the law starts at t = 0");
  CHECK(refused(PowerLaw(), {{0, 1, 2}, {1, 2, 3}, {}}) == RefusalKind::bad_domain);
  CHECK(refused(InverseLogHeight(), {{0, 1, 2, 3}, {1, -2, 3, 4}, {}}) == RefusalKind::bad_domain);
}

TEST_CASE("perfect data give the parameters back") {
  const std::vector<std::pair<const char*, ParameterValues>> truths = {
      {"inverse_log", plain},
      {"inverse_log_height", {13.9, 14.67, 0.8, 4}},
      {"two_exponentials", {13.5, 0.4, 8, 0.3, 400}},
      {"kww", {0.645, 0.56, 500, 0.6}},
      {"ageing", {0.5, 0.4, 20}}};
  for (const auto& [name, truth] : truths) {
    const auto model = make_model(name);
    const Fit good = fitted(*model, sampled(*model, truth, geometric(1, 4000, 60)));
    for (std::size_t j = 0; j < truth.size(); ++j) {
      INFO(name << " " << good.estimates[j].parameter.name);
      CHECK(good.estimates[j].value == Approx(truth[j]).epsilon(1e-8));
    }
  }
}

TEST_CASE("units do not matter: scaled by 1e-12 and 1e12 it is the same fit") {
  const InverseLog model;
  const Curve curve = sampled(model, plain, geometric(1, 4000, 60), 2e-4);
  const Fit unscaled = fitted(model, curve);
  for (double x_scale : {1e-12, 1.0, 1e12}) {
    for (double t_scale : {1e-12, 1.0, 1e12}) {
      Curve scaled = curve;
      for (double& x : scaled.x) x *= x_scale;
      for (double& t : scaled.t) t *= t_scale;
      const Fit scaled_fit = fitted(model, scaled);
      const double scales[] = {x_scale, x_scale, 1, t_scale};
      for (std::size_t j = 0; j < 4; ++j) {
        INFO(scaled_fit.estimates[j].parameter.name << " scaled by " << x_scale << ", " << t_scale);
        const Estimate& a = scaled_fit.estimates[j];
        const Estimate& b = unscaled.estimates[j];
        CHECK(a.value / scales[j] == Approx(b.value).epsilon(1e-7));
        CHECK(a.standard_error / scales[j] == Approx(b.standard_error).epsilon(1e-6));
        CHECK(a.intervals[1].upper / scales[j] == Approx(b.intervals[1].upper).epsilon(1e-4));
        CHECK(a.identifiability == b.identifiability);
      }
      CHECK(scaled_fit.r2 == Approx(unscaled.r2).epsilon(1e-9));
    }
  }
}

TEST_CASE("t = 0, repeated t and twelve decades of t are no trouble") {
  std::vector<double> t = geometric(1e-6, 1e6, 121);
  t.insert(t.begin(), {0, 0, 0});
  t.push_back(1);
  const ParameterValues truth = {0.645, 0.56, 50, 0.6};
  const StretchedExponential kww;
  const Fit good = fitted(kww, sampled(kww, truth, t, 2e-4));
  for (std::size_t j = 0; j < truth.size(); ++j) {
    const Estimate& estimate = good.estimates[j];
    INFO(estimate.statement);
    CHECK(std::abs(estimate.value - truth[j]) < 4 * estimate.standard_error);
  }
  const InverseLog inverse_log;
  const Fit log = fitted(inverse_log, sampled(inverse_log, plain, t, 2e-4));
  for (std::size_t j = 0; j < plain.size(); ++j) {
    CHECK(std::abs(log.estimates[j].value - plain[j]) < 4 * log.estimates[j].standard_error);
  }
}

TEST_CASE("laws at the edge of their parameters end in words, not in NaN") {
  const std::vector<double> taps = geometric(1, 4000, 60);
  const InverseLog inverse_log;
  const StretchedExponential kww;
  const std::pair<const Model*, ParameterValues> edges[] = {
      {&inverse_log, {0.64, 0.056, 1e-6, 10}},   // B -> 0
      {&inverse_log, {0.64, 0.056, 0.3, 1e-8}},  // tau -> 0
      {&inverse_log, {0.64, 0.056, 0.3, 1e7}},   // tau far beyond the range
      {&inverse_log, {0.64, 0.056, 1e6, 10}},    // a jump
      {&kww, {0.65, 0.56, 100, 0.01}},           // beta -> 0
      {&kww, {0.65, 0.56, 100, 4}},              // compressed
      {&kww, {0.65, 0.56, 1e-6, 0.5}},           // relaxed before the first point
      {&kww, {0.65, 0.56, 1e9, 0.5}}};           // hardly begun
  for (const auto& [model, truth] : edges) {
    for (double noise : {0.0, 3e-4}) {
      INFO(model->name() << " " << truth[2] << " " << truth[3] << ", noise " << noise);
      const auto result = fit(*model, sampled(*model, truth, taps, noise));
      if (const auto* refusal = std::get_if<Refusal>(&result)) {
        CHECK(refusal->kind == RefusalKind::constant_curve);
        continue;
      }
      const Fit& edge = std::get<Fit>(result);
      CHECK_FALSE(has_nan(edge));
      if (noise == 0) continue;
      // The fit is as good as the truth, for any parameters.
      CHECK(std::sqrt(edge.reduced_chi2) < 1.5 * noise);
      if (truth[3] == 4) {
        CHECK(std::abs(edge.estimates[3].value - 4) < 4 * edge.estimates[3].standard_error);
      } else {
        CHECK(std::any_of(edge.estimates.begin(), edge.estimates.end(), [](const Estimate& e) {
          return e.identifiability != Identifiability::identified;
        }));
      }
    }
  }
}

TEST_CASE("a model without values anywhere is refused by name") {
  class Nowhere final : public Model {
   public:
    std::string name() const override { return "nowhere"; }
    const std::vector<Parameter>& parameters() const override {
      static const std::vector<Parameter> list = {{.name = "a", .meaning = "nothing"}};
      return list;
    }
    double value(double, const double*) const override { return nan; }
  };
  CHECK(refused(Nowhere(), {{1, 2, 3}, {1, 2, 4}, {}}) == RefusalKind::no_start);
  CHECK(refused(Nowhere(), {{1, 2, 3}, {1, 2, 4}, {}}, {.start = ParameterValues{1}}) ==
        RefusalKind::no_start);
}

}  // namespace jostle
