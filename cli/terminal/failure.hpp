#pragma once

#include <exception>
#include <string>

namespace jostle::inline cli {

/// What went wrong, in the words of the command line: arguments by the names of their options, and
/// where the exception itself does not say it, what to do.
std::string failure_text(const std::exception& error);

}  // namespace jostle::inline cli
