#include "fitting/intervals/dependence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "fitting/numbers.hpp"
#include "fitting/solver/decompositions.hpp"

namespace jostle::inline fitting {

std::vector<std::size_t> in_order_of_t(const std::vector<double>& t) {
  std::vector<std::size_t> order(t.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return t[i]; });
  return order;
}

namespace {

constexpr double least_inflation =
    1e-12;  // realizations that agree in a variable, but for rounding

// Least share of J^T J that the curvature leaves of the second derivatives. With less the minimum
// is all but level in this direction, and no quadratic.
constexpr double least_stiffness = 0.1;

constexpr double constant_tolerance =
    1e-6;  // tolerance for a constant's squared length, outside the tangent
constexpr double least_level_weight = 1e-6;

// Linear map of least squares on residuals: an orthonormal basis Q of the Jacobian's columns, and
// for every variable the combination of Q^T r that is its change.
struct Influence {
  Eigen::MatrixXd basis;     // [n_points, n_variables]
  Eigen::MatrixXd changes;   // [n_variables, n_variables], a variable a column
  Eigen::MatrixXd relative;  // changes in units of the columns' norms

  /// The direction of a column of `changes`. The column itself overflows where the curve hardly
  /// depends on the variable.
  Eigen::VectorXd direction(Eigen::Index j) const {
    const Eigen::VectorXd plain = changes.col(j).normalized();
    if (plain.allFinite()) return plain;
    return relative.col(j).stableNormalized();
  }
};

Influence influence(const Eigen::MatrixXd& jacobian) {
  const Eigen::Index n = jacobian.cols();
  Eigen::VectorXd norms = jacobian.colwise().norm().transpose();
  for (double& norm : norms) norm = norm > 0 ? norm : 1;
  const Eigen::MatrixXd scaled = jacobian * norms.cwiseInverse().asDiagonal();
  auto [basis, triangle] = orthonormal_basis(scaled);
  // A direction that the Jacobian does not see is as uncertain as rounding allows.
  const double least = 1e-17 * triangle.diagonal().cwiseAbs().maxCoeff();
  for (double& diagonal : triangle.diagonal()) {
    if (std::abs(diagonal) <= least) diagonal = std::max(least, 1e-300);
  }
  Influence found;
  found.basis = std::move(basis);
  const auto lower = triangle.transpose().template triangularView<Eigen::Lower>();
  found.changes = lower.solve(Eigen::MatrixXd::Identity(n, n) * norms.cwiseInverse().asDiagonal());
  found.relative = lower.solve(Eigen::MatrixXd::Identity(n, n));
  return found;
}

// From the covariance of Q^T r in units of what independent points give.
// `compliance`: the inverse of the second derivatives of half the squares, in units of Q^T r; the
// identity where they are J^T J.
DependentErrors errors_of(const Influence& found, const Eigen::MatrixXd& scatter,
                          const Eigen::MatrixXd& compliance, double variance, double dof) {
  DependentErrors errors;
  const Eigen::MatrixXd moved = compliance * scatter * compliance;
  errors.covariance = found.changes.transpose() * (variance * moved) * found.changes;
  errors.independent = found.changes.transpose() * compliance * found.changes;
  errors.inflation.resize(found.changes.cols());
  for (Eigen::Index j = 0; j < errors.inflation.size(); ++j) {
    const Eigen::VectorXd direction = found.direction(j);
    const double ratio = direction.dot(moved * direction) / direction.dot(compliance * direction);
    errors.inflation[j] = std::isfinite(ratio) ? std::max(ratio, least_inflation) : 1;
    // The curve hardly depends on the variable.
    if (std::isnan(errors.covariance(j, j))) errors.covariance(j, j) = infinite;
  }
  errors.dof = dof;
  return errors;
}

Eigen::MatrixXd identity(const Influence& found) {
  return Eigen::MatrixXd::Identity(found.changes.rows(), found.changes.rows());
}

Eigen::MatrixXd compliance_of(const Influence& found, const Curvature& curvature) {
  if (!curvature) return identity(found);
  const Eigen::MatrixXd added = curvature(found.changes.transpose());
  if (!added.allFinite()) return identity(found);
  // Singular values of a positive matrix with these eigenvectors: a symmetric one's are its
  // eigenvalues without signs.
  const double shift = 1 + added.norm();
  const auto [values, vectors] = singular_values(added + shift * identity(found));
  const Eigen::VectorXd stiffness = (values.array() - shift + 1).max(least_stiffness).matrix();
  return vectors * stiffness.cwiseInverse().asDiagonal() * vectors.transpose();
}

}  // namespace

