#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "study/seconds.hpp"

namespace jostle::inline cli {

/// "90", "90s", "1.5h", "1h30m", "2d": numbers with the units d, h, m, s, ms, the larger first,
/// summed; a number alone is in seconds. Nothing for anything else: for negative numbers, for a
/// last number without a unit ("1h30", which may mean minutes), and above 1e9 s.
std::optional<Seconds> parse_duration(std::string_view text);

/// Describes the fault of a text that is no duration.
std::string duration_fault(std::string_view text);

/// For people, two units at most: "850 ms", "42 s", "3 min 10 s", "5 h 12 min", "2 d 4 h".
std::string format_duration(Seconds duration);

}  // namespace jostle::inline cli
