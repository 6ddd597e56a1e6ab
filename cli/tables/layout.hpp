#pragma once

#include <cstddef>
#include <string>

namespace jostle::inline cli {

enum class Columns { few, all };

/// How a report for people is laid out.
struct Layout {
  std::size_t width = 80;  // width of a line, in characters; tables of all columns go beyond it
  Columns columns = Columns::few;

  std::size_t table_width() const { return columns == Columns::all ? std::string::npos : width; }
};

}  // namespace jostle::inline cli
