#include "study/tables/laws/own_law.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <thread>

#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "study/bad_input.hpp"

using namespace jostle;

namespace {

/// A law of the papers as a user would write it, and the curve that it is tried on.
struct Rewritten {
  std::string model, formula;
  ParameterValues truth;
  double first, last;  // last of t
};

const std::vector<Rewritten>& rewritten_laws() {
  static const std::vector<Rewritten> all = {
      {"inverse_log", "X_inf - dX/(1 + B*log(1 + t/tau))", {0.64, 0.056, 0.3, 10}, 1, 1e4},
      {"inverse_log_height",
       "Z_inf*(1 + B*ln(1 + t/tau))/(Z_inf/Z_0 + B*ln(1 + t/tau))",
       {13.9, 14.67, 0.8, 4},
       1,
       1e4},
      {"kww", "rho_inf - (rho_inf - rho_0)*exp(-(t/tau)^beta)", {0.66, 0.536, 198, 0.6}, 1, 1e4},
      {"ageing", "A_inf*(1 - 1/(1 + B*log1p(t/tau)))", {0.5, 0.4, 20}, 1, 1e4},
      {"profile", "(Phi_0 - alpha*t)/(1 + exp(beta*(t - z_star)))", {0.61, 0.001, 2, 24}, 1, 30},
      {"pore_tail", "A*exp(-t/v0)", {4000, 0.03}, 0.01, 0.2},
      {"normal",
       "area/(width*sqrt(2*pi))*exp(-((t - mean)/width)^2/2)",
       {3456, 7.271, 1.255},
       3,
       12},
      {"k_gamma", "area*k^k/gamma(k)*t^(k - 1)/mean^k*exp(-k*t/mean)", {100, 0.3, 6}, 0.05, 0.9}};
  return all;
}

/// Begun 20 % beside the truth, with the bounds of the law of that name.
OwnLaw own(const Rewritten& law) {
  OwnLaw made{.formula = law.formula, .start = {}};
  const std::vector<Parameter> parameters = make_model(law.model)->parameters();
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    made.start.emplace_back(parameters[j].name, (j % 2 == 0 ? 1.2 : 0.8) * law.truth[j]);
    if (parameters[j].lower == 0) made.bounds[parameters[j].name] = {.lower = 0};
  }
  return made;
}

// Scatter without a memory, the same on every machine: 0.5 % of the law's range.
Curve measured(const Rewritten& law, std::size_t realizations) {
  const auto model = make_model(law.model);
  const std::size_t n = 60;
  const bool decades = law.last > 100 * law.first;
  std::vector<double> t, clean;
  for (std::size_t i = 0; i < n; ++i) {
    const double share = static_cast<double>(i) / (n - 1);
    t.push_back(decades ? law.first * std::pow(law.last / law.first, share)
                        : law.first + share * (law.last - law.first));
    clean.push_back(model->value(t.back(), law.truth.data()));
  }
  const auto [low, high] = std::minmax_element(clean.begin(), clean.end());
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t m = 0; m < realizations; ++m) {
      const double place = static_cast<double>(i * realizations + m);
      values.push_back(clean[i] + 0.005 * (*high - *low) * std::sin(1 + 17 * place * place));
    }
  }
  return mean_curve(t, values, realizations);
}

/// Ends in the same place, to `share` of the interval's length.
bool is_same(const Interval& a, const Interval& b, double share) {
  const auto close = [&](double x, double y) {
    if (std::isinf(x) || std::isinf(y)) return x == y;
    return std::abs(x - y) <= share * (a.closed() ? a.upper - a.lower : std::abs(x));
  };
  return close(a.lower, b.lower) && close(a.upper, b.upper);
}

