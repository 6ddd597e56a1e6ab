#include "study/number_text.hpp"

#include <charconv>
#include <cmath>

#include "engine/number_reading.hpp"

namespace jostle::inline study {

namespace {

bool is_all_of(std::string_view text, const std::from_chars_result& read) {
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

}  // namespace

std::optional<double> read_number(std::string_view text) {
  double number = 0;
  const auto read = read_decimal(text.data(), text.data() + text.size(), number);
  if (!is_all_of(text, read) || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::optional<std::uint64_t> read_whole_number(std::string_view text) {
  std::uint64_t number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (!is_all_of(text, read)) return std::nullopt;
  return number;
}

}  // namespace jostle::inline study
