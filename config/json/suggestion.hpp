#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace jostle::inline config {

/// Insertions, deletions, replacements and exchanges of neighbours that turn `a` into `b`
/// (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// ` Did you mean "dilate"?`, with its leading blank, for the candidate nearest to `written`;
/// empty where none is near: more than 1 + length / 4 edits away, and not a part of a candidate.
std::string did_you_mean(std::string_view written, const std::vector<std::string>& candidates);

/// did_you_mean(), or else a hint for a quantity of the field that has another name or place in
/// scenes, such as "acceleration". Begins with a blank, or is empty.
std::string key_hint(std::string_view written, const std::vector<std::string>& candidates);

}  // namespace jostle::inline config
