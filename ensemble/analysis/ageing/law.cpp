#include "ensemble/analysis/ageing/law.hpp"

#include <algorithm>
#include <cmath>

#include "engine/numbers.hpp"
#include "ensemble/statistics/student_tests.hpp"
#include "fitting/intervals/distributions.hpp"
#include "fitting/solver/decompositions.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr double step = 0.2;        // step of the grid, in ln B, ln tau and ln A_inf
constexpr double longest_step = 2;  // longest step of the descent, in ln B and ln tau
constexpr double settled = 1e-13;   // share of the squares by which a last step falls
constexpr double flat = 1e-7;       // cosine of residuals and a slope: a valley without an end
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

/// The least cost near the least of equally spaced ones, by a parabola: a valley narrower than the
/// grid has its lowest point between places.
struct Lowest {
  double place, cost;  // place: in steps
};
Lowest lowest_of(const std::vector<double>& costs) {
  const auto i = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
  const Lowest nearest{static_cast<double>(i), costs[i]};
  if (i == 0 || i + 1 == costs.size()) return nearest;
  const double curvature = costs[i - 1] - 2 * costs[i] + costs[i + 1];
  if (!(curvature > 0)) return nearest;
  const double difference = costs[i - 1] - costs[i + 1];
  return {nearest.place + 0.5 * difference / curvature,
          std::max(0.0, costs[i] - difference * difference / (8 * curvature))};
}

}  // namespace

Eigen::VectorXd beyond_others(const Eigen::VectorXd& column, const Eigen::MatrixXd& other_columns) {
  if (other_columns.cols() == 0) return column;
  return column - other_columns * least_squares(other_columns, column);
}

double ln_eq_6(double lag, double ln_b, double ln_tau) {
  const double x = std::exp(ln_b) * std::log1p(lag * std::exp(-ln_tau));
  return std::log(x / (1 + x));
}

AgeingLeastSquares::AgeingLeastSquares(LogCurves curves, std::optional<double> held_ln_b)
    : curves_(std::move(curves)),
      ln_b_(held_ln_b ? std::vector{*held_ln_b} : places(ln_b_range[0], ln_b_range[1])) {
  const auto [shortest, longest] = std::ranges::minmax(curves_.lags);
  ln_tau_ = places(std::log(0.01 * shortest), std::log(1e4 * longest));
  fill_cells();
  best_ = lowest_point();
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
  least_.assign(curves_.size(), {});
  std::vector<double> costs(ln_tau_.size());
  for (std::size_t k = 0; k < curves_.size(); ++k) {
    for (std::size_t b = 0; b < ln_b_.size(); ++b) {
      for (std::size_t tau = 0; tau < costs.size(); ++tau) costs[tau] = cell(k, b, tau).squares;
      const Lowest lowest = lowest_of(costs);
      best_tau_[k].push_back(ln_tau_at(lowest.place));
      least_[k].push_back(lowest.cost);
    }
  }
}

const AgeingLeastSquares::Cell& AgeingLeastSquares::cell(std::size_t curve, std::size_t b,
                                                         std::size_t tau) const {
  return cells_[(curve * ln_b_.size() + b) * ln_tau_.size() + tau];
}

double AgeingLeastSquares::ln_tau_at(double place) const {
  return ln_tau_.front() + place * (ln_tau_[1] - ln_tau_[0]);
}

AgeingLeastSquares::Place AgeingLeastSquares::place_with(std::size_t held, double value,
                                                         std::size_t b) const {
  const std::size_t curve = held / 2;
  std::vector<double> costs(ln_tau_.size());
  const bool holds_tau = !is_scale(held);
  const auto n = static_cast<double>(curves_.first[curve + 1] - curves_.first[curve]);
  for (std::size_t tau = 0; tau < costs.size(); ++tau) {
    const auto& [mean, squares] = cell(curve, b, tau);
    costs[tau] = squares + (holds_tau ? 0 : n * (mean - value) * (mean - value));
  }
  if (!holds_tau) {
    const Lowest lowest = lowest_of(costs);
    return {ln_tau_at(lowest.place), lowest.cost};
  }
  const double place = std::clamp((value - ln_tau_[0]) / (ln_tau_[1] - ln_tau_[0]), 0.0,
                                  static_cast<double>(costs.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(place), costs.size() - 2);
  return {value, std::lerp(costs[i], costs[i + 1], place - static_cast<double>(i))};
}

Eigen::VectorXd AgeingLeastSquares::at_b(std::size_t place, std::optional<std::size_t> held,
                                         double value) const {
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(b() + 1));
  parameters[static_cast<Eigen::Index>(b())] = held == b() ? value : ln_b_[place];
  for (std::size_t k = 0; k < curves_.size(); ++k) {
    const bool is_own = held && *held != b() && *held / 2 == k;
    parameters[static_cast<Eigen::Index>(tau(k))] =
        is_own ? place_with(*held, value, place).ln_tau : best_tau_[k][place];
  }
  if (held) parameters[static_cast<Eigen::Index>(*held)] = value;
  return stepped(parameters, {}, {}, held);
}

