#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/fault.hpp"
#include "config/json/json.hpp"

namespace jostle::inline config {

/// Lists and objects may be nested this deep.
inline constexpr int deepest_nesting = 64;

/// Reads JSON text. Nothing, and one fault with line and column, where it is not JSON; a key that
/// occurs twice in an object is a fault too, but the text is read.
std::optional<Json> read_json(std::string_view text, std::vector<Fault>& faults);

/// `pointer` with one more token, escaped by RFC 6901: "/a" + "b/c" is "/a/b~1c".
std::string pointer_to(std::string_view pointer, std::string_view key);
std::string pointer_to(std::string_view pointer, std::size_t index);

/// The parts, one after another, with `separator` between them.
std::string joined(const std::vector<std::string>& parts, std::string_view separator);

/// Tests if `pointer` is `ancestor` or below it.
bool is_within(std::string_view pointer, std::string_view ancestor);

/// One text for all ways to write a value: keys sorted, no blanks, whole numbers without a point,
/// any other number by the shortest decimal that reads back as the same double.
std::string canonical_text(const Json& value);

}  // namespace jostle::inline config
