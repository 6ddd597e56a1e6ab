#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ensemble/plan.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline study {

/// Throws BadInput where two files hold the same ensemble: the same scene at a sweep point, but for
/// its name and what is measured, with the same random numbers and the same taps as far as both go.
/// Together its realizations would count twice, or those of shards as two points.
void require_different_ensembles(std::span<const ResultsFile* const> files);

/// Seed and point id, which decide the random numbers of a sweep point.
using RandomKey = std::pair<std::uint64_t, std::uint64_t>;

/// Matched streams if all points have one key, independent ones if all keys differ. Throws BadInput
/// where only some points share their random numbers: their errors are neither those of pairs nor
/// those of independent points.
Streams streams_of(std::vector<RandomKey> keys);

}  // namespace jostle::inline study
