#pragma once

#include <string>
#include <vector>

#include "results/study.hpp"

namespace jostle::inline study {

/// The arguments this process was started with, from /proc.
std::vector<std::string> command_line();

/// Arguments as a shell takes them, quoted where they must be.
std::string shell_words(const std::vector<std::string>& arguments);

/// Version, revision, machine and command line; `threads` is for people.
Provenance provenance_of_this_run(const std::string& threads);

}  // namespace jostle::inline study
