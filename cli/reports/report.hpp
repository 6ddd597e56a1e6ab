#pragma once

#include <string>

#include "cli/tables/layout.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline cli {

/// Contents of a file in one line: how many realizations have ended, and, of a single sweep point,
/// where its first fraction (or its first observable) went. Then for every sweep point a table over
/// taps, about three per decade, of the mean of every observable with its standard error, and the
/// means that the engine has shown beside them where there is room, or, with all columns, sigma and
/// all of these; the number M of realizations where not all reached every tap. Below it the
/// engine's sentences (capped relaxations), cost, and failed realizations with seed and reason.
std::string report(const ResultsFile& file, const Layout& layout = {});

/// A line for each of the first realizations that failed, with its seed and reason, and how many
/// more there are.
std::string failure_lines(const ResultsFile& file);

}  // namespace jostle::inline cli
