#include "fitting/models/model.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/models/limit.hpp"
#include "fitting/solver/grid.hpp"

namespace jostle::inline fitting {

namespace {

// How far a parameter may be moved without leaving its bounds on either side.
double difference_step(const Parameter& parameter, double p) {
  const double wanted = 1e-4 * std::max(std::abs(p), 1e-8);
  const double room = std::min(p - parameter.lower, parameter.upper - p);
  return std::min(wanted, room / 4);
}

}  // namespace

double Model::value_and_gradient(double t, const double* p, double* gradient) const {
  const std::size_t n = parameters().size();
  ParameterValues moved(p, p + n);
  for (std::size_t j = 0; j < n; ++j) {
    const double h = difference_step(parameters()[j], p[j]);
    const auto value_at = [&](double steps) {
      moved[j] = p[j] + steps * h;
      return value(t, moved.data());
    };
    gradient[j] = (8 * (value_at(1) - value_at(-1)) - (value_at(2) - value_at(-2))) / (12 * h);
    moved[j] = p[j];
  }
  return value(t, p);
}

std::string Model::refusal(const Curve&) const {
  return "";
}

std::vector<Limit> Model::limits() const {
  return {};
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
  return best_of_grid(*this, sample, fixed, {.axes = candidates(sample)}, n);
}

bool is_fitted_in_logarithms(const Model& model, const Curve& curve) {
  return model.residual_scale() == ResidualScale::logarithmic &&
         (curve.sigma.empty() || curve.n_realizations > 0);
}

std::vector<double> geometric(double first, double last, std::size_t n) {
  std::vector<double> values(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(n - 1);
    values[i] = first * std::exp(share * std::log(last / first));
  }
  return values;
}

}  // namespace jostle::inline fitting
