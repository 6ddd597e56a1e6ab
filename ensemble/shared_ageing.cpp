#include "ensemble/shared_ageing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/fit.hpp"

namespace jostle {

SharedAgeing::SharedAgeing(std::vector<Point> points) : points_(std::move(points)) {
  const std::vector<Parameter>& one = Ageing().parameters();
  const Parameter &a_inf = one[0], &b = one[1], &tau = one[2];
  parameters_.push_back(b);
  std::size_t curves = 0;
  for (const Point& point : points_) curves = std::max(curves, point.curve + 1);
  for (std::size_t k = 0; k < curves; ++k) {
    for (Parameter parameter : {a_inf, tau}) {
      parameter.name.append(1, '_').append(std::to_string(k));
      parameters_.push_back(std::move(parameter));
    }
  }
}

double SharedAgeing::value(double t, const double* p) const {
  const Point& at = point(t);
  const double own[] = {p[a_inf_index(at.curve)], p[0], p[tau_index(at.curve)]};
  return Ageing().value(at.lag, own);
}

double SharedAgeing::value_and_gradient(double t, const double* p, double* gradient) const {
  const Point& at = point(t);
  const double own[] = {p[a_inf_index(at.curve)], p[0], p[tau_index(at.curve)]};
  double by_own[3];
  const double value = Ageing().value_and_gradient(at.lag, own, by_own);
  std::fill_n(gradient, parameters_.size(), 0.0);
  gradient[a_inf_index(at.curve)] = by_own[0];
  gradient[0] = by_own[1];
  gradient[tau_index(at.curve)] = by_own[2];
  return value;
}

std::vector<ParameterValues> SharedAgeing::starts(const Curve& curve, std::span<const double> fixed,
                                                  std::size_t n) const {
  std::vector<Curve> own(n_curves());
  for (std::size_t i = 0; i < curve.t.size(); ++i) {
    const Point& at = point(curve.t[i]);
    own[at.curve].t.push_back(at.lag);
    own[at.curve].x.push_back(curve.x[i]);
    if (!curve.sigma.empty()) own[at.curve].sigma.push_back(curve.sigma[i]);
  }
  std::vector<std::pair<double, ParameterValues>> found;  // residual sum, start
  for (const double b : fixed[0] > 0 ? std::vector<double>{fixed[0]} : geometric(1e-3, 1e3, 7)) {
    ParameterValues start = {b};
    double sum = 0;
    for (std::size_t k = 0; k < own.size(); ++k) {
      FitOptions options{
          .multi_start = false, .fixed = {{"B", b}}, .profiles = false, .memory = false};
      const double a_inf = fixed[a_inf_index(k)], tau = fixed[tau_index(k)];
      if (!std::isnan(a_inf)) options.fixed["A_inf"] = a_inf;
      if (!std::isnan(tau)) options.fixed["tau"] = tau;
      const auto fitted = fit(Ageing(), own[k], options);
      const Fit* good = std::get_if<Fit>(&fitted);
      if (!good) break;
      start.push_back(good->estimates[0].value);
      start.push_back(good->estimates[2].value);
      sum += good->residual_sum;
    }
    if (start.size() == parameters_.size()) found.emplace_back(sum, std::move(start));
  }
  std::ranges::stable_sort(found, {}, [](const auto& entry) { return entry.first; });
  std::vector<ParameterValues> starts;
  for (auto& [sum, start] : found) {
    if (starts.size() < n) starts.push_back(std::move(start));
  }
  return starts;
}

}  // namespace jostle
