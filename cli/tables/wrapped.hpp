#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace jostle::inline cli {

/// Characters of a text in UTF-8.
std::size_t width_of(std::string_view text);

/// The first `width` characters of a text in UTF-8.
std::string_view first_characters(std::string_view text, std::size_t width);

/// Lines that are longer than `width` go on below at a word, two further in than they begin, or
/// under the second of two columns (`  key    value`). A word that has no room in a line of its own
/// is not broken: it may be a path.
std::string wrapped(std::string_view text, std::size_t width);

}  // namespace jostle::inline cli
