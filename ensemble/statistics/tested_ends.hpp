#pragma once

#include <functional>
#include <vector>

namespace jostle::inline ensemble {

/// Ends of an interval by tests of its values, [2 levels of interval_levels]: infinite where no
/// value on that side is refuted.
struct TestedEnds {
  double low[2], high[2];
};

/// Going outwards from the best value: where |t| first exceeds Student's at each level. Between
/// `values` (ascending) t is taken for linear, and 0 at the best. t_of: t of a value.
TestedEnds tested_ends(const std::vector<double>& values, double best, double dof,
                       const std::function<double(double value)>& t_of);

}  // namespace jostle::inline ensemble
