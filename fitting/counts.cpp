#include "fitting/counts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "fitting/fit.hpp"
#include "fitting/intervals/fit_statistics.hpp"
#include "fitting/solver/curve_residuals.hpp"

namespace jostle::inline fitting {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
// For a positive parameter's logarithm: beyond, it has diverged.
constexpr double most_log_variance = 25;

// Gauss-Legendre on [-1, 1], exact to the ninth power.
constexpr double nodes[] = {-0.906179845938664, -0.538469310105683, 0, 0.538469310105683,
                            0.906179845938664};
constexpr double node_weights[] = {0.236926885056189, 0.478628670499366, 0.568888888888889,
                                   0.478628670499366, 0.236926885056189};

// The law's expected counts: the argument t numbers the bins.
class BinnedLaw final : public Model {
 public:
  BinnedLaw(const Model& law, const std::vector<Bin>& bins) : law_(law), bins_(bins) {}

  std::string name() const override { return law_.name(); }
  const std::vector<Parameter>& parameters() const override { return law_.parameters(); }

  double value(double t, const double* p) const override {
    return integrated(t, [&](double x) { return law_.value(x, p); });
  }
  double value_and_gradient(double t, const double* p, double* gradient) const override {
    const std::size_t n = parameters().size();
    std::vector<double> slopes(n);
    std::fill_n(gradient, n, 0.0);
    const Bin& bin = bins_[static_cast<std::size_t>(t)];
    if (bin.low == bin.high) return law_.value_and_gradient(bin.low, p, gradient);
    double sum = 0;
    for (std::size_t i = 0; i < std::size(nodes); ++i) {
      const double weight = 0.5 * (bin.high - bin.low) * node_weights[i];
      sum += weight * law_.value_and_gradient(node(bin, i), p, slopes.data());
      for (std::size_t j = 0; j < n; ++j) gradient[j] += weight * slopes[j];
    }
    return sum;
  }
  std::vector<std::vector<double>> candidates(const Curve& curve) const override {
    Curve midpoints = curve;
    for (double& t : midpoints.t) {
      const Bin& bin = bins_[static_cast<std::size_t>(t)];
      t = 0.5 * (bin.low + bin.high);
    }
    return law_.candidates(midpoints);
  }

 private:
  static double node(const Bin& bin, std::size_t i) {
    return 0.5 * (bin.low + bin.high) + 0.5 * (bin.high - bin.low) * nodes[i];
  }
  template <typename Function>
  double integrated(double t, Function f) const {
    const Bin& bin = bins_[static_cast<std::size_t>(t)];
    if (bin.low == bin.high) return f(bin.low);
    double sum = 0;
    for (std::size_t i = 0; i < std::size(nodes); ++i) sum += node_weights[i] * f(node(bin, i));
    return 0.5 * (bin.high - bin.low) * sum;
  }

  const Model& law_;
  const std::vector<Bin>& bins_;
};

// Signed roots of the contribution of each bin to the deviance, 2 (mu - n + n ln(n / mu)), whose
// sum least squares then minimise: twice the difference of the log-likelihood from its maximum.
class DevianceResiduals final : public Residuals {
 public:
  DevianceResiduals(const Model& law, const Curve& counts, const ParameterValues& p)
      : counts_(counts),
        nothing_{counts.t, std::vector<double>(counts.x.size(), 0.0), {}},
        plain_(law, nothing_, p, std::vector<bool>(p.size(), true)) {}

  Eigen::Index n_residuals() const override { return plain_.n_residuals(); }
  Eigen::Index n_variables() const override { return plain_.n_variables(); }
  void values(const Eigen::VectorXd& u, Eigen::VectorXd& r) const override {
    plain_.values(u, r);
    for (Eigen::Index k = 0; k < r.size(); ++k) r[k] = root(k, r[k]).value;
  }
  void values_and_jacobian(const Eigen::VectorXd& u, Eigen::VectorXd& r,
                           Eigen::MatrixXd& jacobian) const override {
    plain_.values_and_jacobian(u, r, jacobian);
    for (Eigen::Index k = 0; k < r.size(); ++k) {
      const auto [value, slope] = root(k, r[k]);
      r[k] = value;
      jacobian.row(k) *= slope;
    }
  }
  const CurveResiduals& plain() const { return plain_; }

