#pragma once

#include <cstdint>
#include <span>

#include "results/file/results_file.hpp"
#include "study/seconds.hpp"

// How many replicates of jostle cost fit into its budget. A replicate is one realization of every
// setting.
namespace jostle::inline study {

/// Replicates of work between two looks at the realizations, by their processor times: one that was
/// there before and only gained taps counts as the share that it gained. 0 where nothing was
/// computed.
double replicates_done(std::span<const RealizationSummary> summaries_before,
                       std::span<const RealizationSummary> summaries_after);

/// Number of replicates in the budget, at the pace of the finished ones; one more to find the pace.
/// `replicates` are finished.
std::uint32_t affordable_replicates(std::uint32_t replicates, Seconds budget, Seconds spent,
                                    double done);

}  // namespace jostle::inline study
