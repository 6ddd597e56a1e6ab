#include "cli/tables/wrapped.hpp"

#include <algorithm>

namespace jostle::inline cli {
namespace {

constexpr std::size_t none = std::string_view::npos;

bool begins_character(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
}

/// Indent of continuation lines, in bytes.
std::size_t hanging_indent(std::string_view line, std::size_t width) {
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  const std::size_t gap = line.find("  ", indent);
  if (gap != none) {
    const std::size_t second = line.find_first_not_of(' ', gap);
    if (second != none && second <= width / 2) return second;
  }
  return indent + 2;
}

/// A word that is too long for a line ends behind its last comma that has room: a list.
std::size_t end_of_word(std::string_view line, std::size_t start, std::size_t room) {
  const std::size_t end = std::min(line.find(' ', start), line.size());
  const std::string_view word = line.substr(start, end - start);
  if (width_of(word) <= room) return end;
  const std::size_t comma = word.substr(0, room).find_last_of(',');
  return comma == none ? end : start + comma + 1;
}

std::string wrapped_line(std::string_view line, std::size_t width) {
  if (width_of(line) <= width) return std::string(line);
  const std::size_t indent = std::min(hanging_indent(line, width), width / 2);
  std::size_t start = std::min(line.find_first_not_of(' '), line.size());
  std::string text(line.substr(0, start));
  std::size_t column = start;
  bool first = true;  // word of a line
  while (start < line.size()) {
    const std::size_t gap = end_of_word(line, start, width - indent);
    const std::size_t next = std::min(line.find_first_not_of(' ', gap), line.size());
    const std::string_view word = line.substr(start, gap - start);
    if (!first && column + width_of(word) > width) {
      text.erase(text.find_last_not_of(' ') + 1);
      text.append("\n").append(indent, ' ');
      column = indent;
    }
    text += word;
    text.append(next - gap, ' ');
    column += width_of(word) + next - gap;
    first = false;
    start = next;
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

std::string_view first_characters(std::string_view text, std::size_t width) {
  std::size_t end = 0;
  for (; end < text.size(); ++end) {
    if (begins_character(text[end]) && width-- == 0) break;
  }
  return text.substr(0, end);
}

std::string wrapped(std::string_view text, std::size_t width) {
  std::string shown;
  for (;;) {
    const std::size_t end = text.find('\n');
    shown += wrapped_line(text.substr(0, end), width);
    if (end == none) return shown;
    shown += '\n';
    text.remove_prefix(end + 1);
  }
}

}  // namespace jostle::inline cli
