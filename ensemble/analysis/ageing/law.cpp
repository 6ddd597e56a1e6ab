#include "ensemble/analysis/ageing/law.hpp"

#include <algorithm>
#include <cmath>

#include "engine/numbers.hpp"
#include "ensemble/statistics/student_tests.hpp"
#include "fitting/intervals/distributions.hpp"
#include "fitting/solver/decompositions.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr double step = 0.2;    // step of the grid, in ln B, ln tau and ln A_inf
constexpr double farthest = 7;  // largest distance of ln A_inf from its best value: a factor 1100
constexpr double ln_of_1000 = 6.907755278982137;
constexpr double ln_b_range[] = {-ln_of_1000, ln_of_1000};

std::vector<double> places(double low, double high) {
  const auto n = static_cast<std::size_t>(std::ceil((high - low) / step));
  std::vector<double> all;
  for (std::size_t i = 0; i <= n; ++i) {
    all.push_back(std::lerp(low, high, static_cast<double>(i) / static_cast<double>(n)));
  }
  return all;
}

Eigen::MatrixXd without_column(const Eigen::MatrixXd& matrix, std::size_t column) {
  const auto i = static_cast<Eigen::Index>(column);
  Eigen::MatrixXd rest(matrix.rows(), matrix.cols() - 1);
  rest << matrix.leftCols(i), matrix.rightCols(matrix.cols() - i - 1);
  return rest;
}

}  // namespace

Eigen::VectorXd beyond_others(const Eigen::VectorXd& column, const Eigen::MatrixXd& other_columns) {
  return column - other_columns * least_squares(other_columns, column);
}

double ln_eq_6(double lag, double ln_b, double ln_tau) {
  const double x = std::exp(ln_b) * std::log1p(lag * std::exp(-ln_tau));
  return std::log(x / (1 + x));
}

AgeingLeastSquares::AgeingLeastSquares(LogCurves curves, std::optional<double> held_ln_b)
    : curves_(std::move(curves)),
      ln_b_(held_ln_b ? std::vector{*held_ln_b} : places(ln_b_range[0], ln_b_range[1])) {
  const auto [least, most] = std::ranges::minmax(curves_.lags);
  ln_tau_ = places(std::log(0.01 * least), std::log(1e4 * most));
  fill_cells();
  best_ = refined(on_grid({}, 0), {});
  describes_ = describes_curves();
}

void AgeingLeastSquares::fill_cells() {
  cells_.resize(curves_.size() * ln_b_.size() * ln_tau_.size());
  Eigen::ArrayXd logarithm(curves_.ln_a.size());  // ln(1 + t / tau)
  for (std::size_t tau = 0; tau < ln_tau_.size(); ++tau) {
    const double rate = std::exp(-ln_tau_[tau]);
    for (std::size_t i = 0; i < curves_.lags.size(); ++i) {
      logarithm[static_cast<Eigen::Index>(i)] = std::log1p(curves_.lags[i] * rate);
    }
    for (std::size_t b = 0; b < ln_b_.size(); ++b) {
      const Eigen::ArrayXd x = std::exp(ln_b_[b]) * logarithm;
      const Eigen::ArrayXd residual = curves_.ln_a.array() - (x / (1 + x)).log();
      for (std::size_t k = 0; k < curves_.size(); ++k) {
        const auto first = static_cast<Eigen::Index>(curves_.first[k]);
        const auto own =
            residual.segment(first, static_cast<Eigen::Index>(curves_.first[k + 1]) - first);
        const double mean = own.mean();
        cells_[(k * ln_b_.size() + b) * ln_tau_.size() + tau] = {mean, (own - mean).square().sum()};
      }
    }
  }
  best_tau_.assign(curves_.size(), {});
  for (std::size_t k = 0; k < curves_.size(); ++k) {
    for (std::size_t b = 0; b < ln_b_.size(); ++b) {
      const Cell* const row = &cell(k, b, 0);
      best_tau_[k].push_back(static_cast<std::size_t>(
          std::ranges::min_element(row, row + ln_tau_.size(), {}, &Cell::squares) - row));
    }
  }
}

const AgeingLeastSquares::Cell& AgeingLeastSquares::cell(std::size_t curve, std::size_t b,
                                                         std::size_t tau) const {
  return cells_[(curve * ln_b_.size() + b) * ln_tau_.size() + tau];
}

