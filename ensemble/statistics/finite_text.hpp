#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <type_traits>

namespace jostle::inline ensemble {

/// The phrase that replaces a sentence with a number that is not finite. Whoever writes a sentence
/// decides first which of its numbers there are, and writes another sentence without the missing
/// ones: this text is seen only where that was forgotten.
inline constexpr const char* not_stated =
    "no statement: a number of it is not finite, which is a fault of jostle; please report it";

/// Formats a sentence, as fmt::format() does. Every number of a floating type that a person reads
/// within a text goes through here: a number that is not finite is never printed, not_stated is
/// returned in place of the sentence.
template <typename... Arguments>
std::string finite_text(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  const auto is_sayable = [](const auto& argument) {
    if constexpr (std::is_floating_point_v<std::remove_cvref_t<decltype(argument)>>)
      return std::isfinite(argument);
    else
      return true;
  };
  if (!(is_sayable(arguments) && ...)) return not_stated;
  return fmt::vformat(format, fmt::make_format_args(arguments...));
}

/// " diameter": what follows a number in a sentence; empty without a unit.
inline std::string unit_behind(const std::string& units) {
  return units.empty() || units == "1" ? "" : " " + units;
}

}  // namespace jostle::inline ensemble
