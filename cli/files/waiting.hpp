#pragma once

#include <span>
#include <string>

#include "cli/options/command.hpp"
#include "results/locks/patience.hpp"

namespace jostle::inline cli {

/// --wait, also JOSTLE_WAIT: time limit of waiting for other processes that work on the results.
/// The wait is reported on standard error.
void add_wait(Command& command, Patience& patience);

/// Prints a warning to standard error for each of these files that another program opened for
/// writing. For files that were read: others have been refused.
void warn_of_lost_seals(std::span<const std::string> paths);

}  // namespace jostle::inline cli
