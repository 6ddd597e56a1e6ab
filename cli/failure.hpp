#pragma once

#include <exception>
#include <string>
#include <string_view>

namespace jostle {

/// What went wrong, and where the exception itself does not say it, what to do: memory and threads
/// that ran out.
std::string failure_text(const std::exception& error);

/// A message that a terminal can show: what is neither text nor UTF-8 as \xNN, long lines cut.
std::string printable(std::string_view text);

}  // namespace jostle
