#include <algorithm>
#include <cmath>

#include "fitting/intervals/distributions.hpp"
#include "fitting/models/models.hpp"
#include "fitting/solver/decompositions.hpp"

namespace jostle::inline fitting {

namespace {

constexpr double two_pi = 6.283185307179586;

std::pair<double, double> range(const std::vector<double>& values) {
  const auto [first, last] = std::minmax_element(values.begin(), values.end());
  return {*first, *last};
}

// A length of a curve along t, positive even where all t are one.
double extent(const Curve& curve) {
  const auto [first, last] = range(curve.t);
  return last > first ? last - first : std::max(std::abs(last), 1.0);
}

// d ln Gamma(x) / dx for x > 0: recurrence up to 10, then Stirling's series (Abramowitz & Stegun
// 6.3.5, 6.3.18).
double digamma(double x) {
  double recurrence = 0;
  for (; x < 10; ++x) recurrence += 1 / x;
  const double y = 1 / (x * x);
  const double series =
      y * (1.0 / 12 - y * (1.0 / 120 - y * (1.0 / 252 - y * (1.0 / 240 - y * (1.0 / 132)))));
  return std::log(x) - 0.5 / x - series - recurrence;
}

}  // namespace

DensityProfile::DensityProfile()
    : PublishedLaw("profile", "(Phi_0 - alpha t) / (1 + exp(beta (t - z_star)))",
                   "Philippe & Bideau 2001, eq. 7",
                   {{.name = "Phi_0",
                     .meaning = "packing fraction extrapolated to z = 0",
                     .unit = ParameterUnit::value,
                     .linear = true},
                    {.name = "alpha",
                     .meaning = "loss of packing fraction per height",
                     .unit = ParameterUnit::value_per_time,
                     .linear = true},
                    {.name = "beta",
                     .meaning = "sharpness of the free surface",
                     .unit = ParameterUnit::per_time,
                     .lower = 0},
                    {.name = "z_star",
                     .meaning = "height of the free surface",
                     .unit = ParameterUnit::time}}) {}

double DensityProfile::value(double t, const double* p) const {
  return (p[0] - p[1] * t) / (1 + std::exp(p[2] * (t - p[3])));
}

double DensityProfile::value_and_gradient(double t, const double* p, double* gradient) const {
  // share = 1/(1 + e), rest = e/(1 + e), without overflow on either side.
  const double e = std::exp(-std::abs(p[2] * (t - p[3])));
  const bool is_above = p[2] * (t - p[3]) > 0;
  const double share = (is_above ? e : 1) / (1 + e);
  const double rest = (is_above ? 1 : e) / (1 + e);
  const double line = p[0] - p[1] * t;
  gradient[0] = share;
  gradient[1] = -t * share;
  gradient[2] = -line * share * rest * (t - p[3]);
  gradient[3] = line * share * rest * p[2];
  return line * share;
}

std::vector<std::vector<double>> DensityProfile::candidates(const Curve& curve) const {
  const auto [first, last] = range(curve.t);
  const double length = extent(curve);
  std::vector<double> surfaces;
  for (int i = 0; i <= 24; ++i) surfaces.push_back(first + (last - first) * i / 20.0);
  return {{}, {}, geometric(2 / length, 400 / length, 10), surfaces};
}

PoreTail::PoreTail()
    : PublishedLaw("pore_tail", "A exp(-t/v0)", "Philippe & Bideau 2001, sec. on pores",
                   {{.name = "A",
                     .meaning = "density extrapolated to v = 0",
                     .unit = ParameterUnit::value,
                     .linear = true},
                    {.name = "v0",
                     .meaning = "mean volume of the tail",
                     .unit = ParameterUnit::time,
                     .lower = 0}}) {}

double PoreTail::value(double t, const double* p) const {
  return p[0] * std::exp(-t / p[1]);
}

double PoreTail::value_and_gradient(double t, const double* p, double* gradient) const {
  const double left = std::exp(-t / p[1]);
  gradient[0] = left;
  gradient[1] = p[0] * left * (t / p[1]) / p[1];
  return p[0] * left;
}

std::vector<std::vector<double>> PoreTail::candidates(const Curve& curve) const {
  return {{}, geometric(1e-3 * extent(curve), 1e2 * extent(curve), 21)};
}

PowerLaw::PowerLaw()
    : PublishedLaw("power_law", "A t^-s", "Philippe & Bideau 2001, sec. on fluctuations",
                   {{.name = "A",
                     .meaning = "value at t = 1",
                     .unit = ParameterUnit::value,
                     .lower = 0,
                     .of_power = true},
                    {.name = "s", .meaning = "minus the log-log slope"}}) {}

double PowerLaw::value(double t, const double* p) const {
  return p[0] * std::pow(t, -p[1]);
}

double PowerLaw::value_and_gradient(double t, const double* p, double* gradient) const {
  gradient[0] = std::pow(t, -p[1]);
  gradient[1] = -p[0] * gradient[0] * std::log(t);
  return p[0] * gradient[0];
}

std::string PowerLaw::refusal(const Curve& curve) const {
  for (std::size_t i = 0; i < curve.t.size(); ++i) {
    if (curve.t[i] <= 0 || curve.x[i] <= 0) {
      return "t and X must be positive: the law is fitted in their logarithms";
    }
  }
  return "";
}

// A straight line through the logarithms.
std::vector<ParameterValues> PowerLaw::starts(const Curve& curve, std::span<const double> fixed,
                                              std::size_t) const {
  const auto n = static_cast<Eigen::Index>(curve.t.size());
  Eigen::MatrixXd basis(n, 2);
  Eigen::VectorXd right(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double weight = curve.sigma.empty() ? 1 : curve.x[k] / curve.sigma[k];
    const bool pinned[] = {!std::isnan(fixed[0]), !std::isnan(fixed[1])};
    right[i] = std::log(curve.x[k]);
    if (pinned[0]) right[i] -= std::log(fixed[0]);
    if (pinned[1]) right[i] += fixed[1] * std::log(curve.t[k]);
    basis(i, 0) = pinned[0] ? 0 : weight;
    basis(i, 1) = pinned[1] ? 0 : -weight * std::log(curve.t[k]);
    right[i] *= weight;
  }
  const Eigen::VectorXd c = least_squares(basis, right);
  return {
      {std::isnan(fixed[0]) ? std::exp(c[0]) : fixed[0], std::isnan(fixed[1]) ? c[1] : fixed[1]}};
}

Normal::Normal()
    : PublishedLaw("normal", "area / (width sqrt(2 pi)) exp(-(t - mean)^2 / (2 width^2))",
                   "Rosato et al. 2010, nearest neighbours",
                   {{.name = "area",
                     .meaning = "integral over t",
                     .unit = ParameterUnit::value_time,
                     .linear = true},
                    {.name = "mean", .meaning = "centre", .unit = ParameterUnit::time},
                    {.name = "width",
                     .meaning = "standard deviation",
                     .unit = ParameterUnit::time,
                     .lower = 0}}) {}

double Normal::value(double t, const double* p) const {
  const double u = (t - p[1]) / p[2];
  return p[0] / (p[2] * std::sqrt(two_pi)) * std::exp(-0.5 * u * u);
}

double Normal::value_and_gradient(double t, const double* p, double* gradient) const {
  const double u = (t - p[1]) / p[2];
  const double density = std::exp(-0.5 * u * u) / (p[2] * std::sqrt(two_pi));
  gradient[0] = density;
  gradient[1] = p[0] * density * u / p[2];
  gradient[2] = p[0] * density * (u * u - 1) / p[2];
  return p[0] * density;
}

std::vector<std::vector<double>> Normal::candidates(const Curve& curve) const {
  const double first = range(curve.t).first, length = extent(curve);
  std::vector<double> means;
  for (int i = -4; i <= 24; ++i) means.push_back(first + length * i / 20.0);
  return {{}, means, geometric(0.01 * length, 2 * length, 12)};
}

KGamma::KGamma()
    : PublishedLaw(
          "k_gamma", "area k^k / Gamma(k) t^(k - 1) / mean^k exp(-k t / mean)",
          "Aste & Di Matteo 2008, doi:10.1103/PhysRevE.77.021309",
          {{.name = "area",
            .meaning = "integral over t",
            .unit = ParameterUnit::value_time,
            .linear = true},
           {.name = "mean", .meaning = "mean of t", .unit = ParameterUnit::time, .lower = 0},
           {.name = "k", .meaning = "shape: mean^2 over variance", .lower = 0}}) {}
double KGamma::value(double t, const double* p) const {
  const double x = t / p[1], k = p[2];
  return p[0] / t * std::exp(k * (std::log(k * x) - x) - log_gamma(k));
}
double KGamma::value_and_gradient(double t, const double* p, double* gradient) const {
  const double x = t / p[1], k = p[2];
  const double shape = std::exp(k * (std::log(k * x) - x) - log_gamma(k)) / t;
  gradient[0] = shape;
  gradient[1] = p[0] * shape * k * (x - 1) / p[1];
  gradient[2] = p[0] * shape * (std::log(k * x) + 1 - x - digamma(k));
  return p[0] * shape;
}
std::string KGamma::refusal(const Curve& curve) const {
  return range(curve.t).first > 0 ? "" : "t must be positive: what lies above the least";
}
std::vector<std::vector<double>> KGamma::candidates(const Curve& curve) const {
  const double last = range(curve.t).second;
  return {{}, geometric(0.01 * last, 2 * last, 16), geometric(0.3, 300, 12)};
}

std::vector<std::unique_ptr<Model>> all_models() {
  std::vector<std::unique_ptr<Model>> models;
  models.push_back(std::make_unique<InverseLog>());
  models.push_back(std::make_unique<InverseLogHeight>());
  models.push_back(std::make_unique<TwoExponentials>());
  models.push_back(std::make_unique<StretchedExponential>());
  models.push_back(std::make_unique<Ageing>());
  models.push_back(std::make_unique<DensityProfile>());
  models.push_back(std::make_unique<PoreTail>());
  models.push_back(std::make_unique<PowerLaw>());
  models.push_back(std::make_unique<Normal>());
  models.push_back(std::make_unique<KGamma>());
  return models;
}

std::unique_ptr<Model> make_model(std::string_view name) {
  for (std::unique_ptr<Model>& model : all_models()) {
    if (model->name() == name) return std::move(model);
  }
  return nullptr;
}

}  // namespace jostle::inline fitting
