#pragma once

#include <string>
#include <vector>

#include "ensemble/analysis/table.hpp"
#include "ensemble/motion/motion_records.hpp"

namespace jostle::inline ensemble {

/// Three tables, `prefix` + displacement, overlap and layers: every quantity against waiting time
/// and lag, the mean over realizations with its standard error and degrees of freedom. A fourth
/// one, kinds, where the motion is followed by kind; `kinds` has their names.
std::vector<Table> motion_tables(const std::string& prefix, const MotionRecords& records,
                                 const std::vector<std::string>& kinds = {});

}  // namespace jostle::inline ensemble
