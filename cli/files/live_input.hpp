#pragma once

#include <string>

#include "cli/options/command.hpp"
#include "study/results_input.hpp"

namespace jostle::inline cli {

/// The flag --live.
void add_live(Command& command, Live& live);

/// open_results(), which reports an unfinished run on stderr, and what to do.
ResultsFile open_to_read(const std::string& path, Live live);

}  // namespace jostle::inline cli
