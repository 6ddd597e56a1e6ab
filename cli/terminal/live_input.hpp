#pragma once

#include <string>

#include "study/results_input.hpp"

namespace CLI {
class App;
}

namespace jostle {

/// The flag --live.
void add_live(CLI::App& command, Live& live);

/// open_results(), which says on stderr where the run is unfinished, and what to do about it.
ResultsFile open_to_read(const std::string& path, Live live);

}  // namespace jostle
