#pragma once

#include <span>

#include "results/file/results_file.hpp"

namespace jostle::inline study {

/// Throws BadInput where two files hold the same ensemble: the same scene at a sweep point, but for
/// its name and what is measured, with the same random numbers and the same taps as far as both go.
/// Together its realizations would count twice, or those of shards as two points.
void require_different_ensembles(std::span<const ResultsFile* const> files);

}  // namespace jostle::inline study
