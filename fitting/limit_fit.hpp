#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "fitting/fit.hpp"
#include "fitting/models/limit.hpp"

// Fits of a law whose least squares lie where some of its parameters are 0 or infinite: the law of
// fewer parameters that it becomes there is fitted instead.
namespace jostle::inline fitting {

/// A limit of a law with its own least squares over all points of a curve.
struct LimitCandidate {
  Limit limit;
  FitOptions options;  // options of the limit's law: the fixed parameters
  double cost = 0;
  std::size_t dof = 0;
};

/// The limits of a law that a curve can be fitted by, in the order of the law. Limits without a
/// fixed parameter of the law are left out.
std::vector<LimitCandidate> limit_candidates(const Model& model, const Curve& curve,
                                             const FitOptions& options);

/// The first candidate whose least squares are as low as `cost`, those of the law with `dof`
/// degrees of freedom, but for what no interval could notice; or whose residuals are rounding.
/// Without a cost only the latter. Null where there is none.
const LimitCandidate* reached(const std::vector<LimitCandidate>& candidates, const Curve& curve,
                              std::optional<double> cost, std::size_t dof);

/// The fit of the limit's law, expressed in the parameters of the law: those that both have, with
/// their errors and intervals; the others without a value, with the limits that the curve sets
/// them.
std::variant<Fit, Refusal> fit_at_limit(const Model& model, const Curve& curve,
                                        const FitOptions& options, const LimitCandidate& candidate);

}  // namespace jostle::inline fitting
