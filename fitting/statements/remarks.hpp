#pragma once

#include <cstddef>

#include "fitting/fit.hpp"

// Sentences that a fit states about itself, for people who read its parameters.
namespace jostle::inline fitting {

/// On a search that did not settle, and on points that leave nothing to test or to scatter.
void remark_on_end(const FitOptions& options, Fit& fit);
/// On the same curve in the order of its law, where fixed parameters keep their names and so the
/// others from that order.
void remark_on_order(const Model& model, const ParameterValues& values, Fit& fit);
/// The only remark on the limit of evaluations. `allowed`: the limit of this fit, below the
/// options' for laws of more than `few_parameters`.
void remark_on_budget(long long allowed, std::size_t few_parameters, const FitOptions& options,
                      Fit& fit);

}  // namespace jostle::inline fitting
