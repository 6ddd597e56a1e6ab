#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "fitting/models/models.hpp"

namespace jostle {
namespace {

using Long = long double;
/// A law of the papers, written down once more.
using Formula = std::function<Long(Long t, const std::vector<Long>& p)>;

struct Example {
  Formula formula;
  std::vector<ParameterValues> parameters;
  std::vector<double> t;
};

const std::vector<double> taps = {0, 1, 2, 5, 30, 400, 4000, 1e5};
const std::vector<double> heights = {0.3, 2, 5, 11, 19, 22, 24.5, 30};

Long inverse_log(Long t, const std::vector<Long>& p) {
  return p[0] - p[1] / (1 + p[2] * std::log(1 + t / p[3]));
}

const std::map<std::string, Example>& examples() {
  static const std::map<std::string, Example> all = {
      {"inverse_log",
       {inverse_log,
        {{0.64, 0.056, 0.3, 10}, {0.66, 0.076, 0.06, 15}, {0.6, -0.1, 30, 1e-3}},
        taps}},
      {"inverse_log_height",
       {[](Long t, const std::vector<Long>& p) {
          return 1 / inverse_log(t, {1 / p[0], 1 / p[0] - 1 / p[1], p[2], p[3]});
        },
        {{13.9, 14.67, 0.8, 4}, {10, 12, 0.05, 300}},
        taps}},
      {"two_exponentials",
       {[](Long t, const std::vector<Long>& p) {
          return p[0] + p[1] * std::exp(-t / p[2]) + p[3] * std::exp(-t / p[4]);
        },
        {{14, 0.4, 8, 0.3, 900}},
        taps}},
      {"kww",
       {[](Long t, const std::vector<Long>& p) {
          return p[0] - (p[0] - p[1]) * std::exp(-std::pow(t / p[2], p[3]));
        },
        {{0.66, 0.536, 1985, 0.2588}, {0.645, 0.56, 500, 1.7}},
        taps}},
      {"ageing",
       {[](Long t, const std::vector<Long>& p) {
          return p[0] * (1 - 1 / (1 + p[1] * std::log(1 + t / p[2])));
        },
        {{0.5, 0.4, 20}, {2e-4, 3, 0.5}},
        taps}},
      {"profile",
       {[](Long z, const std::vector<Long>& p) {
          return (p[0] - p[1] * z) / (1 + std::exp(p[2] * (z - p[3])));
        },
        {{0.61, 0.001, 2, 24}, {0.58, -0.002, 0.7, 21}},
        heights}},
      {"pore_tail",
       {[](Long v, const std::vector<Long>& p) { return p[0] * std::exp(-v / p[1]); },
        {{4000, 0.03}},
        {0, 0.01, 0.05, 0.2, 0.6}}},
      {"power_law",
       {[](Long f, const std::vector<Long>& p) { return p[0] * std::pow(f, -p[1]); },
        {{1e-7, 1.3}, {2, -0.4}},
        {1e-4, 3e-3, 0.1, 0.5}}},
      {"normal",
       {[](Long x, const std::vector<Long>& p) {
          const Long u = (x - p[1]) / p[2];
          return p[0] / (p[2] * std::sqrt(2 * std::acos(Long(-1)))) * std::exp(-u * u / 2);
        },
        {{3456, 7.271, 1.255}},
        {1, 3, 5, 7, 7.5, 9, 12}}},
      {"k_gamma",
       {[](Long x, const std::vector<Long>& p) {
          const Long k = p[2];
          return p[0] * std::exp(k * std::log(k / p[1]) + (k - 1) * std::log(x) - k * x / p[1] -
                                 std::lgamma(k));
        },
        {{1, 0.25, 12.6}, {3, 2, 0.4}, {1, 0.4, 30}},
        {0.01, 0.1, 0.2, 0.3, 0.7, 1.5}}}};
  return all;
}

// Central differences of the formula in long double, good to about 12 digits.
Long derivative(const Formula& formula, double t, const ParameterValues& p, std::size_t j) {
  const Long h = 1e-6L * std::max(std::abs(p[j]), 1e-3);
  const auto value_at = [&](Long steps) {
    std::vector<Long> moved(p.begin(), p.end());
    moved[j] += steps * h;
    return formula(t, moved);
  };
  return (8 * (value_at(1) - value_at(-1)) - (value_at(2) - value_at(-2))) / (12 * h);
}

}  // namespace

TEST_CASE("values and gradients of every model agree with the formula in long double") {
  CHECK(all_models().size() == examples().size());
  for (const auto& model : all_models()) {
    const Example& example = examples().at(model->name());
    const std::size_t n = model->parameters().size();
    for (const ParameterValues& p : example.parameters) {
      REQUIRE(p.size() == n);
      for (double t : example.t) {
        std::vector<double> gradient(n);
        const double value = model->value_and_gradient(t, p.data(), gradient.data());
        const auto exact =
            static_cast<double>(example.formula(t, std::vector<Long>(p.begin(), p.end())));
        INFO(model->name() << " at t = " << t);
        CHECK(value == Approx(exact).epsilon(1e-13).margin(1e-300));
        CHECK(model->value(t, p.data()) == Approx(exact).epsilon(1e-13).margin(1e-300));
        for (std::size_t j = 0; j < n; ++j) {
          INFO("by " << model->parameters()[j].name);
          const auto slope = static_cast<double>(derivative(example.formula, t, p, j));
          const double scale = std::abs(value / p[j]);
          CHECK(gradient[j] == Approx(slope).epsilon(1e-9).margin(1e-10 * scale));
        }
      }
    }
  }
}

TEST_CASE("differences taken for a user's model agree with the analytic gradients") {
  for (const auto& model : all_models()) {
    const Example& example = examples().at(model->name());
    const std::size_t n = model->parameters().size();
    for (const ParameterValues& p : example.parameters) {
      for (double t : example.t) {
        std::vector<double> analytic(n), numerical(n);
        const double value = model->value_and_gradient(t, p.data(), analytic.data());
        CHECK(model->Model::value_and_gradient(t, p.data(), numerical.data()) ==
              Approx(value).epsilon(1e-14).margin(1e-300));
        for (std::size_t j = 0; j < n; ++j) {
          INFO(model->name() << " at t = " << t << " by " << model->parameters()[j].name);
          const double scale = std::abs(value / p[j]);
          CHECK(numerical[j] == Approx(analytic[j]).epsilon(1e-8).margin(1e-10 * scale));
        }
      }
    }
  }
}

TEST_CASE("models are found by name, and name their parameters and source") {
  for (const auto& model : all_models()) {
    REQUIRE(make_model(model->name()));
    CHECK(make_model(model->name())->formula() == model->formula());
    CHECK_FALSE(model->source().empty());
    for (const Parameter& parameter : model->parameters()) {
      CHECK_FALSE(parameter.name.empty());
      CHECK_FALSE(parameter.meaning.empty());
      CHECK(parameter.lower < parameter.upper);
    }
  }
  CHECK_FALSE(make_model("inverse log"));
}

}  // namespace jostle
