#include "config/json/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace jostle::inline config {

namespace {

std::string number_text(const Json& number) {
  if (number.is_number_integer()) return number.dump();
  const auto value = number.number();
  if (value == std::trunc(value) && std::abs(value) < 0x1p53) {
    return std::to_string(static_cast<std::int64_t>(value));
  }
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

}  // namespace

std::string pointer_to(std::string_view pointer, std::string_view key) {
  std::string escaped;
  for (const char c : key) {
    if (c == '~') {
      escaped += "~0";
    } else if (c == '/') {
      escaped += "~1";
    } else {
      escaped += c;
    }
  }
  return fmt::format("{}/{}", pointer, escaped);
}

std::string pointer_to(std::string_view pointer, std::size_t index) {
  return fmt::format("{}/{}", pointer, index);
}

std::string joined(const std::vector<std::string>& parts, std::string_view separator) {
  std::string text;
  for (const std::string& part : parts) {
    if (&part != &parts.front()) text += separator;
    text += part;
  }
  return text;
}

bool is_within(std::string_view pointer, std::string_view ancestor) {
  return pointer.starts_with(ancestor) &&
         (pointer.size() == ancestor.size() || pointer[ancestor.size()] == '/');
}

std::string canonical_text(const Json& value) {
  if (value.is_number()) return number_text(value);
  if (!value.is_structured()) return value.dump();
  std::vector<std::string> parts;
  if (value.is_array()) {
    for (const Json& element : value.elements()) parts.push_back(canonical_text(element));
    return fmt::format("[{}]", joined(parts, ","));
  }
  for (const auto& [key, member] : value.members()) {
    parts.push_back(fmt::format("{}:{}", Json(key).dump(), canonical_text(member)));
  }
  std::sort(parts.begin(), parts.end());
  return fmt::format("{{{}}}", joined(parts, ","));
}

}  // namespace jostle::inline config
