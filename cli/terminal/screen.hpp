#pragma once

#include <cstddef>
#include <string_view>

#include "cli/options/command.hpp"
#include "cli/tables/layout.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline cli {

/// Capabilities of standard output.
struct Screen {
  std::size_t width = 80;  // width of a line: COLUMNS, else the terminal's, else 80
  bool draws = false;      // a terminal, and not a dumb one (TERM)
  bool colours = false;    // one that draws, where NO_COLOR is not set
  bool unicode = false;    // the locale is one of UTF-8
};

/// Detected from the environment.
Screen screen();

/// --wide; and the layout gets the width of the screen.
void add_wide(Command& command, Layout& layout);

/// Prints the compaction curves of a file where the screen draws: in braille, or plainly where the
/// locale is not UTF-8.
void print_curves(const ResultsFile& file);

/// Prints as print() what is no table, with lines folded to the width of the screen.
void print_wrapped(std::string_view text);

/// Prints as print(). Where there are colours the first line and verdicts are bold, and what failed
/// is red.
void print_report(std::string_view text);

}  // namespace jostle::inline cli
