#pragma once

#include <Eigen/Core>

#include "fitting/curve.hpp"

namespace jostle::inline fitting {

/// Degrees of freedom of clustered errors where realizations are missing at some t: those that stay
/// carry more of a parameter than those that leave, and its variance is estimated from fewer than
/// n_realizations - 1 (Satterthwaite 1946, doi:10.2307/3002019; Bell & McCaffrey 2002 for
/// clusters). In a realization's variance of a parameter, the part of its offset is equal for all;
/// the part of its noise grows with the weight that its values have and with their memory, taken
/// from the correlation of neighbouring points. Returns the least over the variables, from 1 to
/// n_realizations - 1. jacobian: [n_points, n_variables], weighted; the curve has `present`,
/// `offsets` and sigma.
double gapped_dof(const Eigen::MatrixXd& jacobian, const Curve& curve);

}  // namespace jostle::inline fitting