std::string fault(const OwnLaw& law) {
  try {
    make_own_law(law);
    return "";
  } catch (const BadInput& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("An own law has the values and derivatives of the law that it rewrites") {
  for (const Rewritten& law : rewritten_laws()) {
    CAPTURE(law.model);
    const auto analytic = make_model(law.model);
    const auto written = make_own_law(own(law));
    const std::size_t n = law.truth.size();
    std::vector<double> a(n), b(n);
    for (double share : {0.0, 0.1, 0.3, 0.7, 1.0}) {
      const double t = law.first * std::pow(law.last / law.first, share);
      CAPTURE(t);
      const double value = analytic->value_and_gradient(t, law.truth.data(), a.data());
      CHECK(written->value(t, law.truth.data()) == Approx(value).epsilon(1e-12));
      CHECK(written->value_and_gradient(t, law.truth.data(), b.data()) ==
            Approx(value).epsilon(1e-12));
      for (std::size_t j = 0; j < n; ++j) {
        CAPTURE(analytic->parameters()[j].name);
        // Differences are rounding of the value over a step of 1e-4 of the parameter.
        const double rounding = 1e-11 * std::abs(value / law.truth[j]);
        CHECK(std::abs(a[j] - b[j]) <= 1e-9 * std::abs(a[j]) + rounding);
      }
    }
  }
}

TEST_CASE("An own law is linear where its original is, and has its units") {
  for (const Rewritten& law : rewritten_laws()) {
    if (law.model == "k_gamma") continue;  // the original describes t only by a bound
    CAPTURE(law.model);
    const auto original = make_model(law.model);
    const auto written = make_own_law(own(law));
    for (std::size_t j = 0; j < law.truth.size(); ++j) {
      const Parameter& a = original->parameters()[j];
      const Parameter& b = written->parameters()[j];
      CAPTURE(a.name);
      CHECK(a.name == b.name);
      CHECK(a.linear == b.linear);
      if (law.model != "profile" || a.name != "beta") CHECK(a.unit == b.unit);
    }
  }
}

TEST_CASE("An own law gives the parameters, intervals and words of the law that it rewrites") {
  for (const std::size_t realizations : {std::size_t{1}, std::size_t{3}}) {
    for (const Rewritten& law : rewritten_laws()) {
      CAPTURE(law.model, realizations);
      const Curve curve = measured(law, realizations);
      const Fit a = std::get<Fit>(fit(*make_model(law.model), curve));
      const Fit b = std::get<Fit>(fit(*make_own_law(own(law)), curve));
      REQUIRE(is_minimum(a.reason));
      CHECK(is_minimum(b.reason));
      CHECK(b.residual_sum == Approx(a.residual_sum).epsilon(1e-10));
      for (std::size_t j = 0; j < a.estimates.size(); ++j) {
        const Estimate &x = a.estimates[j], &y = b.estimates[j];
        CAPTURE(x.parameter.name, x.value, y.value, x.standard_error);
        // The solver stops where steps no longer matter beside the errors.
        CHECK(std::abs(x.value - y.value) <= 1e-8 * std::abs(x.value) + 1e-6 * x.standard_error);
        CHECK(y.standard_error == Approx(x.standard_error).epsilon(1e-6));
        CHECK(y.error == Approx(x.error).epsilon(1e-6));
        for (int level : {0, 1}) {
          CAPTURE(level, x.intervals[level].lower, x.intervals[level].upper,
                  y.intervals[level].lower, y.intervals[level].upper);
          CHECK(is_same(x.intervals[level], y.intervals[level], 1e-5));
        }
        CHECK(x.identifiability == y.identifiability);
      }
    }
  }
}

TEST_CASE("A formula is read as docs/reference/laws.md defines") {
  const double p[] = {2.0, 3.0};
  const std::pair<const char*, double> values[] = {
      {"-t^2 + 0*(a + b)", -25},  {"a^b^2 + 0*t", 512}, {"ln(exp(b)) + log(1) + 0*(a + t)", 3},
      {"t < a ? a : b", 3},       {"t > a ? a : b", 2}, {"1e1*a + .5E+1*b + pi*0*t", 35},
      {"b*cbrt(8)*abs(-t)/a", 15}};
  for (const auto& [formula, value] : values) {
    CAPTURE(formula);
    CHECK(make_own_law({.formula = formula, .start = {{"a", 1}, {"b", 1}}})->value(5, p) ==
          Approx(value));
  }
}

TEST_CASE("A law of the user's own is fitted from its start") {
  Curve curve;
  for (int i = 0; i < 80; ++i) {
    const double t = std::pow(1.12, i);
    curve.t.push_back(t);
    curve.x.push_back(0.58 + 0.01 * std::log(1 + t / 10) + 1e-4 * std::sin(1 + 17.0 * i * i));
  }
  const OwnLaw law{.formula = "X0 + a*log(1 + t/tau)",
                   .start = {{"X0", 0.5}, {"a", 0.02}, {"tau", 3}},
                   .bounds = {{"tau", {.lower = 0}}}};
  const Fit found = std::get<Fit>(fit(*make_own_law(law), curve));
  CHECK(found.model == "own");
  CHECK(found.formula == law.formula);
  CHECK(std::abs(found.estimates[0].value - 0.58) < 4 * found.estimates[0].error);
  CHECK(std::abs(found.estimates[1].value - 0.01) < 4 * found.estimates[1].error);
  CHECK(std::abs(found.estimates[2].value - 10) < 4 * found.estimates[2].error);
  for (const Estimate& estimate : found.estimates) CHECK(estimate.intervals[1].closed());
  // Without the bound the minimum is the same one.
  OwnLaw unbounded = law;
  unbounded.bounds.clear();
  const Fit repeated = std::get<Fit>(fit(*make_own_law(unbounded), curve));
  CHECK(repeated.estimates[2].value == Approx(found.estimates[2].value).epsilon(1e-7));
}

TEST_CASE("Units of a formula do not depend on the start") {
  struct Formula {
    std::string text;
    std::vector<ParameterUnit> units;
  };
  using enum ParameterUnit;
  const std::vector<Formula> all = {{"a*sin(t/b)+c", {value, time, value}},
                                    {"a + b*exp(-t/c)*cos(t)", {value, value, none}},
                                    {"a*sqrt(-b*t) + c", {none, none, none}},
                                    {"t < b ? a : c", {value, time, value}},
                                    {"a + c*((t > b) + 0.5)", {value, time, value}},
                                    {"a + c*t^b", {value, none, value}}};
  for (const Formula& formula : all) {
    for (const double size : {1e-4, 0.3, 20.0, -7.0, 4000.0}) {
      CAPTURE(formula.text, size);
      const auto law = make_own_law(
          {.formula = formula.text, .start = {{"a", size}, {"b", 3 * size}, {"c", size / 7}}});
      for (std::size_t j = 0; j < 3; ++j) CHECK(law->parameters()[j].unit == formula.units[j]);
    }
  }
}

TEST_CASE("A parameter whose unit the formula leaves open has this in its meaning") {
  const auto open = make_own_law({.formula = "a*exp(-b*t)*cos(t)", .start = {{"a", 1}, {"b", 2}}});
  CHECK(open->parameters()[1].meaning == "begun at 2 (the formula does not determine its unit)");
  const auto known = make_own_law({.formula = "a*exp(-b*t)", .start = {{"a", 1}, {"b", 2}}});
  CHECK(known->parameters()[1].meaning == "begun at 2");
}

TEST_CASE("Fits of an own law from two starts have equal verdicts") {
  Curve curve;
  for (int k = 0; k < 60; ++k) {
    curve.t.push_back(0.5 * k);
    curve.x.push_back(2 + std::sin(0.5 * k / 3.0) + 0.1 * std::sin(1 + 17.0 * k * k));
  }
  const auto fit_begun = [&](double a, double time, double b) {
    const auto law =
        make_own_law({.formula = "a*sin(t/t0)+b", .start = {{"a", a}, {"t0", time}, {"b", b}}});
    return std::get<Fit>(fit(*law, curve));
  };
  const Fit first = fit_begun(1, 1, 0), second = fit_begun(0.5, 3.2, 1.9);
  REQUIRE(first.residual_sum == Approx(second.residual_sum).epsilon(1e-6));
  for (std::size_t j = 0; j < 3; ++j) {
    CAPTURE(first.estimates[j].statement, second.estimates[j].statement);
    CHECK(first.estimates[j].identifiability == second.estimates[j].identifiability);
    CHECK(first.estimates[j].parameter.unit == second.estimates[j].parameter.unit);
  }
}

TEST_CASE("A slope is wide where its interval holds 0") {
  const auto line = make_own_law({.formula = "X0 + r*t", .start = {{"X0", 1}, {"r", 0.1}}});
  const auto slope_of = [&](double slope) {
    Curve curve;
    for (int k = 0; k < 40; ++k) {
      curve.t.push_back(k);
      curve.x.push_back(1 + slope * k + 0.1 * std::sin(2.4 * k));
    }
    return std::get<Fit>(fit(*line, curve)).estimates[1];
  };
  const Estimate flat = slope_of(0), rising = slope_of(0.01);
  REQUIRE(flat.intervals[1].lower < 0);
  REQUIRE(flat.intervals[1].upper > 0);
  CHECK(flat.identifiability == Identifiability::wide);
  REQUIRE(rising.intervals[1].lower > 0);
  CHECK(rising.identifiability == Identifiability::identified);
}

TEST_CASE("An own law that is not finite where it starts is refused with the t") {
  const Curve curve{.t = {0, 1, 2, 3}, .x = {1, 2, 4, 5}};
  const auto result = fit(*make_own_law({.formula = "a*log(t)", .start = {{"a", 1}}}), curve);
  const auto* refusal = std::get_if<Refusal>(&result);
  REQUIRE(refusal != nullptr);
  CHECK(refusal->kind == RefusalKind::bad_domain);
  CHECK(refusal->message.find("not finite where it starts, at t = 0") != std::string::npos);
}

TEST_CASE("Threads evaluate one own law each for themselves") {
  const auto law = make_own_law({.formula = "a + b*t", .start = {{"a", 1}, {"b", 1}}});
  const auto two = make_own_law({.formula = "a - b*t", .start = {{"a", 1}, {"b", 1}}});
  std::vector<int> wrong(4, 0);
  std::vector<std::thread> threads;
  for (std::size_t number = 0; number < wrong.size(); ++number) {
    threads.emplace_back([&, number] {
      const double p[] = {static_cast<double>(number), 2};
      for (int t = 0; t < 2000; ++t) {
        // Each law several times in turn, so that parsers are kept and replaced.
        const bool rising = t / 50 % 2 == 0;
        const double expected = rising ? p[0] + 2 * t : p[0] - 2 * t;
        if ((rising ? *law : *two).value(t, p) != expected) ++wrong[number];
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(wrong == std::vector<int>(4, 0));
}

TEST_CASE("All faults of an own law are reported") {
  struct Bad {
    OwnLaw law;
    std::string says;
  };
  const std::vector<Bad> all = {
      {{.formula = "a*lgo(t)", .start = {{"a", 1}}}, "there is no function lgo; there are abs, "},
      {{.formula = "a*log(t/tau)", .start = {{"a", 1}}}, "the parameter tau has no start"},
      {{.formula = "a + b*log(1 + t/tau)", .start = {}},
       "the parameters a, b, tau have no start: give values, as a=1,b=1,tau=1, from which"},
      {{.formula = "a + b", .start = {{"a", 1}, {"b", 1}}}, "there is no t in it"},
      {{.formula = "a+b*", .start = {{"a", 1}, {"b", 1}}}, "a+b* cannot be read: Unexpected end"},
      {{.formula = "a + b*log(t", .start = {}}, "cannot be read"},
      {{.formula = "log(t)", .start = {}}, "it has no parameter to fit"},
      {{.formula = "a*t + (", .start = {{"a", 1}}}, "cannot be read"},
      {{.formula = "2t + a", .start = {{"a", 1}}}, "cannot be read"},
      {{.formula = "X = a*t", .start = {{"X", 1}, {"a", 1}}}, "without \"X =\""},
      {{.formula = "a*t, a", .start = {{"a", 1}}}, "comma outside a function"},
      {{.formula = "a*t", .start = {{"a", 1}, {"a", 2}}}, "a has two starts"},
      {{.formula = "a*t", .start = {{"a", 1}, {"t", 2}}}, "no parameter can be called t"},
      {{.formula = "a*t*pi", .start = {{"a", 1}, {"pi", 2}}}, "no parameter can be called pi"},
      {{.formula = "a*t*exp", .start = {{"a", 1}}},
       "exp needs parentheses with its argument: exp(...)"},
      {{.formula = "exp*t", .start = {{"exp", 1}}}, "no parameter can be called exp"},
      {{.formula = "tau (1 + t)", .start = {{"tau", 1}}}, "a product needs a *"},
      {{.formula = "a*t", .start = {{"a", 1}, {"b", 2}}}, "b has a start, but is not in the law"},
      {{.formula = "a*t", .start = {{"a b", 1}}}, "is no name of a parameter"},
      {{.formula = "a*t", .start = {{"a", NAN}}}, "the start of a is not finite"},
      {{.formula = "a*t", .start = {{"a", 1}}, .bounds = {{"a", {2, 3}}}},
       "not between its bounds"},
      {{.formula = "a*t", .start = {{"a", 1}}, .bounds = {{"c", {2, 3}}}}, "c has bounds, but no"},
      {{.name = "kww", .formula = "a*t", .start = {{"a", 1}}},
       "cannot be called \"kww\": docs/reference/laws.md uses this name"},
      {{.name = "a/b", .formula = "a*t", .start = {{"a", 1}}},
       "cannot be called \"a/b\": a name has letters"}};
  for (const Bad& bad : all) {
    const std::string said = fault(bad.law);
    CAPTURE(bad.law.formula, said);
    CHECK(said.find(bad.says) != std::string::npos);
  }
  CHECK(fault({.formula = "a + b*t", .start = {}}).find("no parameter") == std::string::npos);
  CHECK(fault({.formula = "a+b*", .start = {{"a", 1}}}).find("no t") == std::string::npos);
  const std::string message = fault({.formula = "foo(x)", .start = {}});
  CHECK(message.find("foo") != std::string::npos);
  CHECK(message.find("parameter x") != std::string::npos);
  CHECK(message.find("no t") != std::string::npos);
  CHECK(fault({.formula = "a*t^2 + 1e-3*exp(-t/2.5E2)", .start = {{"a", 1}}}).empty());
}

TEST_CASE("A law whose parameter is lost in noise has no remark of exchanged parameters") {
  const auto law = make_own_law({.formula = "X0 + a*t", .start = {{"X0", 1}, {"a", 1}}});
  Curve curve{.t = {}, .x = {}, .sigma = {}};
  for (int t = 1; t <= 12; ++t) {
    curve.t.push_back(t);
    curve.x.push_back(t + 2 * std::sin(7.0 * t * t));
  }
  const Fit fitted = std::get<Fit>(fit(*law, curve));
  CHECK(fitted.condition < 100);
  bool says_noise = false;
  for (const std::string& remark : fitted.remarks) {
    CHECK(remark.find("not unique") == std::string::npos);
    says_noise |= remark.find("The data hardly constrain X0") == 0;
  }
  CHECK(says_noise);
}
