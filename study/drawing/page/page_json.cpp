#include "study/drawing/page/page_json.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "engine/number_reading.hpp"
#include "results/disk/printable.hpp"

namespace jostle::inline study {
Json page_number(double value) {
  if (std::isnan(value)) return nullptr;
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  const std::string text = fmt::format("{:.7g}", value);
  double rounded = 0;
  read_decimal(text.data(), text.data() + text.size(), rounded);
  constexpr double exact = 1e15;
  if (rounded == std::trunc(rounded) && std::abs(rounded) < exact) {
    return static_cast<std::int64_t>(rounded);
  }
  return rounded;
}

Json page_numbers(std::span<const double> values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(page_number(value));
  return list;
}

Json page_text(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return printable(text);
  constexpr std::size_t longest_character = 4;  // bytes, in UTF-8
  const auto continues = [&](std::size_t byte) {
    return (static_cast<unsigned char>(text[byte]) & 0xc0) == 0x80;
  };
  std::size_t end = longest;
  while (end > 0 && longest - end < longest_character && continues(end)) --end;
  // Bytes without the beginning of a character are no UTF-8.
  if (continues(end)) end = longest;
  return printable(text.substr(0, end)) + "...";
}

Json page_value(const Json& value) {
  if (value.is_string()) return page_text(value.text());
  if (value.is_array()) {
    Json list = Json::array();
    for (const Json& element : value.elements()) list.push_back(page_value(element));
    return list;
  }
  if (!value.is_object()) return value;
  Json object = Json::object();
  for (const auto& [key, member] : value.members()) {
    object[page_text(key).text()] = page_value(member);
  }
  return object;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = (word << 8) | (k < n ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= n ? digits[(word >> (18 - 6 * k)) & 63] : '=';
    }
  }
  return text;
}

std::string script_text(const Json& value) {
  const std::string json = value.dump();
  std::string text;
  text.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const std::string_view rest = std::string_view(json).substr(i);
    if (rest.starts_with("\xe2\x80\xa8") || rest.starts_with("\xe2\x80\xa9")) {
      text += rest[2] == '\xa8' ? "\\u2028" : "\\u2029";
      i += 2;
    } else if (rest[0] == '<' || rest[0] == '>' || rest[0] == '&') {
      text += fmt::format("\\u{:04x}", static_cast<unsigned char>(rest[0]));
    } else {
      text += rest[0];
    }
  }
  return text;
}

}  // namespace jostle::inline study
