#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "results/file/results_file.hpp"
#include "study/drawing/figures/drawn_file.hpp"
#include "study/drawing/figures/figure.hpp"
#include "study/tables/fits.hpp"

namespace jostle::inline study {

/// A text as part of a file's name: lower-case letters, digits and '-', at most 80.
std::string file_word(const std::string& text);

/// The figures of a results file: those of the page, of the same values. A figure exists only if
/// the file holds its data. No two of them have one name. `points`: selected sweep points; none:
/// where there are more than eight, eight evenly spread. `n_files` share the room that a page has.
/// Throws ResultsError.
struct DrawnFigures {
  std::vector<Figure> figures;
  std::vector<std::string> left_out;  // one sentence each
  bool has_other_points = false;      // more sweep points can be requested
};
DrawnFigures figures_of(const ResultsFile& file, const std::vector<std::uint32_t>& points,
                        std::size_t n_files);

/// The figures of what is drawn of a file: the catalogue. Each names its section.
std::vector<Figure> figures_of(const DrawnFile& file);

/// The figures of the fits of a measured curve, which no results file holds: data with the fitted
/// laws, and residuals.
DrawnFigures figures_of(const FittedCurve& measured);

}  // namespace jostle::inline study
