#pragma once

#include <string_view>
#include <vector>

#include "ensemble/table.hpp"
#include "structure/measure.hpp"

namespace jostle {

/// One part of the structure of every packing, [n_taps][n_realizations]; null where there is none.
using PartPackings = std::vector<std::vector<const Measurement*>>;

/// Adds what the laws of that part find in its mean curves, [n_taps] each: parameters, their
/// jackknife errors (not a number with fewer than two realizations, or where a refit does not
/// settle), and "converged" or why there is no fit. Eq. 7 to the vertical profile, the
/// exponential to the tail of pores, the normal law to numbers of neighbours and of faces, the
/// k-gamma law to free volumes; other parts have none.
void add_fits(std::string_view part_name, const PartPackings& part,
              const StructureSettings& settings, Table& table);

}  // namespace jostle
