#pragma once

#include <span>
#include <string>
#include <string_view>

#include "config/json/json.hpp"

// All output of the program on its standard streams.
namespace jostle::inline cli {

/// First thing in the program. A standard stream that the caller closed is opened, so that no
/// results file takes its number and is written over by messages; writing to it still fails. Beyond
/// a limit on file sizes (ulimit -f) a write fails with a message, instead of killing the program;
/// a reader of standard output or error that went away costs the text, not the work.
void reserve_standard_fds();

/// Writes a text for people to standard output; control characters are shown as \xNN. Throws
/// nothing: results are stored even without a reader. The first failure is reported on standard
/// error; output_is_lost() is then true.
void print(std::string_view text);

/// Output for programs, to the byte.
void print_exactly(std::string_view text);

/// JSON, two blanks a level, and a newline. Names that are not UTF-8 show U+FFFD for the bytes that
/// are none.
void print_json(const Json& json);

/// True if standard output failed, other than by a reader that closed it: the exit code reports it.
bool output_is_lost();

/// A message in which no word of the command line begins a new line: its newlines are \x0a.
std::string with_words_on_one_line(std::string message, std::span<const std::string> words);

/// Writes a message to standard error, as print() does, words of the command line on one line.
/// Where that goes to a full disk or a closed terminal the text is lost, and not the run.
void print_to_standard_error(std::string_view text);

/// Commands to the terminal among it.
void print_to_standard_error_exactly(std::string_view text);

}  // namespace jostle::inline cli
