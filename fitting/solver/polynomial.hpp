#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace jostle::inline fitting {

/// Coefficients c_j, [coefficients], of the polynomial sum_j c_j ((x - origin) / scale)^j that
/// makes the sum of (weight (y - polynomial))^2 least; x, y, weights: [n_points]. Where points do
/// not decide all coefficients, one of the best. `origin` and `scale` (not zero) keep the powers
/// near one.
std::vector<double> polynomial_fit(std::span<const double> x, std::span<const double> y,
                                   std::span<const double> weights, std::size_t coefficients,
                                   double origin = 0, double scale = 1);

}  // namespace jostle::inline fitting
