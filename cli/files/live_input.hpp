#pragma once

#include <string>

#include "cli/options/command.hpp"
#include "study/results_input.hpp"

namespace jostle::inline cli {

/// The flag --live.
void add_live(Command& command, Live& live);

/// open_results(), which says on stderr where the run is unfinished, and what to do about it.
ResultsFile open_to_read(const std::string& path, Live live);

}  // namespace jostle::inline cli