Eigen::VectorXd AgeingLeastSquares::on_grid(std::optional<std::size_t> held, double value) const {
  std::size_t best_b = 0;
  if (held == b()) {
    best_b = static_cast<std::size_t>(
        std::ranges::min_element(ln_b_, {}, [&](double x) { return std::abs(x - value); }) -
        ln_b_.begin());
    return at_b(best_b, held, value);
  }
  double lowest = infinite;
  for (std::size_t i = 0; i < ln_b_.size(); ++i) {
    double cost = 0;
    for (std::size_t k = 0; k < curves_.size(); ++k) {
      cost += held && *held / 2 == k ? place_with(*held, value, i).cost : least_[k][i];
    }
    if (cost < lowest) lowest = cost, best_b = i;
  }
  return at_b(best_b, held, value);
}

bool AgeingLeastSquares::is_on_edge(std::size_t parameter, const Eigen::VectorXd& parameters,
                                    double slope) const {
  if (is_scale(parameter)) return false;
  if (parameter == b() && std::abs(slope) < flat) {
    const double value = parameters[static_cast<Eigen::Index>(b())];
    return value <= ln_b_.front() || value >= ln_b_.back();
  }
  const std::vector<double>& grid = parameter == b() ? ln_b_ : ln_tau_;
  const double value = parameters[static_cast<Eigen::Index>(parameter)];
  return (slope < 0 && value <= grid.front()) || (slope > 0 && value >= grid.back());
}

std::vector<Eigen::Index> AgeingLeastSquares::free_parameters(
    const Eigen::VectorXd& parameters, const Eigen::MatrixXd& slopes,
    const Eigen::VectorXd& residual, std::optional<std::size_t> held) const {
  std::vector<Eigen::Index> free;
  for (std::size_t p = 0; p <= b(); ++p) {
    const auto column = static_cast<Eigen::Index>(p);
    if (p == held || (p == b() && b_is_held())) continue;
    const double length = slopes.col(column).norm() * residual.norm();
    const double slope = slopes.col(column).dot(residual) / (length > 0 ? length : 1);
    if (!is_on_edge(p, parameters, slope)) free.push_back(column);
  }
  return free;
}

Eigen::VectorXd AgeingLeastSquares::stepped(Eigen::VectorXd parameters,
                                            const std::vector<Eigen::Index>& free,
                                            const Eigen::VectorXd& change,
                                            std::optional<std::size_t> held) const {
  double longest = 0;  // change, without those of scales
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (!is_scale(static_cast<std::size_t>(free[i])))
      longest = std::max(longest, std::abs(change[static_cast<Eigen::Index>(i)]));
  }
  const double share = longest > longest_step ? longest_step / longest : 1;
  for (std::size_t i = 0; i < free.size(); ++i) {
    double& value = parameters[free[i]];
    value += share * change[static_cast<Eigen::Index>(i)];
    const auto p = static_cast<std::size_t>(free[i]);
    if (is_scale(p)) continue;
    const std::vector<double>& grid = p == b() ? ln_b_ : ln_tau_;
    value = std::clamp(value, grid.front(), grid.back());
  }
  // The law is linear in ln A_inf.
  const Eigen::VectorXd residual = residuals(parameters);
  for (std::size_t k = 0; k < curves_.size(); ++k) {
    if (a_inf(k) == held) continue;
    const auto first = static_cast<Eigen::Index>(curves_.first[k]);
    parameters[static_cast<Eigen::Index>(a_inf(k))] +=
        residual.segment(first, static_cast<Eigen::Index>(curves_.first[k + 1]) - first).mean();
  }
  return parameters;
}

