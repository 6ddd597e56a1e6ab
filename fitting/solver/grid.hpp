#pragma once

#include <functional>

#include "fitting/models/model.hpp"

namespace jostle::inline fitting {

/// Places to look for the nonlinear parameters of a law.
struct Grid {
  /// Values along every parameter, [n_parameters][any, at least 1], ascending; those of linear and
  /// of fixed parameters are ignored.
  std::vector<std::vector<double>> axes;
  /// Turns a combination of values into parameters where the axes are something else; false where
  /// the combination is to be left out.
  std::function<bool(ParameterValues&)> place = {};
};

/// The places that a grid keeps at most over `points`: fewer for more parameters, since each place
/// then takes longer. The last axes of a larger grid keep their middle value alone.
std::size_t most_places(std::size_t n_parameters, std::size_t points);

/// Evaluations of the law over `curve` that Model::starts() is worth: one for each place of the
/// grid of its candidates and each parameter, over the share of the points that are sampled.
long long evaluations_of_starts(const Model& model, const Curve& curve,
                                std::span<const double> fixed);

/// Starting points, at most `n`: first the combinations that are better than all their neighbours
/// on the grid, one for every valley that it resolves, then the best of the others, each best
/// first. Linear parameters are solved for; `fixed` [n_parameters] as for Projection. The grid has
/// at most most_places().
std::vector<ParameterValues> best_of_grid(const Model& model, const Curve& curve,
                                          std::span<const double> fixed, Grid grid, std::size_t n);

}  // namespace jostle::inline fitting
