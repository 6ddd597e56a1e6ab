#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace jostle::inline study {

/// A line of a text of columns.
struct DelimitedLine {
  std::size_t number = 0;  // in the file, from 1
  std::string text;        // unchanged text
  std::vector<std::string> cells;
};

/// A text of columns, without its empty lines.
struct DelimitedText {
  std::vector<DelimitedLine> lines;
  /// The last comment above the first line, without its '#': numpy writes names of columns there.
  DelimitedLine comment;
};

/// Cells divided by semicolons, else commas, else tabs, else blanks: never by two of them, so that
/// a decimal comma is no number and not two. A cell in double quotes may contain its divider;
/// blanks around cells are dropped.
std::vector<std::string> divided_cells(const std::string& line);

/// Reads a text of columns. Lines end in LF, CR LF or CR, also mixed, and a byte-order mark of
/// UTF-8 is skipped. Lines that begin with # are comments. Throws BadInput for UTF-16 and for a
/// quote that is not closed, ResultsError where the file cannot be read to its end.
DelimitedText read_delimited_text(const std::string& path);

}  // namespace jostle::inline study
