#pragma once

#include <variant>

#include "fitting/fit.hpp"

// Errors that a user gives with a curve, and that were computed from the measured X: as the root of
// a count, or as a share of X. A low X then has a small error and a large weight, which biases the
// fit (Neyman's chi2; Pearson's takes the errors at the law).
namespace jostle::inline fitting {

/// The power of the measured X that given errors follow from point to point, in [0, 1]: 1/2 for the
/// roots of counts, 1 for shares of X. 0 where they do not follow X: constant errors, errors that
/// vary along the curve alone, or whose regression on the residuals of ln X is not significant.
/// fitted: [n_points], a law close to the curve.
double noise_exponent(const Curve& curve, const std::vector<double>& fitted);

/// fit() with the errors as they are given.
std::variant<Fit, Refusal> fit_as_given(const Model& model, const Curve& curve,
                                        const FitOptions& options);

}  // namespace jostle::inline fitting
