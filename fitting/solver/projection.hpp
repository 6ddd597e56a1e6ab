#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fitting/models/model.hpp"

namespace jostle::inline fitting {

/// Solves for the parameters in which a law is linear, at given values of the others, which costs
/// one decomposition and no descent (variable projection, Golub & Pereyra 1973). Keeps references
/// to model and curve.
class Projection {
 public:
  /// A parameter with a finite value in `fixed` [n_parameters] is not solved for; NaN marks those
  /// that are free.
  Projection(const Model& model, const Curve& curve, std::span<const double> fixed,
             double level_weight = 1);

  /// Fills the linear entries of p; returns the weighted sum of squares of X - model, infinite
  /// where there is none or a linear parameter leaves its bounds.
  double operator()(ParameterValues& p);

 private:
  void solve(ParameterValues& p);

  const Model& model_;
  const Curve& curve_;
  std::vector<std::size_t> linear_;
  Eigen::MatrixXd basis_;
  Eigen::VectorXd rest_;
  double level_weight_;
  std::vector<double> weight_;  // [n_points]
};

}  // namespace jostle::inline fitting
