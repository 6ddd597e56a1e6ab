#include "results/disk/printable.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace jostle::inline results {
namespace {

/// Bytes of the character of UTF-8 that `text` begins with; 0 where it is none, or a control.
std::size_t character_length(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x80) return first == '\t' || (first >= 0x20 && first != 0x7f) ? 1 : 0;
  const std::size_t length = first >= 0xf8 ? 0 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || length == 0 || length > text.size()) return 0;
  const auto second = static_cast<unsigned char>(text[1]);
  if (first == 0xc2 && second < 0xa0) return 0;  // controls
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
  return std::ranges::all_of(text.substr(1, length - 1), continues) ? length : 0;
}

/// U+061C, U+200E, U+200F, U+202A to U+202E and U+2066 to U+2069 turn the direction of what is
/// written, U+2028 and U+2029 begin a line: a name could show another one.
bool turns_direction(std::string_view character) {
  if (character == "\xd8\x9c" || character == "\xe2\x80\x8e" || character == "\xe2\x80\x8f")
    return true;
  if (!character.starts_with("\xe2\x80") && !character.starts_with("\xe2\x81")) return false;
  const auto last = static_cast<unsigned char>(character[2]);
  return character[1] == '\x80' ? last >= 0xa8 && last <= 0xae : last >= 0xa6 && last <= 0xa9;
}

/// The number of a character of UTF-8 of at most three bytes.
unsigned code_point(std::string_view character) {
  unsigned code = static_cast<unsigned char>(character[0]);
  if (character.size() > 1) code &= character.size() == 2 ? 0x1f : 0x0f;
  for (const char next : character.substr(1))
    code = code << 6 | (static_cast<unsigned char>(next) & 0x3f);
  return code;
}

std::string printable_line(std::string_view line, std::size_t longest) {
  std::string shown;
  while (!line.empty() && shown.size() < longest) {
    const std::size_t length = character_length(line);
    if (length == 0 || turns_direction(line.substr(0, length))) {
      for (const char byte : line.substr(0, std::max<std::size_t>(1, length)))
        shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
    } else {
      shown += line.substr(0, length);
    }
    line.remove_prefix(std::max<std::size_t>(1, length));
  }
  if (!line.empty()) shown += "...";
  return shown;
}

}  // namespace

std::string printable(std::string_view text, std::size_t longest_line) {
  std::string shown;
  for (;;) {
    const std::size_t end = text.find('\n');
    shown += printable_line(text.substr(0, end), longest_line);
    if (end == std::string_view::npos) return shown;
    shown += '\n';
    text.remove_prefix(end + 1);
  }
}

std::string printable_name(std::string_view name) {
  std::string shown;
  for (const char c : printable(name)) {
    if (c == '\n' || c == '\t')
      shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    else
      shown += c;
  }
  return shown;
}

std::string printable_json(std::string_view json) {
  std::string shown;
  while (!json.empty()) {
    const auto first = static_cast<unsigned char>(json[0]);
    // Valid UTF-8 is what a JSON text is: controls of two bytes are the C1 of U+0080 to U+009F.
    const std::size_t length = std::min<std::size_t>(json.size(), first >= 0xf0   ? 4
                                                                  : first >= 0xe0 ? 3
                                                                  : first >= 0xc0 ? 2
                                                                                  : 1);
    const std::string_view character = json.substr(0, length);
    const bool shows =
        character == "\n" || (character_length(character) > 0 && !turns_direction(character));
    shown += shows ? std::string(character) : fmt::format("\\u{:04x}", code_point(character));
    json.remove_prefix(length);
  }
  return shown;
}

}  // namespace jostle::inline results
