#pragma once

#include <optional>

#include "fitting/fit.hpp"

namespace jostle::inline fitting {

/// Why there can be no fit of this model with these options, or of this curve: parameters and
/// starts that do not exist, fewer different t than the `n_free` parameters, constant X, t or X
/// outside what the law is defined for.
std::optional<Refusal> refuse_options(const Model& model, const FitOptions& options);
std::optional<Refusal> refuse_curve(const Model& model, const Curve& curve, std::size_t n_free);

}  // namespace jostle::inline fitting
