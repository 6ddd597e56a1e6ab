#pragma once

#include <string>

#include "config/json/json.hpp"
#include "results/file/results_file.hpp"
#include "study/drawing/figures/drawn_file.hpp"

namespace jostle::inline study {

/// The run, its programs and its progress: scene, state, seed, digest, cost, failures, sweep
/// points.
Json page_run(const ResultsFile& file, const DrawnFile& drawn, const std::string& digest,
              std::vector<std::string>& left_out);

}  // namespace jostle::inline study
