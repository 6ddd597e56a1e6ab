#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace jostle::inline cli {

/// The command that resumes shard `index` of `count`, by `program`. `stored` is the command
/// line that a results file holds, whoever wrote it: its scene and those of its options that `run`
/// has are taken over, and nothing of a line of another command, for which "SCENE.json" is used.
std::string redo_command(const std::string& program, const std::string& stored, std::uint32_t index,
                         std::size_t count, const std::string& output);

}  // namespace jostle::inline cli
