#pragma once

#include <cstddef>
#include <cstdint>
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

/// The command that resumes shard `index` of `count`, by `program`. `stored` is the command
/// line that a results file holds, whoever wrote it: its scene and those of its options that `run`
/// has are taken over, and nothing of a line of another command, for which "SCENE.json" is used.
std::string redo_command(const std::string& program, const std::string& stored, std::uint32_t index,
                         std::size_t count, const std::string& output);

}  // namespace jostle::inline cli
