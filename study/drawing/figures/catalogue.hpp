#pragma once

#include <string>
#include <vector>

#include "config/json/json.hpp"
#include "study/drawing/figures/figure.hpp"

// Figures as JSON, which the page and the Python module jostle.plot draw, and as CSV.
// docs/developers/catalogue.md describes both.
namespace jostle::inline study {

/// Digits of numbers: as many as are needed to read the same number, or 7, which a page has room
/// for.
enum class Digits { all, seven };

Json colour_json(const FigureColour& colour);

/// One figure of the catalogue. `origin` names the file and the program.
Json figure_json(const Figure& figure, const std::string& origin, Digits digits);

/// A document of figures, all digits.
Json catalogue_json(const std::vector<Json>& figures, const std::vector<std::string>& left_out);

/// The values of a figure, all digits: a row for each, with the names of its panel and its series.
/// An empty cell is no value. A text that a spreadsheet would compute begins with an apostrophe.
std::string figure_csv(const Figure& figure);

/// Widths of a journal's page.
enum class JournalColumns { single = 1, two = 2 };

/// The script that draws NAME.pdf and NAME.svg again from NAME.json. It holds no text of the
/// figure.
std::string figure_script(const std::string& name, JournalColumns columns);

}  // namespace jostle::inline study
