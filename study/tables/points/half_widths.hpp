#pragma once

#include "ensemble/analysis/table.hpp"

namespace jostle::inline study {

/// The table as people read it: where a quantity x has the standard error x_error and its degrees
/// of freedom x_dof (along the same axes, or one for all), x_error becomes half the width of the
/// 68 % interval by Student's t, and x_dof goes. A note says what errors and intervals are.
Table with_half_widths(Table table);

}  // namespace jostle::inline study
