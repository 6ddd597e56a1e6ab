#include "study/tables/measured/delimited_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "results/disk/input_file.hpp"
#include "study/bad_input.hpp"

namespace jostle::inline study {

namespace {

constexpr std::string_view blanks = " \t";

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(blanks) - first + 1));
}

bool has_unquoted(const std::string& line, char character) {
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') is_quoted = !is_quoted;
    if (c == character && !is_quoted) return true;
  }
  return false;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream words(line);
  std::vector<std::string> found;
  for (std::string word; words >> word;) found.push_back(word);
  return found;
}

/// Without quotes around it; two quotes inside are one (RFC 4180).
std::string unquoted(const std::string& cell) {
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return cell;
  std::string text;
  for (std::size_t i = 1; i + 1 < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"' && cell[i + 1] == '"' && i + 2 < cell.size()) ++i;
  }
  return trimmed(text);
}

std::vector<std::string> split(const std::string& line, char divider) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') is_quoted = !is_quoted;
    if (c == divider && !is_quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells) cell = unquoted(trimmed(cell));
  return cells;
}

/// Lines of a piece of text that ends in LF.
std::vector<std::string> lines_of(const std::string& piece) {
  std::vector<std::string> lines(1);
  for (const char c : piece) {
    if (c == '\r') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  if (lines.size() > 1 && lines.back().empty()) lines.pop_back();
  return lines;
}

void skip_byte_order_mark(const std::string& path, std::string& first) {
  if (first.starts_with("\xEF\xBB\xBF")) first.erase(0, 3);
  if (!first.starts_with("\xFF\xFE") && !first.starts_with("\xFE\xFF")) return;
  throw BadInput(fmt::format("{}: the file is UTF-16. Save it as UTF-8 text.", path));
}

}  // namespace

std::vector<std::string> divided_cells(const std::string& line) {
  for (const char divider : {';', ','}) {
    if (has_unquoted(line, divider)) return split(line, divider);
  }
  if (!has_unquoted(line, '\t') && !has_unquoted(line, '"')) return words_of(line);
  const bool has_tabs = has_unquoted(line, '\t');
  std::vector<std::string> cells = split(line, has_tabs ? '\t' : ' ');
  if (!has_tabs) std::erase(cells, "");
  // Columns of numbers that tabs and blanks divide.
  const bool is_mixed = std::ranges::any_of(cells, [](const std::string& cell) {
    return cell.find(' ') != std::string::npos &&
           cell.find_first_not_of("+-.0123456789eE ") == std::string::npos;
  });
  return is_mixed ? words_of(line) : cells;
}

DelimitedText read_delimited_text(const std::string& path) {
  InputFile file(path, Pipes::allowed);
  DelimitedText text;
  std::size_t number = 0;
  for (std::string piece; file.next_line(piece);) {
    if (number == 0) skip_byte_order_mark(path, piece);
    for (const std::string& line : lines_of(piece)) {
      ++number;
      const std::string content = trimmed(line);
      if (content.empty()) continue;
      if (content.front() == '#') {
        if (!text.lines.empty()) continue;
        const std::size_t first = std::min(content.find_first_not_of("# \t"), content.size());
        text.comment = {number, line, divided_cells(content.substr(first))};
        continue;
      }
      if (std::ranges::count(line, '"') % 2 != 0) {
        throw BadInput(fmt::format(
            "{}: line {} has a quote that is not closed: a field ends on its line", path, number));
      }
      text.lines.push_back({number, line, divided_cells(line)});
    }
  }
  return text;
}

}  // namespace jostle::inline study
