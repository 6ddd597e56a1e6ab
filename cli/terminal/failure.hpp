#pragma once

#include <exception>
#include <string>

namespace jostle {

/// What went wrong, and where the exception itself does not say it, what to do: memory and threads
/// that ran out.
std::string failure_text(const std::exception& error);

}  // namespace jostle
