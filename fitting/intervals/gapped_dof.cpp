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

}  // namespace

double gapped_dof(const Eigen::MatrixXd& jacobian, const Curve& curve) {
  const std::size_t m = curve.n_realizations;
  const auto count = static_cast<double>(m);
  const Eigen::MatrixXd gain = gains(jacobian, curve);
  double least = count - 1;
  for (Eigen::Index j = 0; j < gain.cols(); ++j) {
    std::vector<double> changes(m, 0.0), noise(m, 0.0);
    double offset_gain = 0;
    for (std::size_t i = 0; i < curve.t.size(); ++i) {
      const double g = gain(static_cast<Eigen::Index>(i), j);
      const auto row = curve.present.begin() + static_cast<std::ptrdiff_t>(i * m);
      const auto present =
          static_cast<double>(std::count(row, row + static_cast<std::ptrdiff_t>(m), 1));
      offset_gain += g;
      for (std::size_t r = 0; r < m; ++r) {
        changes[r] += g * (curve.values[i * m + r] - curve.x[i]);
        if (curve.present[i * m + r] != 0) noise[r] += g * g / (present * present);
      }
    }
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
