#include "cli/terminal/screen.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string>

#include "cli/reports/curves.hpp"
#include "cli/tables/wrapped.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "results/disk/printable.hpp"

namespace jostle::inline cli {
namespace {

constexpr std::size_t narrowest = 20, widest = 10'000;

std::string_view variable(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

/// 0 where the text is no width that a report could have.
std::size_t width_in(std::string_view text) {
  std::size_t width = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), width);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && width >= narrowest && width <= widest ? width : 0;
}

std::size_t width_of_terminal() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return 0;
  return size.ws_col >= narrowest ? size.ws_col : 0;
}

/// The locale's variables, the first that is set counting.
bool is_utf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    std::string value(variable(name));
    if (value.empty()) continue;
    std::ranges::transform(value, value.begin(), [](unsigned char c) { return std::tolower(c); });
    return value.find("utf-8") != std::string::npos || value.find("utf8") != std::string::npos;
  }
  return false;
}

bool is_failure(std::string_view line) {
  return line.find(" FAILED") != std::string_view::npos ||
         line.find(" failed (seed ") != std::string_view::npos;
}

/// "  verdict   ...", "  ageing_verdict   ...", "  refused   ..."
bool is_verdict(std::string_view line) {
  if (!line.starts_with("  ")) return false;
  const std::string_view word = line.substr(2, line.find(' ', 2) - 2);
  return word.ends_with("verdict") || word == "refused";
}

std::string emphasised(const std::string& text) {
  constexpr const char *bold = "\033[1m", *red = "\033[31m", *plain = "\033[0m";
  std::string shown;
  bool titled = false;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::string_view line = std::string_view(text).substr(start, end - start);
    const bool title = !titled && !line.empty();
    titled = titled || title;
    const char* const style = is_failure(line) ? red : title || is_verdict(line) ? bold : nullptr;
    if (style) shown.append(style).append(line).append(plain);
    if (!style) shown.append(line);
    if (end < text.size()) shown += '\n';
    start = end + 1;
  }
  return shown;
}

}  // namespace

Screen screen() {
  Screen found;
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  const std::size_t asked = width_in(variable("COLUMNS"));
  const std::size_t own = terminal ? width_of_terminal() : 0;
  if (asked > 0 || own > 0) found.width = asked > 0 ? asked : own;
  found.draws = terminal && variable("TERM") != "dumb";
  found.colours = found.draws && variable("NO_COLOR").empty();
  found.unicode = is_utf8();
  return found;
}

void add_wide(Command& command, Layout& layout) {
  layout.width = screen().width;
  command.add_flag(
      "--wide", [&layout] { layout.columns = Columns::all; },
      "Print all columns, rows and sweep points, lines as long as they are");
}

void print_curves(const ResultsFile& file) {
  const Screen now = screen();
  if (!now.draws) return;
  const std::string curves =
      compaction_curves(file, now.width, now.unicode ? Glyphs::unicode : Glyphs::ascii);
  if (!curves.empty()) print("\n" + curves);
}

void print_wrapped(std::string_view text) {
  print(wrapped(printable(text), screen().width));
}

void print_report(std::string_view text) {
  const std::string shown = printable(text);
  print_exactly(screen().colours ? emphasised(shown) : shown);
}

}  // namespace jostle::inline cli
