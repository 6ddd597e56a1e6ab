#pragma once

#include <exception>
#include <string>

namespace jostle::inline cli {

/// The error in terms of the command line: arguments by the names of their options, and what to do,
/// if the exception itself does not contain it.
std::string failure_text(const std::exception& error);

}  // namespace jostle::inline cli