Eigen::VectorXd AgeingLeastSquares::on_grid(std::optional<std::size_t> held, double value) const {
  const bool holds_b = held == b(), holds_tau = held && !holds_b && *held % 2 == 1;
  const std::size_t own = held && !holds_b ? *held / 2 : curves_.size();
  const auto nearest = [&](const std::vector<double>& grid) {
    return static_cast<std::size_t>(
        std::ranges::min_element(grid, {}, [&](double x) { return std::abs(x - value); }) -
        grid.begin());
  };
  // For the curve whose parameter is held, with B at a place.
  const auto own_tau = [&](std::size_t i) -> std::pair<std::size_t, double> {
    if (holds_tau) {
      const std::size_t tau = nearest(ln_tau_);
      return {tau, cell(own, i, tau).squares};
    }
    const auto n = static_cast<double>(curves_.first[own + 1] - curves_.first[own]);
    std::pair<std::size_t, double> least = {0, infinite};
    for (std::size_t tau = 0; tau < ln_tau_.size(); ++tau) {
      const auto& [mean, squares] = cell(own, i, tau);
      const double cost = squares + n * (mean - value) * (mean - value);
      if (cost < least.second) least = {tau, cost};
    }
    return least;
  };
  std::size_t best_b = 0;
  double least = infinite;
  for (std::size_t i = 0; i < ln_b_.size(); ++i) {
    if (holds_b && i != nearest(ln_b_)) continue;
    double cost = 0;
    for (std::size_t k = 0; k < curves_.size(); ++k) {
      cost += k == own ? own_tau(i).second : cell(k, i, best_tau_[k][i]).squares;
    }
    if (cost < least) least = cost, best_b = i;
  }
  Eigen::VectorXd parameters(static_cast<Eigen::Index>(b() + 1));
  parameters[static_cast<Eigen::Index>(b())] = ln_b_[best_b];
  for (std::size_t k = 0; k < curves_.size(); ++k) {
    const std::size_t i = k == own ? own_tau(best_b).first : best_tau_[k][best_b];
    parameters[static_cast<Eigen::Index>(tau(k))] = ln_tau_[i];
    parameters[static_cast<Eigen::Index>(a_inf(k))] = cell(k, best_b, i).mean;
  }
  if (held) parameters[static_cast<Eigen::Index>(*held)] = value;
  return parameters;
}

Eigen::VectorXd AgeingLeastSquares::refined(Eigen::VectorXd parameters,
                                            std::optional<std::size_t> held) const {
  const auto low = [&](std::size_t j) { return j == b() ? ln_b_.front() : ln_tau_.front(); };
  const auto high = [&](std::size_t j) { return j == b() ? ln_b_.back() : ln_tau_.back(); };
  Eigen::VectorXd residual = residuals(parameters);
  for (int i = 0; i < 20; ++i) {
    const Eigen::MatrixXd j = slopes(parameters);
    const auto change_without = [&](std::size_t column) {
      const Eigen::VectorXd other_columns = least_squares(without_column(j, column), residual);
      const auto h = static_cast<Eigen::Index>(column);
      Eigen::VectorXd change = Eigen::VectorXd::Zero(parameters.size());
      change << other_columns.head(h), 0, other_columns.tail(other_columns.size() - h);
      return change;
    };
    Eigen::VectorXd change = held ? change_without(*held) : least_squares(j, residual);
    // A B at the end of its range stays there, and the other parameters are fitted to it.
    const auto b_index = static_cast<Eigen::Index>(b());
    const double b_change = b_is_held() ? 0 : change[b_index];
    if (!held && ((b_change < 0 && parameters[b_index] <= low(b())) ||
                  (b_change > 0 && parameters[b_index] >= high(b()))))
      change = change_without(b());
    Eigen::VectorXd next = parameters;
    for (std::size_t p = 0; p <= b(); ++p) {
      const auto index = static_cast<Eigen::Index>(p);
      const bool is_a_inf = p != b() && p % 2 == 0;
      next[index] += is_a_inf ? change[index] : std::clamp(change[index], -step, step);
      if (!is_a_inf && held != p) next[index] = std::clamp(next[index], low(p), high(p));
    }
    const Eigen::VectorXd next_off = residuals(next);
    const double cost = residual.squaredNorm(), next_cost = next_off.squaredNorm();
    if (!(next_cost < cost)) break;
    parameters = next;
    residual = next_off;
    if (next_cost > cost * (1 - 1e-9)) break;
  }
  return parameters;
}

