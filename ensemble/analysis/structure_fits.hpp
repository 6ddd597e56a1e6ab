#pragma once

#include <string_view>
#include <vector>

#include "ensemble/analysis/table.hpp"
#include "structure/measure.hpp"

namespace jostle::inline ensemble {

/// One part of the structure of every packing, [n_taps][n_realizations]; null where there is none.
using PartPackings = std::vector<std::vector<const Measurement*>>;

/// Adds what the laws of that part find, [n_taps] each: parameters, their jackknife errors and 95 %
/// intervals by Student's t (not a number with fewer than two realizations, or where a refit does
/// not settle), and a status in words. Eq. 7 by least squares to the mean vertical profile. By
/// maximum likelihood to counts, with the chance p that the law holds: the exponential to the tail
/// of pores, the normal law to numbers of neighbours and of faces, the k-gamma law to free volumes.
/// Other parts have none. A parameter that diverges is NaN, and the status reports it.
void add_fits(std::string_view part_name, const PartPackings& part,
              const StructureSettings& settings, Table& table);

}  // namespace jostle::inline ensemble