 private:
  struct Root {
    double value, slope;  // by the expected count
  };
  Root root(Eigen::Index k, double mu) const {
    const double n = counts_.x[static_cast<std::size_t>(k)], excess = mu - n;
    if (mu == 0 && n == 0) return {0, 0};
    if (!(mu > 0)) return {nan, nan};
    const double x = excess / mu;  // 1 - n / mu
    // By its series where the difference would lose its digits.
    const double deviance = std::abs(x) < 1e-4 ? excess * x * (1 + x / 3)
                                               : 2 * (excess + (n > 0 ? n * std::log(n / mu) : 0));
    const double value = std::copysign(std::sqrt(std::max(deviance, 0.0)), excess);
    return {value, std::abs(x) < 1e-4 ? (1 - x / 6) / std::sqrt(mu) : x / value};
  }

  const Curve& counts_;
  Curve nothing_;
  CurveResiduals plain_;  // the expected counts less nothing
};

CountsFit most_likely(const Model& law, const Curve& counts, const ParameterValues& start) {
  const DevianceResiduals residuals(law, counts, start);
  SolverOptions options;
  for (const double n : counts.x) options.data_norm += n;
  options.data_norm = std::sqrt(options.data_norm);
  const Minimum minimum = minimise(residuals, residuals.plain().to_variables(start), options);
  CountsFit found;
  if (!is_minimum(minimum.reason)) {
    return found.fault = std::string("did not settle: ") + describe(minimum.reason), found;
  }
  found.values = residuals.plain().to_parameters(minimum.x);
  const Eigen::MatrixXd variance = inverse_normal(minimum.jacobian).matrix;
  std::string lost;
  for (std::size_t j = 0; j < found.values.size(); ++j) {
    const Parameter& parameter = law.parameters()[j];
    const auto k = static_cast<Eigen::Index>(j);
    const bool unbounded = parameter.lower == 0 && !(variance(k, k) < most_log_variance);
    if (unbounded) lost += (lost.empty() ? "" : ", ") + parameter.name;
  }
  if (!lost.empty()) found.fault = "the data do not limit " + lost;
  for (const double t : counts.t) found.expected.push_back(law.value(t, found.values.data()));
  return found;
}

// Least squares, about as far off as the counts are rough.
std::variant<ParameterValues, std::string> first_guess(const Model& law, Curve counts) {
  double least = std::numeric_limits<double>::infinity();
  for (const double n : counts.x) least = n > 0 ? std::min(least, n) : least;
  for (const double n : counts.x) counts.sigma.push_back(std::sqrt(std::max(n, least)));
  const auto outcome = fit_as_given(law, counts, {.profiles = false, .memory = false});
  if (const auto* refusal = std::get_if<Refusal>(&outcome)) return refusal->message;
  return std::get<Fit>(outcome).values();
}

}  // namespace

CountsFit fit_counts(const Model& law, const std::vector<Bin>& bins,
                     const std::vector<double>& counts, const ParameterValues& start) {
  const BinnedLaw binned(law, bins);
  Curve curve{.t = {}, .x = counts, .sigma = {}};
  for (std::size_t k = 0; k < bins.size(); ++k) curve.t.push_back(static_cast<double>(k));
  if (!start.empty()) return most_likely(binned, curve, start);
  const auto guess = first_guess(binned, curve);
  if (const auto* reason = std::get_if<std::string>(&guess)) return {{}, {}, *reason};
  return most_likely(binned, curve, std::get<ParameterValues>(guess));
}

}  // namespace jostle::inline fitting
