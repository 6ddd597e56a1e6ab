#include "study/figures/gnuplot_text.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "results/export/printable.hpp"

namespace jostle::inline study {
namespace {

bool begins_letter(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
}

/// A printable text on one line.
std::string one_line(const std::string& text) {
  std::string line = printable(text);
  std::ranges::replace_if(
      line, [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return line;
}

/// The letters, each of one or more bytes.
std::vector<std::string> letters_of(const std::string& text) {
  std::vector<std::string> letters;
  for (const char c : text) {
    if (begins_letter(c) || letters.empty()) letters.emplace_back();
    letters.back() += c;
  }
  return letters;
}

bool is_word_letter(const std::string& letter) {
  const char c = letter[0];
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// "N_c", "Φ_b", "q_6", "A_∞" that stand alone: the place of the underscore of a subscript.
bool is_subscript(const std::vector<std::string>& letters, std::size_t i) {
  const auto ends = [&](std::size_t k) {
    return k >= letters.size() || !is_word_letter(letters[k]);
  };
  return letters[i] == "_" && i >= 1 && i + 1 < letters.size() && letters[i - 1] != " " &&
         letters[i + 1] != " " && (i == 1 || ends(i - 2)) && ends(i + 2);
}

std::string in_single_quotes(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') quoted += '\'';
    quoted += c;
  }
  return quoted + "'";
}

}  // namespace

std::string comment_text(const std::string& text) {
  std::string line = one_line(text);
  if (line.ends_with('\\')) line += ' ';
  return line;
}

std::string data_text(const std::string& text) {
  std::string line = one_line(text);
  std::ranges::replace(line, '"', '\'');
  std::ranges::replace(line, '\\', '/');
  return line;
}

std::string quoted(const std::string& text) {
  constexpr std::string_view marks = "^_@&~{}\\";
  const std::vector<std::string> letters = letters_of(one_line(text));
  std::string shown;
  for (std::size_t i = 0; i < letters.size(); ++i) {
    if (is_subscript(letters, i)) {
      shown += "_{" + letters[++i] + "}";
      // A viewer of SVG may drop a plain space where a subscript ends.
      if (i + 1 < letters.size() && letters[i + 1] == " ") shown += "\u00a0", ++i;
      continue;
    }
    if (letters[i].size() == 1 && marks.find(letters[i]) != std::string_view::npos) shown += '\\';
    shown += letters[i];
  }
  return in_single_quotes(shown);
}

std::string plainly_quoted(const std::string& text) {
  return in_single_quotes(one_line(text));
}

std::size_t n_letters(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_letter));
}

std::string first_letters(const std::string& text, std::size_t n) {
  const std::vector<std::string> letters = letters_of(text);
  if (letters.size() <= n) return text;
  std::string first;
  for (std::size_t i = 0; i + 1 < n; ++i) first += letters[i];
  return first + "…";
}

}  // namespace jostle::inline study
