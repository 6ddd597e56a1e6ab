#pragma once

#include <cstdint>
#include <span>

#include "results/results_file.hpp"
#include "study/seconds.hpp"

// How many rounds of jostle cost fit into its budget. A round is one realization of every setting.
namespace jostle {

/// Rounds of work between two looks at the realizations, by their processor times: one that was
/// there before and only gained taps counts as the share that it gained. 0 where nothing was
/// computed.
double rounds_done(std::span<const RealizationSummary> before,
                   std::span<const RealizationSummary> after);

/// As many rounds in all as the budget has room for, at the pace of those done in the time spent;
/// one more to find the pace. `rounds` are there.
std::uint32_t affordable_rounds(std::uint32_t rounds, Seconds budget, Seconds spent, double done);

}  // namespace jostle
