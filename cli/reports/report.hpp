#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "results/results_file.hpp"

namespace jostle::inline cli {

/// For every sweep point a table over taps, about three a decade, of mean +- standard error and
/// sigma of every observable, with the means that the engine has shown beside them, and the number
/// M of realizations where not all reached every tap; below it what the engine says in sentences
/// (capped relaxations), cost, and failed
/// realizations with seed and reason.
std::string report(const ResultsFile& file);

/// A line for every realization that failed, with its seed and reason.
std::string failure_lines(const ResultsFile& file);

/// 0, 1, 2, 5, 10, 20, 50, ... below `last`, and `last`.
std::vector<std::uint64_t> reported_taps(std::uint64_t last);

}  // namespace jostle::inline cli
