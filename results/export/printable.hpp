#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace jostle::inline results {

/// A text that a terminal can show: what is neither text nor UTF-8, controls among it, as \xNN;
/// lines longer than `longest_line` bytes are cut. Newlines and tabs stay.
std::string printable(std::string_view text, std::size_t longest_line = std::string_view::npos);

}  // namespace jostle::inline results
