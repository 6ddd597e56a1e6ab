#pragma once

#include <string>
#include <vector>

#include "config/json/json.hpp"
#include "results/content/study.hpp"

namespace jostle::inline cli {

/// Next commands for the results of a complete run, at most two: words of
/// `jostle`, without its own name. `scene` is the resolved one; what it does itself when it ends is
/// not named again. `file`: the results.
std::vector<std::vector<std::string>> next_commands(const Study& study, const Json& scene,
                                                    const std::string& file);

}  // namespace jostle::inline cli
