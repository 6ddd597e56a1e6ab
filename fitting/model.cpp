#include "fitting/model.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

namespace jostle {

namespace {

// How far a parameter may be moved without leaving its bounds on either side.
double difference_step(const Parameter& parameter, double p) {
  const double wanted = 1e-4 * std::max(std::abs(p), 1e-8);
  const double room = std::min(p - parameter.lower, parameter.upper - p);
  return std::min(wanted, room / 4);
}

// The linear parameters at given nonlinear ones, and what remains of the curve.
class Projection {
 public:
  Projection(const Model& model, const Curve& curve, std::span<const double> fixed)
      : model_(model), curve_(curve) {
    const std::vector<Parameter>& parameters = model.parameters();
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      if (parameters[j].linear && std::isnan(fixed[j])) linear_.push_back(j);
    }
    const auto rows = static_cast<Eigen::Index>(curve.t.size());
    basis_.resize(rows, static_cast<Eigen::Index>(linear_.size()));
    rest_.resize(rows);
  }

  /// Fills the linear entries of p; returns the sum of squares, infinite where there is none.
  double operator()(ParameterValues& p) {
    for (std::size_t j : linear_) p[j] = 0;
    std::vector<double> gradient(p.size());
    for (Eigen::Index i = 0; i < rest_.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double weight = curve_.sigma.empty() ? 1 : 1 / curve_.sigma[k];
      const double f = model_.value_and_gradient(curve_.t[k], p.data(), gradient.data());
      rest_[i] = weight * (curve_.x[k] - f);
      for (std::size_t j = 0; j < linear_.size(); ++j) {
        basis_(i, static_cast<Eigen::Index>(j)) = weight * gradient[linear_[j]];
      }
    }
    if (!basis_.allFinite() || !rest_.allFinite()) return infinite;
    if (!linear_.empty()) solve(p);
    const double cost = rest_.squaredNorm();
    return std::isfinite(cost) ? cost : infinite;
  }

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  void solve(ParameterValues& p) {
    Eigen::VectorXd norms = basis_.colwise().norm().transpose();
    for (double& norm : norms) norm = norm > 0 ? norm : 1;
    basis_ = basis_ * norms.cwiseInverse().asDiagonal();
    const Eigen::VectorXd c = basis_.colPivHouseholderQr().solve(rest_);
    rest_ -= basis_ * c;
    for (std::size_t j = 0; j < linear_.size(); ++j) {
      const auto k = static_cast<Eigen::Index>(j);
      const Parameter& parameter = model_.parameters()[linear_[j]];
      p[linear_[j]] = c[k] / norms[k];
      if (!(p[linear_[j]] > parameter.lower && p[linear_[j]] < parameter.upper)) {
        rest_[0] = infinite;
      }
    }
  }

  const Model& model_;
  const Curve& curve_;
  std::vector<std::size_t> linear_;
  Eigen::MatrixXd basis_;
  Eigen::VectorXd rest_;
};

}  // namespace

double Model::value_and_gradient(double t, const double* p, double* gradient) const {
  const std::size_t n = parameters().size();
  ParameterValues moved(p, p + n);
  for (std::size_t j = 0; j < n; ++j) {
    const double h = difference_step(parameters()[j], p[j]);
    const auto at = [&](double steps) {
      moved[j] = p[j] + steps * h;
      return value(t, moved.data());
    };
    gradient[j] = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h);
    moved[j] = p[j];
  }
  return value(t, p);
}

std::string Model::refusal(const Curve&) const {
  return "";
}

std::vector<std::vector<double>> Model::candidates(const Curve& curve) const {
  const auto [first, last] = std::minmax_element(curve.t.begin(), curve.t.end());
  const double range = *last > *first ? *last - *first : 1;
  std::vector<std::vector<double>> all;
  for (const Parameter& parameter : parameters()) {
    std::vector<double> values = {0, 1, -1};
    if (parameter.lower >= 0) {
      const double unit = parameter.unit == ParameterUnit::time ? range : 1;
      values = geometric(1e-6 * unit, 1e6 * unit, 13);
    }
    std::erase_if(values, [&](double v) { return !(v > parameter.lower && v < parameter.upper); });
    if (values.empty()) values = {0.5 * (parameter.lower + parameter.upper)};
    all.push_back(std::move(values));
  }
  return all;
}

std::vector<ParameterValues> Model::starts(const Curve& curve, std::span<const double> fixed,
                                           std::size_t n) const {
  const Curve sample = thinned(curve, 128);
  std::vector<std::vector<double>> values = candidates(sample);
  for (std::size_t j = 0; j < values.size(); ++j) {
    if (parameters()[j].linear) values[j] = {0};
    if (!std::isnan(fixed[j])) values[j] = {fixed[j]};
  }
  Projection project(*this, sample, fixed);
  std::vector<std::pair<double, ParameterValues>> found;
  std::vector<std::size_t> digits(values.size(), 0);
  for (bool more = true; more;) {
    ParameterValues p(values.size());
    for (std::size_t j = 0; j < p.size(); ++j) p[j] = values[j][digits[j]];
    const double cost = project(p);
    if (std::isfinite(cost)) found.emplace_back(cost, std::move(p));
    // The next combination, counted like digits.
    more = false;
    for (std::size_t j = 0; j < digits.size() && !more; ++j) {
      more = ++digits[j] < values[j].size();
      if (!more) digits[j] = 0;
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<ParameterValues> best;
  for (std::size_t i = 0; i < found.size() && i < n; ++i) best.push_back(found[i].second);
  return best;
}

std::vector<double> geometric(double first, double last, std::size_t n) {
  std::vector<double> values(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(n - 1);
    values[i] = first * std::exp(share * std::log(last / first));
  }
  return values;
}

}  // namespace jostle
