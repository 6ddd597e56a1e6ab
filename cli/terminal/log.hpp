#pragma once

#include <string>

// Messages of a command on standard error, with the time of day.
namespace jostle::inline cli {

/// Before the first line.
void begin_log();
void log_line(const std::string& text);
/// From here on log_line() prints nothing.
void silence_log();

}  // namespace jostle::inline cli
