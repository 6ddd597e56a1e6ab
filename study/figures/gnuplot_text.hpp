#pragma once

#include <cstddef>
#include <string>

#include "study/figures/figure.hpp"

// Texts of a results file between gnuplot's own words. They may hold anything.
namespace jostle::inline study {

/// What stands in the columns of a panel's data behind x and y.
struct ColumnsOfData {
  bool error = false, limits = false, label = false;
};
ColumnsOfData columns_of_data(const FigurePanel& panel);

/// In a comment: one line, which no backslash joins to the next.
std::string comment_text(const std::string& text);
/// Between the double quotes of a data file.
std::string data_text(const std::string& text);
/// In single quotes, as gnuplot's enhanced text that shows it as it is; "N_c" has a subscript.
std::string quoted(const std::string& text);
/// The same without markup, for what is set with `noenhanced`.
std::string plainly_quoted(const std::string& text);

/// Letters of a text in UTF-8, and the first n of them, with a mark where there are more.
std::size_t n_letters(const std::string& text);
std::string first_letters(const std::string& text, std::size_t n);

}  // namespace jostle::inline study
