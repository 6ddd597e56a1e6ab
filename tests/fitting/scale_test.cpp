#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "tests/fitting/noise.hpp"

namespace jostle {
namespace {

enum class Errors { unknown, given, realizations };

struct Example {
  ParameterValues truth;  // curves of sizes in [1, 2)
  std::vector<double> t;
};

std::vector<double> ramp(double first, double step, int n) {
  std::vector<double> t;
  for (int i = 0; i < n; ++i) t.push_back(first + i * step);
  return t;
}

const std::map<std::string, Example>& examples() {
  static const std::map<std::string, Example> all = {
      {"inverse_log", {{1.8, 0.7, 0.8, 10}, geometric(1, 1e4, 60)}},
      {"inverse_log_height", {{1.2, 1.9, 0.8, 10}, geometric(1, 1e4, 60)}},
      {"two_exponentials", {{1.1, 0.4, 8, 0.3, 300}, geometric(1, 1024, 60)}},
      {"kww", {{1.6, 1.1, 200, 0.6}, geometric(1, 1e4, 60)}},
      {"ageing", {{2.2, 0.6, 12}, geometric(1, 1000, 60)}},
      {"profile", {{1.7, 0.02, 2, 24}, ramp(0.5, 0.5, 60)}},
      {"pore_tail", {{1.9, 17}, ramp(1, 1, 60)}},
      {"power_law", {{1.5, 0.6}, geometric(1, 100, 60)}},
      {"normal", {{6, 14, 1.6}, ramp(8, 0.25, 60)}},
      {"k_gamma", {{5, 2.5, 8}, ramp(0.25, 0.125, 60)}}};
  return all;
}

/// The curve of the law with noise of 0.01 or 1 %, its values times `x`, its times times `t`.
Curve noisy(const Model& model, Errors errors, double x, double t) {
  const Example& example = examples().at(model.name());
  const std::size_t n = errors == Errors::realizations ? 4 : 1;
  Noise noise(2024);
  std::vector<double> times, values;
  for (const double time : example.t) {
    times.push_back(time * t);
    const double value = model.value(time, example.truth.data());
    const double sigma = model.residual_scale() == ResidualScale::linear ? 0.01 : 0.01 * value;
    for (std::size_t r = 0; r < n; ++r) values.push_back(x * (value + sigma * noise()));
  }
  Curve curve = mean_curve(std::move(times), std::move(values), n);
  if (errors == Errors::given) curve.sigma.assign(curve.t.size(), 0.01 * x);
  return curve;
}

double size_of(ParameterUnit unit, double x, double t) {
  switch (unit) {
    case ParameterUnit::none:
      return 1;
    case ParameterUnit::value:
      return x;
    case ParameterUnit::time:
      return t;
    case ParameterUnit::value_per_time:
      return x / t;
    case ParameterUnit::value_time:
      return x * t;
    case ParameterUnit::per_time:
      return 1 / t;
  }
  return 1;
}

constexpr double digits = 1e-9;

void check_equal(double scaled, double plain) {
  if (scaled == plain) return;  // infinite ones too
  CHECK(scaled == Approx(plain).epsilon(digits));
}

void check_estimates(const std::vector<Estimate>& scaled, const std::vector<Estimate>& plain,
                     double x, double t) {
  REQUIRE(scaled.size() == plain.size());
  for (std::size_t j = 0; j < plain.size(); ++j) {
    CAPTURE(plain[j].parameter.name, plain[j].statement);
    const double size = size_of(plain[j].parameter.unit, x, t);
    check_equal(scaled[j].value / size, plain[j].value);
    check_equal(scaled[j].error / size, plain[j].error);
    check_equal(scaled[j].standard_error / size, plain[j].standard_error);
    for (int level = 0; level < 2; ++level) {
      check_equal(scaled[j].intervals[level].lower / size, plain[j].intervals[level].lower);
      check_equal(scaled[j].intervals[level].upper / size, plain[j].intervals[level].upper);
    }
    CHECK(scaled[j].identifiability == plain[j].identifiability);
  }
}

void check_fits(const Fit& scaled, const Fit& plain, double x, double t) {
  const double squared = plain.sigma_given || plain.logarithmic ? 1 : x * x;
  check_equal(scaled.residual_sum / squared, plain.residual_sum);
  check_equal(scaled.r2, plain.r2);
  check_equal(scaled.condition, plain.condition);
  check_equal(scaled.effective_size, plain.effective_size);
  CHECK(is_minimum(scaled.reason) == is_minimum(plain.reason));
  check_estimates(scaled.estimates, plain.estimates, x, t);
  check_estimates(scaled.combinations, plain.combinations, x, t);
  REQUIRE(scaled.restated.has_value() == plain.restated.has_value());
  if (plain.restated) check_estimates(scaled.restated->estimates, plain.restated->estimates, x, t);
  REQUIRE(scaled.limit.has_value() == plain.limit.has_value());
  if (plain.limit) check_estimates(scaled.limit->estimates, plain.limit->estimates, x, t);
  const auto n = static_cast<std::size_t>(plain.covariance.rows());
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
      const double size = size_of(plain.estimates[i].parameter.unit, x, t) *
                          size_of(plain.estimates[j].parameter.unit, x, t);
      check_equal(scaled.covariance(row, column) / size, plain.covariance(row, column));
      check_equal(scaled.correlation(row, column), plain.correlation(row, column));
    }
  }
  CHECK(scaled.remarks == plain.remarks);
}

}  // namespace

TEST_CASE("a fit does not depend on the size of the values") {
  for (const auto& model : all_models()) {
    for (const Errors errors : {Errors::unknown, Errors::given, Errors::realizations}) {
      const Fit plain = std::get<Fit>(fit(*model, noisy(*model, errors, 1, 1)));
      for (const double x : {0x1p-100, 0x1p-300, 0x1p-390, 0x1p+300, 0x1p+397}) {
        CAPTURE(model->name(), static_cast<int>(errors), x);
        check_fits(std::get<Fit>(fit(*model, noisy(*model, errors, x, 1))), plain, x, 1);
      }
    }
  }
}

TEST_CASE("a fit does not depend on the size of the times") {
  for (const auto& model : all_models()) {
    if (model->name() == "power_law") continue;  // its A is the value at t = 1
    for (const Errors errors : {Errors::unknown, Errors::given, Errors::realizations}) {
      const Fit plain = std::get<Fit>(fit(*model, noisy(*model, errors, 1, 1)));
      for (const double t : {0x1p-100, 0x1p+100}) {
        CAPTURE(model->name(), static_cast<int>(errors), t);
        check_fits(std::get<Fit>(fit(*model, noisy(*model, errors, 1, t))), plain, 1, t);
      }
    }
  }
}

}  // namespace jostle
