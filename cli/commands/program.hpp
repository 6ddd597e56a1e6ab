#pragma once

#include "cli/options/command_line.hpp"

namespace jostle::inline cli {

inline constexpr const char* program_description = "Ensembles of tapped granular packings";

/// Every command with its options; the command that runs leaves its exit code in `code`.
void describe_program(CommandLine& line, int& code);

}  // namespace jostle::inline cli
