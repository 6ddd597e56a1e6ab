#include "fitting/intervals/gapped_dof.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/solver/decompositions.hpp"

namespace jostle::inline fitting {

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

// The correlation of a realization's noise from one point to the next, over all realizations; in
// [0, 1). A level taken off n values lowers it by about (1 + 3 rho)/n (Kendall 1954,
// doi:10.1093/biomet/41.3-4.403).
double noise_memory(const Curve& curve) {
  const std::size_t m = curve.n_realizations, n = curve.t.size();
  double products = 0, squares = 0, pairs = 0;
  for (std::size_t r = 0; r < m; ++r) {
    const auto noise = [&](std::size_t i) {
      double others = -1;
      for (std::size_t other = 0; other < m; ++other) others += curve.present[i * m + other];
      return (curve.values[i * m + r] - curve.x[i] - curve.offsets[r]) * others;
    };
    for (std::size_t i = 1; i < n; ++i) {
      if (curve.present[(i - 1) * m + r] == 0 || curve.present[i * m + r] == 0) continue;
      const double before = noise(i - 1), now = noise(i);
      products += before * now;
      squares += (before * before + now * now) / 2;
      ++pairs;
    }
  }
  if (!(squares > 0)) return 0;
  const double rho = products / squares, per_level = pairs / static_cast<double>(m);
  constexpr double longest = 0.999;
  return std::clamp(rho + (1 + 3 * rho) / per_level, 0.0, longest);
}

// Variance of the sum of noise with that memory and these weights, in variances of one value.
double variance_of_sum(const std::vector<double>& weights, double memory) {
  double sum = 0, remembered = 0;
  for (const double weight : weights) {
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
  const double memory = noise_memory(curve);
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
    for (std::size_t r = 0; r < m; ++r) noise[r] = variance_of_sum(shares[r], memory);
    double all = 0, of_offsets = 0, of_noise = 0;
    for (std::size_t r = 0; r < m; ++r) {
      all += changes[r] * changes[r];
      of_offsets += std::pow(offset_gain * curve.offsets[r], 2);
      of_noise += noise[r];
    }
    if (!(all > 0) || !(of_noise > 0)) continue;
    const double share = std::min(1.0, of_offsets / all);
    double squares = 0;
    for (const double one : noise) {
      squares += std::pow(share / count + (1 - share) * one / of_noise, 2);
    }
    least = std::min(least, (count - 1) / count / squares);
  }
  return std::max(1.0, least);
}

}  // namespace jostle::inline fitting
