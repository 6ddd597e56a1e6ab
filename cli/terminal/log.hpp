#pragma once

#include <string>

// What a command says on standard error while it works, with the time of day.
namespace jostle::inline cli {

/// Before the first line.
void begin_log();
void log_line(const std::string& text);
/// From here on log_line() says nothing.
void silence_log();

}  // namespace jostle::inline cli
