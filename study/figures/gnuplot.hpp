#pragma once

#include <string>

#include "study/figures/figure.hpp"

// A figure as files that gnuplot 5.4 or later draws.
namespace jostle::inline study {

/// Widths of a journal's page, and the text of both.
enum class JournalColumns { one = 1, two = 2 };
inline constexpr double one_column_mm = 86, two_columns_mm = 178, text_points = 8;

/// NAME.dat: blocks of numbers, one a series, two empty lines between them, with all digits.
/// Columns, separated by tabs, are named with their units above each block; "NaN" is no value.
/// `origin` says what file and program they are of.
std::string figure_data(const Figure& figure, const std::string& origin);

/// NAME.gp: draws NAME.svg and NAME.pdf of NAME.dat, in the folder in which gnuplot is called.
std::string figure_script(const Figure& figure, JournalColumns columns);

}  // namespace jostle::inline study
