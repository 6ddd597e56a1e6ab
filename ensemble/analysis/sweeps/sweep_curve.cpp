#include "ensemble/analysis/sweeps/sweep_curve.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "ensemble/moments.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline ensemble {

namespace {

Moments folded(std::span<const double> values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  return moments;
}

template <class T>
std::vector<T> chosen(const std::vector<T>& values, const std::vector<std::size_t>& order) {
  std::vector<T> kept;
  for (const std::size_t i : order) kept.push_back(values[i]);
  return kept;
}

double square(double x) {
  return x * x;
}

// Sum of squared deviations.
double squares_of(const Moments& moments) {
  return square(moments.sigma()) * static_cast<double>(moments.count());
}

double sum_of_squares(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum;
}

}  // namespace

SweepCurve::SweepCurve(std::vector<double> x, std::vector<double> y, std::vector<ErrorOf> error)
    : x_(std::move(x)), y_(std::move(y)), error_(std::move(error)), count_(x_.size(), 0) {
  assert(y_.size() == x_.size() && error_.size() == x_.size());
  sort_and_drop();
  fitted_y_ = y_;
  const auto serves = [](const ErrorOf& group_error) {
    return group_error.dof + 1 >= fewest_for_own_error && group_error.error > 0;
  };
  own_errors_ = std::ranges::all_of(error_, serves);
  for (const ErrorOf& group_error : error_) {
    if (group_error.known() && std::isfinite(group_error.dof)) scatter_.push_back(group_error);
  }
  if (own_errors_) return;
  double variance = 0;
  for (const ErrorOf& group_error : error_) {
    if (!group_error.known() || !std::isfinite(group_error.dof)) continue;
    variance += group_error.dof * group_error.error * group_error.error;
    pooled_.dof += group_error.dof;
  }
  if (pooled_.known()) pooled_.error = std::sqrt(variance / pooled_.dof);
}

SweepCurve::SweepCurve(std::vector<double> x, std::vector<std::vector<double>> realizations,
                       Streams streams)
    : x_(std::move(x)), realizations_(std::move(realizations)), streams_(streams) {
  assert(realizations_.size() == x_.size());
  for (const std::vector<double>& values : realizations_) {
    const Moments moments = folded(values);
    y_.push_back(moments.mean());
    count_.push_back(moments.count());
    const bool several = moments.count() > 1;
    error_.push_back(
        several ? ErrorOf{moments.standard_error(), static_cast<double>(moments.count() - 1)}
                : ErrorOf{});
  }
  sort_and_drop();
  fitted_y_ = y_;
  streams_ == Streams::matched ? pool_matched() : pool_independent();
}

SweepCurve SweepCurve::reflected() const {
  SweepCurve turned = *this;
  for (double& y : turned.y_) y = -y;
  for (double& y : turned.fitted_y_) y = -y;
  for (std::vector<double>& values : turned.realizations_) {
    for (double& value : values) value = -value;
  }
  return turned;
}

void SweepCurve::sort_and_drop() {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (!std::isnan(y_[i])) order.push_back(i);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return x_[i]; });
  x_ = chosen(x_, order);
  y_ = chosen(y_, order);
  error_ = chosen(error_, order);
  count_ = chosen(count_, order);
  if (has_realizations()) realizations_ = chosen(realizations_, order);
}

void SweepCurve::pool_independent() {
  double squares = 0;
  for (std::size_t i = 0; i < n_points(); ++i) {
    const double own = squares_of(folded(realizations_[i]));
    const auto dof = static_cast<double>(count_[i] - 1);
    squares += own;
    pooled_.dof += dof;
    scatter_.push_back({dof > 0 ? std::sqrt(own / dof) : 0, dof});
  }
  if (pooled_.known()) pooled_.error = std::sqrt(squares / pooled_.dof);
  own_errors_ = n_points() > 0 && std::ranges::min(count_) >= fewest_for_own_error;
}