DependentErrors clustered_errors(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& deviations,
                                 const Curvature& curvature) {
  const Influence found = influence(jacobian);
  const Eigen::MatrixXd projected = found.basis.transpose() * deviations;
  const auto m = static_cast<double>(deviations.cols());
  return errors_of(found, projected * projected.transpose() / (m * (m - 1)),
                   compliance_of(found, curvature), 1, m - 1);
}

double level_weight(const std::vector<double>& weights, const Eigen::MatrixXd& jacobian,
                    const Eigen::MatrixXd& deviations) {
  const Eigen::Map<const Eigen::VectorXd> points(weights.data(),
                                                 static_cast<Eigen::Index>(weights.size()));
  const Eigen::VectorXd level = points.normalized();
  const Eigen::VectorXd tangent = influence(jacobian).basis.transpose() * level;
  if (!(tangent.squaredNorm() > 1 - constant_tolerance)) return 1;
  const double of_level = (level.transpose() * deviations).squaredNorm();
  const double of_others =
      (deviations.squaredNorm() - of_level) / static_cast<double>(deviations.rows() - 1);
  if (!(of_others > 0) || !(of_level > of_others)) return 1;
  return std::max(std::sqrt(of_others / of_level), least_level_weight);
}

MemoryErrors memory_errors(const std::vector<double>& t, const Eigen::MatrixXd& jacobian,
                           const Eigen::VectorXd& residuals, bool sigma_given) {
  const Influence found = influence(jacobian);
  const auto independent = static_cast<double>(residuals.size() - jacobian.cols());
  const double unit = sigma_given ? 1 : residuals.squaredNorm() / independent;
  Memory memory = residual_memory(t, residuals, found.basis);
  // Residuals below the errors given show no noise, and so no memory of it.
  const double share = std::min(memory.variance / unit, sigma_given ? 1.0 : infinite);
  Eigen::MatrixXd scatter = share * found.basis.transpose() * correlated(t, memory, found.basis);
  const double dof = memory.effective_size - static_cast<double>(jacobian.cols());
  // Without a memory the scatter is the identity but for rounding, which must not decide.
  const bool longer = memory.time > 0 && scatter.diagonal().maxCoeff() > 1;
  if (sigma_given && !longer) {
    scatter.setIdentity();
    memory = {.variance = memory.variance, .effective_size = static_cast<double>(t.size())};
    return {errors_of(found, scatter, identity(found), 1, infinite), memory};
  }
  return {errors_of(found, scatter, identity(found), unit, dof), memory};
}