// Levenberg-Marquardt; undamped until a step fails. A parameter at an edge that the squares push
// outwards stays there.
Eigen::VectorXd AgeingLeastSquares::refined(Eigen::VectorXd parameters,
                                            std::optional<std::size_t> held) const {
  constexpr int most_steps = 200;
  constexpr double first_damping = 1e-6, most_damping = 1e6;
  Eigen::VectorXd residual = residuals(parameters);
  double damping = 0;
  for (int i = 0; i < most_steps && damping < most_damping; ++i) {
    const Eigen::MatrixXd all = slopes(parameters);
    const std::vector<Eigen::Index> free = free_parameters(parameters, all, residual, held);
    const auto n = static_cast<Eigen::Index>(free.size());
    if (n == 0) break;
    Eigen::MatrixXd columns = all(Eigen::seqN(0, all.rows()), free);
    Eigen::VectorXd right = residual;
    if (damping > 0) {
      const Eigen::VectorXd scales = columns.colwise().norm();
      columns.conservativeResize(columns.rows() + n, Eigen::NoChange);
      columns.bottomRows(n) = (std::sqrt(damping) * scales).asDiagonal();
      right.conservativeResize(right.size() + n);
      right.tail(n).setZero();
    }
    const Eigen::VectorXd next = stepped(parameters, free, least_squares(columns, right), held);
    const Eigen::VectorXd next_residual = residuals(next);
    const double cost = residual.squaredNorm(), next_cost = next_residual.squaredNorm();
    if (!(next_cost < cost)) {
      if (damping == 0 && next_cost <= cost * (1 + settled)) break;
      damping = damping > 0 ? 10 * damping : first_damping;
      continue;
    }
    parameters = next;
    residual = next_residual;
    if (damping == 0 && next_cost > cost * (1 - settled)) break;
    damping = damping > first_damping ? damping / 10 : 0;
  }
  return parameters;
}

// A valley so flat that rounding stops a descent in it ends at the edge: a B and tau that cannot
// be distinguished leave A_inf an error that is not its own.
Eigen::VectorXd AgeingLeastSquares::fitted(const Eigen::VectorXd& start,
                                           std::optional<std::size_t> held) const {
  constexpr double near = 3, equal = 1e-9;
  const Eigen::VectorXd found = refined(start, held);
  const auto b_index = static_cast<Eigen::Index>(b());
  if (held == b() || b_is_held()) return found;
  for (const double edge : {ln_b_.front(), ln_b_.back()}) {
    const double distance = edge - found[b_index];
    if (distance == 0 || std::abs(distance) > near) continue;
    Eigen::VectorXd at_edge = found;
    at_edge[b_index] = edge;
    for (std::size_t k = 0; k < curves_.size(); ++k) {
      double& ln_tau = at_edge[static_cast<Eigen::Index>(tau(k))];
      if (held != tau(k)) ln_tau = std::clamp(ln_tau + distance, ln_tau_.front(), ln_tau_.back());
    }
    at_edge = refined(at_edge, held);
    if (residuals(at_edge).squaredNorm() <= residuals(found).squaredNorm() * (1 + equal))
      return at_edge;
  }
  return found;
}

Eigen::VectorXd AgeingLeastSquares::lowest_point() const {
  std::vector<double> profile;  // over B
  for (std::size_t i = 0; i < ln_b_.size(); ++i) {
    double cost = 0;
    for (std::size_t k = 0; k < curves_.size(); ++k) cost += least_[k][i];
    profile.push_back(cost);
  }
  Eigen::VectorXd best = fitted(on_grid({}, 0), {});
  double squares = residuals(best).squaredNorm();
  const std::size_t n = profile.size();
  for (std::size_t i = 0; n > 1 && i < n; ++i) {
    const bool is_lowest =
        (i == 0 || profile[i] <= profile[i - 1]) && (i + 1 == n || profile[i] <= profile[i + 1]);
    if (!is_lowest) continue;
    const Eigen::VectorXd found = fitted(at_b(i, {}, 0), {});
    const double found_squares = residuals(found).squaredNorm();
    if (found_squares < squares * (1 - settled)) squares = found_squares, best = found;
  }
  return best;
}

bool AgeingLeastSquares::describes_curves() const {
  // One test for each waiting time (Bonferroni): along the valley of the squares, those of B and tau
  // reject the same curves.
  const double level = 1 - significance_level / static_cast<double>(curves_.size());
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
  const auto fitted_ones = free_parameters(parameters, all, residuals(parameters), parameter);
  return beyond_others(all.col(static_cast<Eigen::Index>(parameter)),
                       all(Eigen::seqN(0, all.rows()), fitted_ones));
}

double AgeingLeastSquares::t_of(std::size_t parameter, double value) const {
  const Eigen::VectorXd parameters = fitted(on_grid(parameter, value), parameter);
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
