#pragma once

#include <string>
#include <vector>

#include "config/json/json.hpp"
#include "results/study.hpp"

namespace jostle::inline cli {

/// What to do with the results of a scene that has run to its end, at most two commands: words of
/// `jostle`, without its own name. `scene` is the resolved one; what it does itself when it ends is
/// not named again. `file`: the results.
std::vector<std::vector<std::string>> next_commands(const Study& study, const Json& scene,
                                                    const std::string& file);

}  // namespace jostle::inline cli
