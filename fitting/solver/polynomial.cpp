#include "fitting/solver/polynomial.hpp"

#include "fitting/solver/decompositions.hpp"

namespace jostle::inline fitting {

std::vector<double> polynomial_fit(std::span<const double> x, std::span<const double> y,
                                   std::span<const double> weights, std::size_t coefficients,
                                   double origin, double scale) {
  const auto n = static_cast<Eigen::Index>(x.size());
  const auto columns = static_cast<Eigen::Index>(coefficients);
  Eigen::MatrixXd matrix(n, columns);
  Eigen::VectorXd target(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    double power = weights[k];
    for (Eigen::Index j = 0; j < columns; ++j) {
      matrix(i, j) = power;
      power *= (x[k] - origin) / scale;
    }
    target[i] = weights[k] * y[k];
  }
  const Eigen::VectorXd c = least_squares(matrix, target);
  return {c.begin(), c.end()};
}

}  // namespace jostle::inline fitting