bool AgeingLeastSquares::describes_curves() const {
  constexpr double level = 0.95;
  const auto falls_on = [&](std::size_t parameter) {
    const Eigen::VectorXd weights = weights_of(parameter, best_);
    const ErrorOf error = error_of_sum(curves_, weights);
    return std::abs(weights.dot(residuals(best_))) >
           student_two_sided(level, error.dof) * error.error;
  };
  for (std::size_t k = 0; k < curves_.size(); ++k)
    if (falls_on(tau(k))) return false;
  return b_is_held() || !falls_on(b());
}

Eigen::MatrixXd AgeingLeastSquares::slopes(const Eigen::VectorXd& parameters) const {
  Eigen::MatrixXd all =
      Eigen::MatrixXd::Zero(curves_.ln_a.size(), static_cast<Eigen::Index>(b() + 1));
  const double b_here = std::exp(parameters[static_cast<Eigen::Index>(b())]);
  for (std::size_t k = 0; k < curves_.size(); ++k) {
    const double rate = std::exp(-parameters[static_cast<Eigen::Index>(tau(k))]);
    for (std::size_t i = curves_.first[k]; i < curves_.first[k + 1]; ++i) {
      // ln A = ln A_inf + ln x - ln(1 + x), x = B ln(1 + t / tau).
      const auto row = static_cast<Eigen::Index>(i);
      const double scaled = curves_.lags[i] * rate, logarithm = std::log1p(scaled);
      const double by_ln_x = 1 / (1 + b_here * logarithm);
      all(row, static_cast<Eigen::Index>(a_inf(k))) = 1;
      all(row, static_cast<Eigen::Index>(tau(k))) = -by_ln_x * scaled / ((1 + scaled) * logarithm);
      if (!b_is_held()) all(row, static_cast<Eigen::Index>(b())) = by_ln_x;
    }
  }
  return all;
}

Eigen::VectorXd AgeingLeastSquares::residuals(const Eigen::VectorXd& parameters) const {
  Eigen::VectorXd residual = curves_.ln_a;
  for (std::size_t k = 0; k < curves_.size(); ++k) {
    for (std::size_t i = curves_.first[k]; i < curves_.first[k + 1]; ++i) {
      residual[static_cast<Eigen::Index>(i)] -=
          parameters[static_cast<Eigen::Index>(a_inf(k))] +
          ln_eq_6(curves_.lags[i], parameters[static_cast<Eigen::Index>(b())],
                  parameters[static_cast<Eigen::Index>(tau(k))]);
    }
  }
  return residual;
}

Eigen::VectorXd AgeingLeastSquares::weights_of(std::size_t parameter,
                                               const Eigen::VectorXd& parameters) const {
  const Eigen::MatrixXd all = slopes(parameters);
  return beyond_others(all.col(static_cast<Eigen::Index>(parameter)),
                       without_column(all, parameter));
}

double AgeingLeastSquares::t_of(std::size_t parameter, double value) const {
  const Eigen::VectorXd parameters = refined(on_grid(parameter, value), parameter);
  const Eigen::VectorXd weights = weights_of(parameter, parameters);
  return weights.dot(residuals(parameters)) / error_of_sum(curves_, weights).error;
}

LogEstimate AgeingLeastSquares::estimate(std::size_t parameter) const {
  const double best = best_[static_cast<Eigen::Index>(parameter)];
  const std::vector<double> values = parameter == b() ? ln_b_
                                     : parameter % 2 == 1
                                         ? ln_tau_
                                         : places(best - farthest, best + farthest);
  const Eigen::VectorXd weights = weights_of(parameter, best_);
  const ErrorOf error = error_of_sum(curves_, weights / weights.squaredNorm());
  TestedEnds ends{{-infinite, -infinite}, {infinite, infinite}};
  if (describes_) {
    ends =
        tested_ends(values, best, error.dof, [&](double value) { return t_of(parameter, value); });
  }
  const double value = std::exp(best);
  return {value,
          value * error.error,
          std::exp(ends.low[0]),
          std::exp(ends.high[0]),
          std::exp(ends.low[1]),
          std::exp(ends.high[1])};
}

}  // namespace jostle::inline ensemble
