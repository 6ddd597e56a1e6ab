#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/content/study.hpp"

namespace jostle::inline study {

/// The arguments this process was started with, from /proc; where there is none, what was kept.
std::vector<std::string> command_line();
/// For systems without /proc. Called once, before threads are started.
void keep_command_line(int argc, char** argv);

/// The file of this program. If the system does not report it, the meaning of its first argument: a
/// path, or a name that is looked up along PATH. Throws std::filesystem::filesystem_error.
std::filesystem::path program_path();

/// Arguments as a shell takes them, quoted where they must be.
std::string shell_words(const std::vector<std::string>& arguments);

/// Version, revision, machine and command line; `threads` is for people.
Provenance provenance_of_this_run(const std::string& threads);

}  // namespace jostle::inline study
