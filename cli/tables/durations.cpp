#include "cli/tables/durations.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "engine/number_reading.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline cli {
namespace {

constexpr std::pair<std::string_view, double> units[] = {
    {"ms", 1e-3}, {"s", 1}, {"m", 60}, {"h", 3600}, {"d", 86400}};

/// Takes the unit at the front of `text`; nothing for an unknown one.
std::optional<double> take_unit(std::string_view& text) {
  for (const auto& [name, seconds] : units) {
    if (!text.starts_with(name)) continue;
    text.remove_prefix(name.size());
    return seconds;
  }
  return {};
}

}  // namespace

std::optional<Seconds> parse_duration(std::string_view text) {
  constexpr double longest = 1e9;  // some 30 years, which clocks can count
  if (text.empty()) return {};
  double total = 0, unit_before = std::numeric_limits<double>::infinity();
  while (!text.empty()) {
    double number = 0;
    const auto [end, error] =
        read_decimal(text.data(), text.data() + text.size(), number, std::chars_format::fixed);
    if (error != std::errc{} || !std::isfinite(number) || std::signbit(number)) return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.empty()) {  // seconds, unless behind another unit: 1h30 may mean minutes
      if (std::isfinite(unit_before)) return {};
      total = number;
      break;
    }
    const auto unit = take_unit(text);
    if (!unit || *unit >= unit_before) return {};
    unit_before = *unit;
    total += number * *unit;
  }
  if (total > longest) return {};
  return Seconds(total);
}

std::string duration_fault(std::string_view text) {
  return fmt::format(
      "\"{}\" is not a duration: give numbers with their units d, h, m, s or ms, the larger unit "
      "first, as 90s, 30m, 2h or 1h30m, at most 1e9 s in all; a number alone is in seconds",
      text);
}

std::string format_duration(Seconds duration) {
  const double seconds = duration.count();
  constexpr double countless = 86400e6;  // a million days
  if (!std::isfinite(seconds)) return "unknown";
  if (seconds >= countless) return finite_text("{:.3g} d", seconds / 86400);
  if (seconds < 0.9995) return finite_text("{:.0f} ms", seconds * 1e3);
  if (seconds < 9.95) return finite_text("{:.1f} s", seconds);
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  if (whole < 86400) return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
  return fmt::format("{} d {} h", whole / 86400, whole % 86400 / 3600);
}

}  // namespace jostle::inline cli
