#include "fitting/models/limit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fitting/models/models.hpp"

namespace jostle::inline fitting {

namespace {

// Terms of a law that is linear in all its parameters but theta, with their slopes by theta.
using Terms = void (*)(double t, double theta, double* terms, double* slopes);

enum class From { zero, above_zero };  // times at which a law has a value

class LimitLaw final : public PublishedLaw {
 public:
  LimitLaw(std::string name, std::string formula, std::vector<Parameter> parameters, Terms terms,
           From domain = From::zero)
      : PublishedLaw(std::move(name), std::move(formula), "", std::move(parameters)),
        terms_(terms),
        domain_(domain),
        n_linear_(static_cast<std::size_t>(
            std::count_if(this->parameters().begin(), this->parameters().end(),
                          [](const Parameter& p) { return p.linear; }))) {}

  double value(double t, const double* p) const override {
    double gradient[5];
    return value_and_gradient(t, p, gradient);
  }
  double value_and_gradient(double t, const double* p, double* gradient) const override {
    double slopes[4] = {0, 0, 0, 0};
    const bool bent = n_linear_ < parameters().size();
    terms_(t, bent ? p[n_linear_] : 1, gradient, slopes);
    double value = 0, slope = 0;
    for (std::size_t k = 0; k < n_linear_; ++k) {
      value += p[k] * gradient[k];
      slope += p[k] * slopes[k];
    }
    if (bent) gradient[n_linear_] = slope;
    return value;
  }
  std::string refusal(const Curve& curve) const override {
    const double first = *std::min_element(curve.t.begin(), curve.t.end());
    return first > 0 || (first == 0 && domain_ == From::zero) ? "" : "t must be positive";
  }
  std::vector<std::vector<double>> candidates(const Curve& curve) const override {
    std::vector<std::vector<double>> all(parameters().size());
    if (n_linear_ == parameters().size()) return all;
    double first = std::numeric_limits<double>::infinity(), last = 0;
    for (const double t : curve.t) {
      if (t > 0) first = std::min(first, t);
      last = std::max(last, t);
    }
    if (!(last > 0)) first = last = 1;
    switch (parameters().back().unit) {
      case ParameterUnit::time:
        all.back() = geometric(0.01 * first, 100 * last, 36);
        break;
      case ParameterUnit::per_time:
        all.back() = geometric(0.01 / last, 100 / first, 36);
        break;
      default:
        all.back() = geometric(0.02, 20, 24);
    }
    return all;
  }

