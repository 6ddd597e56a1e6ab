#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "fitting/models/models.hpp"
#include "fitting/solver/grid.hpp"

namespace jostle::inline fitting {

namespace {

std::string negative_time(const Curve& curve) {
  const bool negative = std::any_of(curve.t.begin(), curve.t.end(), [](double t) { return t < 0; });
  return negative ? "t must not be negative: the law starts at t = 0" : "";
}

// The shortest positive time of a curve, and the longest.
std::pair<double, double> positive_range(const Curve& curve) {
  double first = std::numeric_limits<double>::infinity(), last = 0;
  for (double t : curve.t) {
    if (t > 0) first = std::min(first, t);
    last = std::max(last, t);
  }
  return last > 0 ? std::pair{first, last} : std::pair{1.0, 1.0};
}

// For the inverse logs with strength number `b` and time number `tau`. A curve determines the
// growth of the logarithm up to its end, B ln(1 + last/tau): from hardly out of the linear regime
// to saturated; and whether tau is below its first time, among its times, or beyond.
Grid log_grid(const Curve& curve, std::span<const double> fixed, std::size_t b, std::size_t tau) {
  const auto [first, last] = positive_range(curve);
  Grid grid;
  grid.axes.assign(fixed.size(), {0});
  const std::vector<double> times = geometric(0.03 * first, 100 * last, 18);
  if (std::isnan(fixed[b])) {
    grid.axes[b] = geometric(1e-2, 1e3, 11);
    grid.axes[tau] = times;
    grid.place = [b, tau, end = last](ParameterValues& p) {
      p[b] /= std::log1p(end / p[tau]);
      return true;
    };
    return grid;
  }
  // Where the strength is given, the growth sets the time.
  grid.axes[tau] = times;
  for (const double growth : geometric(1e-2, 1e3, 26)) {
    const double time = last / std::expm1(growth / fixed[b]);
    if (time > 1e-300) grid.axes[tau].push_back(time);
  }
  std::sort(grid.axes[tau].begin(), grid.axes[tau].end());
  return grid;
}

// Where B and tau go to infinity together, B ln(1 + t/tau) is this times t.
const Combination growth_rate = {"B/tau", "growth per tap at first", ParameterUnit::per_time, 2, 3,
                                 -1};

}  // namespace

std::vector<Combination> InverseLog::combinations() const {
  return {growth_rate};
}

std::vector<Combination> InverseLogHeight::combinations() const {
  return {growth_rate};
}

// Z = Z_inf - (Z_inf - Z_0) / (1 + B Z_0/Z_inf ln(1 + t/tau)).
std::optional<Equivalent> InverseLog::equivalent() const {
  const auto restate = [](const ParameterValues& p) {
    return ParameterValues{p[0], p[0] - p[1], p[2] * p[0] / (p[0] - p[1]), p[3]};
  };
  return Equivalent{std::make_shared<InverseLogHeight>(), restate, {0, {}, {}, 3}};
}

std::optional<Equivalent> InverseLogHeight::equivalent() const {
  const auto restate = [](const ParameterValues& p) {
    return ParameterValues{p[0], p[0] - p[1], p[2] * p[1] / p[0], p[3]};
  };
  return Equivalent{std::make_shared<InverseLog>(), restate, {0, {}, {}, 3}};
}

// Where B goes to 0 the law is the logarithm A_inf B ln(1 + t/tau).
std::vector<Combination> Ageing::combinations() const {
  return {{"A_inf B", "strength of the logarithm where B is small", ParameterUnit::value, 0, 1, 1},
          {"B/tau", "growth per unit of time at first", ParameterUnit::per_time, 1, 2, -1}};
}

InverseLog::InverseLog()
    : PublishedLaw(
          "inverse_log", "X_inf - dX / (1 + B ln(1 + t/tau))",
          "Philippe & Bideau 2001, eq. 3; Knight et al. 1995",
          {{.name = "X_inf",
            .meaning = "value after infinitely many taps",
            .unit = ParameterUnit::value,
            .linear = true},
           {.name = "dX", .meaning = "X_inf - X(0)", .unit = ParameterUnit::value, .linear = true},
           {.name = "B", .meaning = "strength of the logarithm", .lower = 0},
           {.name = "tau",
            .meaning = "taps before the logarithm sets in",
            .unit = ParameterUnit::time,
            .lower = 0}}) {}

double InverseLog::value(double t, const double* p) const {
  return p[0] - p[1] / (1 + p[2] * std::log1p(t / p[3]));
}

double InverseLog::value_and_gradient(double t, const double* p, double* gradient) const {
  const double log = std::log1p(t / p[3]);
  const double share = 1 / (1 + p[2] * log);  // share of dX that remains
  const double by_strength = p[1] * share * share;
  gradient[0] = 1;
  gradient[1] = -share;
  gradient[2] = by_strength * log;
  gradient[3] = -by_strength * p[2] * (t / p[3]) / (p[3] + t);
  return p[0] - p[1] * share;
}

std::string InverseLog::refusal(const Curve& curve) const {
  return negative_time(curve);
}

std::vector<ParameterValues> InverseLog::starts(const Curve& curve, std::span<const double> fixed,
                                                std::size_t n) const {
  const Curve sample = thinned(curve, 128);
  return best_of_grid(*this, sample, fixed, log_grid(sample, fixed, 2, 3), n);
}

InverseLogHeight::InverseLogHeight()
    : PublishedLaw("inverse_log_height",
                   "Z_inf (1 + B ln(1 + t/tau)) / (Z_inf/Z_0 + B ln(1 + t/tau))",
                   "Philippe & Bideau 2001, eq. 4",
                   {{.name = "Z_inf",
                     .meaning = "mean height after infinitely many taps",
                     .unit = ParameterUnit::value,
                     .lower = 0},
                    {.name = "Z_0",
                     .meaning = "mean height before the first tap",
                     .unit = ParameterUnit::value,
                     .lower = 0},
                    {.name = "B", .meaning = "strength of the logarithm", .lower = 0},
                    {.name = "tau",
                     .meaning = "taps before the logarithm sets in",
                     .unit = ParameterUnit::time,
                     .lower = 0}}) {}

double InverseLogHeight::value(double t, const double* p) const {
  const double grown = p[2] * std::log1p(t / p[3]);
  return p[0] * (1 + grown) / (p[0] / p[1] + grown);
}

double InverseLogHeight::value_and_gradient(double t, const double* p, double* gradient) const {
  const double log = std::log1p(t / p[3]);
  const double grown = p[2] * log;
  const double denominator = p[0] / p[1] + grown;
  const double value = p[0] * (1 + grown) / denominator;
  // d/dg of (1 + g)/(c + g) is (c - 1)/(c + g)^2.
  const double by_growth = p[0] * (p[0] / p[1] - 1) / (denominator * denominator);
  gradient[0] = (1 + grown) * grown / (denominator * denominator);
  gradient[1] = value / denominator * p[0] / (p[1] * p[1]);
  gradient[2] = by_growth * log;
  gradient[3] = -by_growth * p[2] * (t / p[3]) / (p[3] + t);
  return value;
}

std::string InverseLogHeight::refusal(const Curve& curve) const {
  for (double x : curve.x) {
    if (x <= 0) return "X must be positive: it is a height above the floor";
  }
  return negative_time(curve);
}

// 1/Z follows the inverse log: its starts, with errors sigma / Z^2.
std::vector<ParameterValues> InverseLogHeight::starts(const Curve& curve,
                                                      std::span<const double> fixed,
                                                      std::size_t n) const {
  Curve inverse = curve;
  for (double& x : inverse.x) x = 1 / x;
  for (std::size_t i = 0; i < inverse.sigma.size(); ++i) {
    inverse.sigma[i] *= inverse.x[i] * inverse.x[i];
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double kept[] = {1 / fixed[0], nan, fixed[2], fixed[3]};
  const auto [low, high] = std::minmax_element(curve.x.begin(), curve.x.end());
  std::vector<ParameterValues> starts;
  for (ParameterValues p : InverseLog().starts(inverse, kept, 8 * n)) {
    p[1] = 1 / (p[0] - p[1]);
    p[0] = 1 / p[0];
    if (!std::isnan(fixed[1])) p[1] = fixed[1];
    if (p[0] > 0 && p[1] > 0 && starts.size() < n) starts.push_back(p);
  }
  if (starts.empty()) {
    const auto [first, last] = positive_range(curve);
    ParameterValues p = {*low, *high, 1, std::sqrt(first * last)};
    for (std::size_t j = 0; j < p.size(); ++j) p[j] = std::isnan(fixed[j]) ? p[j] : fixed[j];
    starts.push_back(p);
  }
  return starts;
}

TwoExponentials::TwoExponentials()
    : PublishedLaw("two_exponentials", "Z_inf + a1 exp(-t/tau1) + a2 exp(-t/tau2)",
                   "Philippe & Bideau 2001",
                   {{.name = "Z_inf",
                     .meaning = "value after infinitely many taps",
                     .unit = ParameterUnit::value,
                     .linear = true},
                    {.name = "a1",
                     .meaning = "amplitude of the fast decay",
                     .unit = ParameterUnit::value,
                     .linear = true},
                    {.name = "tau1",
                     .meaning = "time of the fast decay",
                     .unit = ParameterUnit::time,
                     .lower = 0},
                    {.name = "a2",
                     .meaning = "amplitude of the slow decay",
                     .unit = ParameterUnit::value,
                     .linear = true},
                    {.name = "tau2",
                     .meaning = "time of the slow decay",
                     .unit = ParameterUnit::time,
                     .lower = 0}}) {}

double TwoExponentials::value(double t, const double* p) const {
  return p[0] + p[1] * std::exp(-t / p[2]) + p[3] * std::exp(-t / p[4]);
}

double TwoExponentials::value_and_gradient(double t, const double* p, double* gradient) const {
  const double fast = std::exp(-t / p[2]), slow = std::exp(-t / p[4]);
  gradient[0] = 1;
  gradient[1] = fast;
  gradient[2] = p[1] * fast * (t / p[2]) / p[2];
  gradient[3] = slow;
  gradient[4] = p[3] * slow * (t / p[4]) / p[4];
  return p[0] + p[1] * fast + p[3] * slow;
}

// Up to times over which a curve is hardly more than a parabola.
std::vector<ParameterValues> TwoExponentials::starts(const Curve& curve,
                                                     std::span<const double> fixed,
                                                     std::size_t n) const {
  const Curve sample = thinned(curve, 128);
  const auto [first, last] = positive_range(sample);
  Grid grid;
  grid.axes.assign(fixed.size(), {0});
  // Not the same times for both: equal ones make the amplitudes meaningless.
  grid.axes[2] = geometric(0.3 * first, 1000 * last, 20);
  grid.axes[4] = geometric(0.4 * first, 1300 * last, 20);
  const bool ordered = std::isnan(fixed[2]) && std::isnan(fixed[4]);
  grid.place = [ordered](const ParameterValues& p) { return !ordered || p[2] < p[4]; };
  return best_of_grid(*this, sample, fixed, std::move(grid), n);
}

ParameterValues TwoExponentials::canonical(const ParameterValues& p) const {
  if (p[2] <= p[4]) return p;
  return {p[0], p[3], p[4], p[1], p[2]};
}

StretchedExponential::StretchedExponential()
    : PublishedLaw(
          "kww", "rho_inf - (rho_inf - rho_0) exp(-(t/tau)^beta)", "Rosato et al. 2010, sec. III",
          {{.name = "rho_inf",
            .meaning = "value after infinitely many taps",
            .unit = ParameterUnit::value,
            .linear = true},
           {.name = "rho_0",
            .meaning = "value before the first tap",
            .unit = ParameterUnit::value,
            .linear = true},
           {.name = "tau", .meaning = "relaxation time", .unit = ParameterUnit::time, .lower = 0},
           {.name = "beta", .meaning = "stretching exponent", .lower = 0}}) {}

// Written as rho_0 + (rho_inf - rho_0) (1 - exp): where the law has hardly begun rho_inf can be any
// size.
double StretchedExponential::value(double t, const double* p) const {
  return p[1] - (p[0] - p[1]) * std::expm1(-std::pow(t / p[2], p[3]));
}

double StretchedExponential::value_and_gradient(double t, const double* p, double* gradient) const {
  // At t = 0 the slope in t is infinite, but nothing depends on tau and beta.
  const double log = t > 0 ? std::log(t / p[2]) : 0;
  const double power = t > 0 ? std::exp(p[3] * log) : 0;
  const double gone = -std::expm1(-power), left = 1 - gone;
  // Far out left * power is 0, though power may be infinite.
  const double change = left > 0 ? (p[0] - p[1]) * left * power : 0;
  gradient[0] = gone;
  gradient[1] = left;
  gradient[2] = -change * p[3] / p[2];
  gradient[3] = change * log;
  return p[1] + (p[0] - p[1]) * gone;
}

std::string StretchedExponential::refusal(const Curve& curve) const {
  return negative_time(curve);
}

// Stretched: any time. Compressed, the law is a step as wide as tau/beta: it may be at any point.
std::vector<ParameterValues> StretchedExponential::starts(const Curve& curve,
                                                          std::span<const double> fixed,
                                                          std::size_t n) const {
  const Curve sample = thinned(curve, 128);
  const auto [first, last] = positive_range(sample);
  std::vector<double> times = geometric(0.1 * first, 30 * last, 16);
  std::vector<double> points = sample.t;
  std::sort(points.begin(), points.end());
  const std::size_t places =
      std::isnan(fixed[3]) ? std::min<std::size_t>(24, points.size()) : points.size();
  for (std::size_t i = 0; i < places; ++i) {
    const double time = points[(2 * i + 1) * points.size() / (2 * places)];
    if (time > 0) times.push_back(time);
  }
  std::sort(times.begin(), times.end());
  Grid grid{.axes = {{0}, {0}, times, {0.15, 0.25, 0.4, 0.6, 1, 1.6, 2.5, 5, 10, 25}}};
  return best_of_grid(*this, sample, fixed, std::move(grid), n);
}

Ageing::Ageing()
    : PublishedLaw("ageing", "A_inf (1 - 1 / (1 + B ln(1 + t/tau)))",
                   "Philippe & Bideau 2001, eq. 6",
                   {{.name = "A_inf",
                     .meaning = "value at infinite lag",
                     .unit = ParameterUnit::value,
                     .linear = true},
                    {.name = "B", .meaning = "strength of the logarithm", .lower = 0},
                    {.name = "tau",
                     .meaning = "lag before the logarithm sets in",
                     .unit = ParameterUnit::time,
                     .lower = 0}}) {}

double Ageing::value(double t, const double* p) const {
  const double grown = p[1] * std::log1p(t / p[2]);
  return p[0] * grown / (1 + grown);
}

double Ageing::value_and_gradient(double t, const double* p, double* gradient) const {
  const double log = std::log1p(t / p[2]);
  const double grown = p[1] * log;
  const double by_growth = p[0] / ((1 + grown) * (1 + grown));
  gradient[0] = grown / (1 + grown);
  gradient[1] = by_growth * log;
  gradient[2] = -by_growth * p[1] * (t / p[2]) / (p[2] + t);
  return p[0] * gradient[0];
}

std::string Ageing::refusal(const Curve& curve) const {
  return negative_time(curve);
}

std::vector<ParameterValues> Ageing::starts(const Curve& curve, std::span<const double> fixed,
                                            std::size_t n) const {
  const Curve sample = thinned(curve, 128);
  return best_of_grid(*this, sample, fixed, log_grid(sample, fixed, 1, 2), n);
}

}  // namespace jostle::inline fitting
