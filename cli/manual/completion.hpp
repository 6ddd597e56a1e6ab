#pragma once

#include <string>

#include "cli/options/command_text.hpp"

namespace jostle::inline cli {

/// A script that bash sources: commands, options, values that are words, and files by their suffix.
std::string bash_completion(const CommandText& program);

/// A function of zsh's completion system, with descriptions.
std::string zsh_completion(const CommandText& program);

}  // namespace jostle::inline cli
