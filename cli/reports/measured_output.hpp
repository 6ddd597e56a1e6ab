#pragma once

#include <string>

#include "cli/files/figure_files.hpp"
#include "cli/options/command.hpp"
#include "study/tables/fits.hpp"

namespace jostle::inline cli {

/// Outputs of `fit` for a measured curve besides its report: figures and a page.
struct MeasuredOutput {
  std::string page;
  FigureFolder figures;
  int columns = 1;  // columns of a journal

  bool is_wanted() const { return !page.empty() || !figures.path.empty(); }
};

/// --figures, --columns, --page.
void add_measured_output(Command& command, MeasuredOutput& output);

/// Throws BadInput where the page may not be written. `force`: replace files that exist.
void require_measured_output(const MeasuredOutput& output, const std::string& input, bool force);

/// Writes the requested outputs of a curve with a fit. Returns a description for people.
std::string write_measured(const MeasuredOutput& output, const FittedCurve& fitted,
                           const std::string& input, bool force, const Provenance& provenance);

}  // namespace jostle::inline cli
