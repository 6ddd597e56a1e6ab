#include "study/number_text.hpp"

#include <charconv>
#include <cmath>

namespace jostle::inline study {

namespace {

template <class Number>
std::optional<Number> read_all(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  return number;
}

}  // namespace

std::optional<double> read_number(std::string_view text) {
  const auto number = read_all<double>(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<std::uint64_t> read_whole_number(std::string_view text) {
  return read_all<std::uint64_t>(text);
}

}  // namespace jostle::inline study
