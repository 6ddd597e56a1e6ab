#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace jostle::inline results {

/// A text that a terminal can show: what is neither text nor UTF-8, controls among it, as \xNN;
/// lines longer than `longest_line` bytes are cut. Newlines and tabs stay.
std::string printable(std::string_view text, std::size_t longest_line = std::string_view::npos);

/// A name (of a file, a column, a job) within a line: as printable(), newlines and tabs as \xNN
/// too.
std::string printable_name(std::string_view name);

/// A text of JSON that a terminal can show: what printable() escapes, as \uNNNN, which programs
/// read as the same characters. Newlines stay.
std::string printable_json(std::string_view json);

}  // namespace jostle::inline results
