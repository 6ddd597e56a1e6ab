#pragma once

#include <string>
#include <vector>

#include "study/running/scene_file.hpp"

namespace jostle::inline cli {

/// Returns in words what of a scene needs loops that the program of a first run does not have:
/// "discrete elements", ...
std::vector<std::string> loops_beyond_first_run(const LoadedScene& loaded);
/// Returns what a run of the scene needs beyond that program: "tables (fits)", and loops.
std::vector<std::string> beyond_first_run(const LoadedScene& loaded);
/// Prints these needs as one line, if there are any. Returns the exit code of `requests`.
int print_requests(const std::vector<std::string>& needs);

}  // namespace jostle::inline cli