namespace {

// The change of a variable per change of each mean: [n_points] a variable.
Eigen::MatrixXd gains(const Eigen::MatrixXd& jacobian, const Curve& curve) {
  const auto n = jacobian.rows();
  Eigen::VectorXd norms = jacobian.colwise().norm().transpose();
  for (double& norm : norms) norm = norm > 0 ? norm : 1;
  const auto [basis, triangle] = orthonormal_basis(jacobian * norms.cwiseInverse().asDiagonal());
  // R^-1 Q^T: rows are gains.
  Eigen::MatrixXd weights = least_squares_of_columns(triangle, basis.transpose()).transpose();
  for (Eigen::Index i = 0; i < n; ++i) weights.row(i) /= curve.sigma[static_cast<std::size_t>(i)];
  return weights;
}

// The correlation of a realization's noise from one point to the next in t, over all realizations;
// in [0, 1). A level taken off n values lowers it by about (1 + 3 rho)/n (Kendall 1954,
// doi:10.1093/biomet/41.3-4.403).
double noise_memory(const Curve& curve, const std::vector<std::size_t>& order) {
  const std::size_t m = curve.n_realizations;
  double products = 0, squares = 0, pairs = 0;
  for (std::size_t r = 0; r < m; ++r) {
    const auto noise = [&](std::size_t i) {
      double n_others = -1;
      for (std::size_t realization = 0; realization < m; ++realization)
        n_others += curve.present[i * m + realization];
      return (curve.values[i * m + r] - curve.x[i] - curve.offsets[r]) * n_others;
    };
    for (std::size_t k = 1; k < order.size(); ++k) {
      const std::size_t last = order[k - 1], i = order[k];
      if (curve.present[last * m + r] == 0 || curve.present[i * m + r] == 0) continue;
      const double previous = noise(last), now = noise(i);
      products += previous * now;
      squares += (previous * previous + now * now) / 2;
      ++pairs;
    }
  }
  if (!(squares > 0)) return 0;
  const double rho = products / squares, per_level = pairs / static_cast<double>(m);
  constexpr double longest = 0.999;
  return std::clamp(rho + (1 + 3 * rho) / per_level, 0.0, longest);
}

// Variance of the sum of noise with that memory and these weights, in variances of one value.
double variance_of_sum(const std::vector<double>& weights, double memory,
                       const std::vector<std::size_t>& order) {
  double sum = 0, remembered = 0;
  for (const std::size_t i : order) {
    const double weight = weights[i];
    remembered = memory * remembered + weight;
    sum += weight * (2 * remembered - weight);
  }
  return sum;
}

}  // namespace

double gapped_dof(const Eigen::MatrixXd& jacobian, const Curve& curve) {
  const std::size_t m = curve.n_realizations;
  const auto count = static_cast<double>(m);
  const Eigen::MatrixXd gain = gains(jacobian, curve);
  const std::vector<std::size_t> order = in_order_of_t(curve.t);
  const double memory = noise_memory(curve, order);
  double least = count - 1;
  for (Eigen::Index j = 0; j < gain.cols(); ++j) {
    std::vector<double> changes(m, 0.0), noise(m, 0.0);
    std::vector<std::vector<double>> shares(m, std::vector<double>(curve.t.size(), 0.0));
    double offset_gain = 0;
    for (std::size_t i = 0; i < curve.t.size(); ++i) {
      const double g = gain(static_cast<Eigen::Index>(i), j);
      const auto row = curve.present.begin() + static_cast<std::ptrdiff_t>(i * m);
      const auto present =
          static_cast<double>(std::count(row, row + static_cast<std::ptrdiff_t>(m), 1));
      offset_gain += g;
      for (std::size_t r = 0; r < m; ++r) {
        changes[r] += g * (curve.values[i * m + r] - curve.x[i]);
        // The change of the mean where it is left out, as in the errors.
        if (curve.present[i * m + r] != 0) shares[r][i] = g / (present - 1);
      }
    }
    for (std::size_t r = 0; r < m; ++r) noise[r] = variance_of_sum(shares[r], memory, order);
    double all = 0, of_offsets = 0, of_noise = 0;
    for (std::size_t r = 0; r < m; ++r) {
      all += changes[r] * changes[r];
      of_offsets += std::pow(offset_gain * curve.offsets[r], 2);
      of_noise += noise[r];
    }
    if (!(all > 0) || !(of_noise > 0)) continue;
    const double share = std::min(1.0, of_offsets / all);
    double squares = 0;
    for (const double value : noise) {
      squares += std::pow(share / count + (1 - share) * value / of_noise, 2);
    }
    least = std::min(least, (count - 1) / count / squares);
  }
  return std::max(1.0, least);
}

}  // namespace jostle::inline fitting
