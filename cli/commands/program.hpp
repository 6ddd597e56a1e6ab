#pragma once

#include <span>

#include "cli/options/command_line.hpp"

namespace jostle::inline cli {

inline constexpr const char* program_description = "Ensembles of tapped granular packings";

/// Describes a command with its options; the command leaves its exit code in `code` once it has
/// run.
using AddCommand = void (*)(Command& app, int& code);

/// Every command, in the order of the help.
std::span<const AddCommand> every_command();

/// A program of these commands.
void describe_program(CommandLine& line, int& code, std::span<const AddCommand> commands);

/// Runs the command that is named. Every error ends here, with a message on stderr. Returns the
/// exit code.
int run_program(int argc, char** argv, std::span<const AddCommand> commands);

}  // namespace jostle::inline cli