void SweepCurve::pool_matched() {
  if (n_points() == 0) return;
  for (std::size_t r = 0; r < realizations_.front().size(); ++r) {
    const bool all_finite = std::ranges::all_of(realizations_, [r](const auto& values) {
      return r < values.size() && !std::isnan(values[r]);
    });
    if (all_finite) common_.push_back(r);
  }
  if (common_.empty()) return;
  const auto n = static_cast<double>(n_points()), m = static_cast<double>(common_.size());
  for (std::size_t i = 0; i < n_points(); ++i) {
    fitted_y_[i] = folded(chosen(realizations_[i], common_)).mean();
  }
  Moments levels;
  double squares = 0;
  std::vector<double> of_points(n_points(), 0.0);
  for (const std::size_t r : common_) {
    Moments deviations;
    for (std::size_t i = 0; i < n_points(); ++i) deviations.add(realizations_[i][r] - fitted_y_[i]);
    levels.add(deviations.mean());
    squares += squares_of(deviations);
    for (std::size_t i = 0; i < n_points(); ++i) {
      of_points[i] += square(realizations_[i][r] - fitted_y_[i] - deviations.mean());
    }
  }
  if (common_.size() < 2) return;
  for (const double own : of_points) {
    if (n > 2) scatter_.push_back({std::sqrt(own * n / ((n - 1) * (m - 1))), m - 1});
  }
  level_ = {levels.standard_error() * std::sqrt(m), m - 1};
  if (n_points() > 1) pooled_ = {std::sqrt(squares / ((m - 1) * (n - 1))), (m - 1) * (n - 1)};
}

std::vector<double> SweepCurve::weights() const {
  std::vector<double> weights(n_points(), 1.0);
  for (std::size_t i = 0; i < n_points(); ++i) {
    if (!has_realizations() && own_errors_) weights[i] = 1 / error_[i].error;
    if (has_realizations() && streams_ == Streams::independent) {
      weights[i] = std::sqrt(static_cast<double>(count_[i]));
    }
  }
  return weights;
}

bool SweepCurve::pools() const {
  return streams_ == Streams::matched ? common_.size() < fewest_for_own_error : !own_errors_;
}

double SweepCurve::p_of_equal_scatter() const {
  double points = 0, dof = 0, squares = 0, logarithms = 0, inverse = 0;
  for (const ErrorOf& error : scatter_) {
    if (!error.known() || !(error.error > 0)) continue;
    ++points;
    dof += error.dof;
    squares += error.dof * square(error.error);
    logarithms += error.dof * std::log(square(error.error));
    inverse += 1 / error.dof;
  }
  if (points < 2) return std::numeric_limits<double>::quiet_NaN();
  double correction = 1 + (inverse - 1 / dof) / (3 * (points - 1));
  if (streams_ == Streams::matched) {
    // Residuals of two points correlate by -1/(n - 1), and the logarithms of their squares by the
    // square of this, so variances differ less than independent ones.
    correction *= 1 - 1 / square(static_cast<double>(n_points()) - 1);
  }
  return chi_squared_tail((dof * std::log(squares / dof) - logarithms) / correction, points - 1);
}

ErrorOf SweepCurve::error_of(std::span<const double> coefficients) const {
  assert(coefficients.size() == n_points());
  if (streams_ == Streams::matched) return matched_error_of(coefficients);
  if (!pools()) return own_error_of(coefficients);
  if (!pooled_.known()) return {};
  double sum = 0;
  for (std::size_t i = 0; i < n_points(); ++i) {
    const double count = has_realizations() ? static_cast<double>(count_[i]) : 1;
    sum += square(coefficients[i]) / count;
  }
  return {pooled_.error * std::sqrt(sum), pooled_.dof};
}

ErrorOf SweepCurve::own_error_of(std::span<const double> coefficients) const {
  std::optional<ErrorOf> sum;
  for (std::size_t i = 0; i < n_points(); ++i) {
    if (coefficients[i] == 0) continue;
    const ErrorOf term{std::abs(coefficients[i]) * error_[i].error, error_[i].dof};
    sum = sum ? combined(*sum, term) : term;
  }
  return sum.value_or(ErrorOf{0, 1});
}

ErrorOf SweepCurve::matched_error_of(std::span<const double> coefficients) const {
  if (common_.size() < 2) return {};
  const auto m = static_cast<double>(common_.size());
  if (!pools() || n_points() == 1) {
    Moments sums;
    for (const std::size_t r : common_) {
      double sum = 0;
      for (std::size_t i = 0; i < n_points(); ++i) sum += coefficients[i] * realizations_[i][r];
      sums.add(sum);
    }
    return {sums.standard_error(), m - 1};
  }
  const double mean = folded(coefficients).mean();
  std::vector<double> contrast;
  for (const double c : coefficients) contrast.push_back(c - mean);
  const double total = mean * static_cast<double>(n_points());
  const ErrorOf pooled_error{pooled_.error * std::sqrt(sum_of_squares(contrast) / m), pooled_.dof};
  const ErrorOf shared{std::abs(total) * level_.error / std::sqrt(m), level_.dof};
  const double size = std::sqrt(sum_of_squares(coefficients));
  return std::abs(total) < 1e-10 * size ? pooled_error : combined(pooled_error, shared);
}

}  // namespace jostle::inline ensemble