 private:
  Terms terms_;
  From domain_;
  std::size_t n_linear_;
};

Parameter level(const std::string& name, const char* meaning) {
  return {.name = name, .meaning = meaning, .unit = ParameterUnit::value, .linear = true};
}

Parameter factor(const char* name, const char* meaning) {
  Parameter of_power = level(name, meaning);
  of_power.of_power = true;
  return of_power;
}

Parameter slope(const char* name, const char* meaning) {
  return {.name = name, .meaning = meaning, .unit = ParameterUnit::value_per_time, .linear = true};
}

Parameter bent(const char* name, const char* meaning, ParameterUnit unit) {
  return {.name = name, .meaning = meaning, .unit = unit, .lower = 0};
}

const Parameter rate = bent("B/tau", "growth per tap at first", ParameterUnit::per_time);
const Parameter onset = bent("tau", "taps before the logarithm sets in", ParameterUnit::time);
Parameter final_value(const std::string& name) {
  return level(name, "value after infinitely many taps");
}

Parameter first_value(const std::string& name) {
  return level(name, "value before the first tap");
}

std::shared_ptr<const Model> hyperbola() {
  return std::make_shared<LimitLaw>(
      "hyperbola", "X_inf - dX / (1 + (B/tau) t)",
      std::vector<Parameter>{final_value("X_inf"), level("dX", "X_inf - X(0)"), rate},
      [](double t, double c, double* terms, double* slopes) {
        const double left = 1 / (1 + c * t);
        terms[0] = 1;
        terms[1] = -left;
        slopes[1] = t * left * left;
      });
}

std::shared_ptr<const Model> logarithm(const std::string& start) {
  return std::make_shared<LimitLaw>(
      "logarithm", start + " + (dX B) ln(1 + t/tau)",
      std::vector<Parameter>{first_value(start), level("dX B", "growth per unit of the logarithm"),
                             onset},
      [](double t, double tau, double* terms, double* slopes) {
        terms[0] = 1;
        terms[1] = std::log1p(t / tau);
        slopes[1] = -(t / tau) / (tau + t);
      });
}

std::shared_ptr<const Model> reciprocal_logarithm(const std::string& end) {
  return std::make_shared<LimitLaw>(
      "reciprocal_logarithm", end + " - (dX/B) / ln(1 + t/tau)",
      std::vector<Parameter>{final_value(end),
                             level("dX/B", "distance from X_inf times the logarithm"), onset},
      [](double t, double tau, double* terms, double* slopes) {
        const double log = std::log1p(t / tau);
        terms[0] = 1;
        terms[1] = -1 / log;
        slopes[1] = -(t / tau) / (tau + t) / (log * log);
      },
      From::above_zero);
}

std::shared_ptr<const Model> line_in_log(const char* at_one, const char* per_log) {
  return std::make_shared<LimitLaw>(
      "line_in_ln_t", std::string(at_one) + " + (" + per_log + ") ln t",
      std::vector<Parameter>{level(at_one, "value at t = 1"),
                             level(per_log, "growth per unit of ln t")},
      [](double t, double, double* terms, double*) {
        terms[0] = 1;
        terms[1] = std::log(t);
      },
      From::above_zero);
}

std::shared_ptr<const Model> line(const std::string& start) {
  return std::make_shared<LimitLaw>(
      "line", start + " + r t",
      std::vector<Parameter>{first_value(start), slope("r", "growth per tap")},
      [](double t, double, double* terms, double*) {
        terms[0] = 1;
        terms[1] = t;
      });
}

std::shared_ptr<const Model> reciprocal(const std::string& end) {
  return std::make_shared<LimitLaw>(
      "reciprocal", end + " - (dX tau/B) / t",
      std::vector<Parameter>{final_value(end),
                             {.name = "dX tau/B",
                              .meaning = "distance from X_inf times t",
                              .unit = ParameterUnit::value_time,
                              .linear = true}},
      [](double t, double, double* terms, double*) {
        terms[0] = 1;
        terms[1] = -1 / t;
      },
      From::above_zero);
}

// X_inf - dX / (1 + B u) = X(0) + dX B u / (1 + B u), u = ln(1 + t/tau).
std::vector<Limit> limits_of_inverse_log(const std::string& end, const std::string& start) {
  return {
      {line(start),
       "the logarithm has not set in and the change has hardly begun (tau and dX grow)",
       [](const ParameterValues& p, double k, double, double last) {
         const double tau = k * last, change = p[1] * tau;
         return ParameterValues{p[0] + change, change, 1, tau};
       }},
      {line_in_log("X(1)", "dX B"), "X is linear in ln t (tau and B go to 0, X_inf to infinity)",
       [](const ParameterValues& p, double k, double first, double last) {
         const double tau = first / k, b = 1 / (k * std::log(last / tau)), change = p[1] / b;
         return ParameterValues{p[0] + p[1] * std::log(tau) + change, change, b, tau};
       }},
      {reciprocal(end), "X approaches X_inf as 1/t (B, tau and dX grow together)",
       [](const ParameterValues& p, double k, double first, double last) {
         const double tau = k * last, c = k / first;
         return ParameterValues{p[0], p[1] * c, c * tau, tau};
       }},
      {hyperbola(), "the logarithm has not set in (B and tau grow together)",
       [](const ParameterValues& p, double k, double, double last) {
         const double tau = k * last;
         return ParameterValues{p[0], p[1], p[2] * tau, tau};
       }},
      {logarithm(start), "no end of the logarithm is in sight (B goes to 0, X_inf to infinity)",
       [](const ParameterValues& p, double k, double, double last) {
         const double b = 1 / (k * std::log1p(last / p[2])), change = p[1] / b;
         return ParameterValues{p[0] + change, change, b, p[2]};
       }},
      {reciprocal_logarithm(end), "X approaches X_inf as 1/ln(1 + t/tau) (B and dX grow together)",
       [](const ParameterValues& p, double k, double first, double) {
         const double b = k / std::log1p(first / p[2]);
         return ParameterValues{p[0], p[1] * b, b, p[2]};
       }}};
}

}  // namespace

std::vector<Limit> InverseLog::limits() const {
  return limits_of_inverse_log("X_inf", "X(0)");
}

// Those of eq. 3, with the parameters that eq. 4 has too under its names.
std::vector<Limit> InverseLogHeight::limits() const {
  const InverseLog law;
  std::vector<Limit> limits;
  for (Limit& limit : limits_of_inverse_log("Z_inf", "Z_0")) {
    limit.near = [near = limit.near, restate = law.equivalent()->restate](
                     const ParameterValues& p, double k, double first, double last) {
      return restate(near(p, k, first, last));
    };
    limits.push_back(std::move(limit));
  }
  Limit& bend = limits[3];
  bend.law = std::make_shared<LimitLaw>(
      "hyperbola", "Z_inf - (Z_inf - Z_0) / (1 + r t)",
      std::vector<Parameter>{level("Z_inf", "mean height after infinitely many taps"),
                             level("Z_0", "mean height before the first tap"),
                             bent("r", "B Z_0 / (Z_inf tau)", ParameterUnit::per_time)},
      [](double t, double c, double* terms, double* slopes) {
        const double left = 1 / (1 + c * t);
        terms[0] = 1 - left;
        terms[1] = left;
        slopes[0] = t * left * left;
        slopes[1] = -slopes[0];
      });
  bend.near = [](const ParameterValues& p, double k, double, double last) {
    const double tau = k * last;
    return ParameterValues{p[0], p[1], p[2] * tau * p[0] / p[1], tau};
  };
  return limits;
}

std::vector<Limit> Ageing::limits() const {
  return {
      {std::make_shared<LimitLaw>("line_through_0", "r t",
                                  std::vector<Parameter>{slope("r", "growth per unit of time")},
                                  [](double t, double, double* terms, double*) { terms[0] = t; }),
       "the logarithm has not set in and the growth has hardly begun (tau and A_inf grow)",
       [](const ParameterValues& p, double k, double, double last) {
         return ParameterValues{p[0] * k * last, 1, k * last};
       }},
      {std::make_shared<LimitLaw>(
           "saturation", "A_inf (1 - 1 / (1 + (B/tau) t))",
           std::vector<Parameter>{
               level("A_inf", "value at infinite lag"),
               bent("B/tau", "growth per unit of time at first", ParameterUnit::per_time)},
           [](double t, double c, double* terms, double* slopes) {
             const double left = 1 / (1 + c * t);
             terms[0] = c * t * left;
             slopes[0] = t * left * left;
           }),
       "the logarithm has not set in (B and tau grow together)",
       [](const ParameterValues& p, double k, double, double last) {
         return ParameterValues{p[0], p[1] * k * last, k * last};
       }},
      {std::make_shared<LimitLaw>(
           "logarithm_from_0", "(A_inf B) ln(1 + t/tau)",
           std::vector<Parameter>{
               level("A_inf B", "strength of the logarithm where B is small"),
               bent("tau", "lag before the logarithm sets in", ParameterUnit::time)},
           [](double t, double tau, double* terms, double* slopes) {
             terms[0] = std::log1p(t / tau);
             slopes[0] = -(t / tau) / (tau + t);
           }),
       "no end of the logarithm is in sight (B goes to 0, A_inf to infinity)",
       [](const ParameterValues& p, double k, double, double last) {
         const double b = 1 / (k * std::log1p(last / p[1]));
         return ParameterValues{p[0] / b, b, p[1]};
       }}};
}

std::vector<Limit> StretchedExponential::limits() const {
  const Parameter rho_inf = level("rho_inf", "value after infinitely many taps");
  const Parameter rho_0 = level("rho_0", "value before the first tap");
  return {{line_in_log("rho(1)", "growth"), "rho is linear in ln t (beta goes to 0)",
           [](const ParameterValues& p, double k, double first, double last) {
             const double beta = 1 / (k * std::max(1.0, std::log(last / first)));
             const double tau = std::sqrt(first) * std::sqrt(last);
             const double change = p[1] * std::exp(1.0) / beta;
             const double end = p[0] + change / std::exp(1.0) + p[1] * std::log(tau);
             return ParameterValues{end, end - change, tau, beta};
           }},
          {std::make_shared<LimitLaw>(
               "power_of_t", "rho_0 + r t^beta",
               std::vector<Parameter>{rho_0, factor("r", "growth until t = 1"),
                                      bent("beta", "stretching exponent", ParameterUnit::none)},
               [](double t, double beta, double* terms, double* slopes) {
                 terms[0] = 1;
                 terms[1] = std::pow(t, beta);
                 slopes[1] = t > 0 ? terms[1] * std::log(t) : 0;
               }),
           "the relaxation has hardly begun (tau and rho_inf grow)",
           [](const ParameterValues& p, double k, double, double last) {
             const double tau = last * std::pow(k, 1 / p[2]);
             return ParameterValues{p[0] + p[1] * std::pow(tau, p[2]), p[0], tau, p[2]};
           }},
          {std::make_shared<LimitLaw>(
               "power_approach", "rho_inf - A t^-s",
               std::vector<Parameter>{rho_inf, factor("A", "distance from rho_inf at t = 1"),
                                      bent("s", "exponent of the approach", ParameterUnit::none)},
               [](double t, double s, double* terms, double* slopes) {
                 const double power = std::pow(t, -s);
                 terms[0] = 1;
                 terms[1] = -power;
                 slopes[1] = power * std::log(t);
               },
               From::above_zero),
           "the approach to rho_inf is a power of t (beta and tau go to 0, rho_0 to infinity)"}};
}

std::vector<Limit> TwoExponentials::limits() const {
  const Parameter level_inf = level("Z_inf", "value after infinitely many taps");
  const Parameter tau = bent("tau", "time of the decay", ParameterUnit::time);
  return {{line("Z(0)"), "the decay has hardly begun"},
          {std::make_shared<LimitLaw>(
               "exponential", "Z_inf + a exp(-t/tau)",
               std::vector<Parameter>{level_inf, level("a", "amplitude of the decay"), tau},
               [](double t, double time, double* terms, double* slopes) {
                 terms[0] = 1;
                 terms[1] = std::exp(-t / time);
                 slopes[1] = terms[1] * (t / time) / time;
               }),
           "one exponential is enough"},
          {std::make_shared<LimitLaw>(
               "exponential_and_line", "Z(0) + r t + a1 exp(-t/tau1)",
               std::vector<Parameter>{level("Z(0)", "start of the line"), slope("r", "its slope"),
                                      level("a1", "amplitude of the fast decay"),
                                      bent("tau1", "time of the fast decay", ParameterUnit::time)},
               [](double t, double time, double* terms, double* slopes) {
                 terms[0] = 1;
                 terms[1] = t;
                 terms[2] = std::exp(-t / time);
                 slopes[2] = terms[2] * (t / time) / time;
               }),
           "the slow decay has hardly begun (tau2, a2 and Z_inf grow)",
           [](const ParameterValues& p, double k, double, double last) {
             const double slow = k * last, a2 = -p[1] * slow;
             return ParameterValues{p[0] - a2, p[2], p[3], a2, slow};
           }},
          {std::make_shared<LimitLaw>(
               "critical_decay", "Z_inf + (a + b t) exp(-t/tau)",
               std::vector<Parameter>{level_inf, level("a", "amplitude of the decay"),
                                      slope("b", "its growth per tap"), tau},
               [](double t, double time, double* terms, double* slopes) {
                 terms[0] = 1;
                 terms[1] = std::exp(-t / time);
                 terms[2] = t * terms[1];
                 slopes[1] = terms[1] * (t / time) / time;
                 slopes[2] = t * slopes[1];
               }),
           "both times are equal (a1 and a2 grow with opposite signs)"}};
}

}  // namespace jostle::inline fitting
