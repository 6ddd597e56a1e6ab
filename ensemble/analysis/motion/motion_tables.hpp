#pragma once

#include <string>
#include <vector>

#include "ensemble/analysis/table.hpp"
#include "ensemble/motion/motion_records.hpp"

namespace jostle::inline ensemble {

/// Three tables, `prefix` + displacement, overlap and layers: every quantity against waiting time
/// and lag, the mean over realizations with its standard error and degrees of freedom.
std::vector<Table> motion_tables(const std::string& prefix, const MotionRecords& records);

}  // namespace jostle::inline ensemble
