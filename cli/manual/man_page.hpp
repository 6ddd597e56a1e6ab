#pragma once

#include <string>

#include "cli/options/command_text.hpp"

namespace jostle::inline cli {

/// The manual page of the program, jostle.1, in roff. `version`: "0.3.0".
std::string program_page(const CommandText& program, const std::string& version);

/// The manual page of one of its commands, jostle-run.1.
std::string command_page(const CommandText& program, const CommandText& command,
                         const std::string& version);

}  // namespace jostle::inline cli
