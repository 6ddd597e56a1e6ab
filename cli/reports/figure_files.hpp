#pragma once

#include <span>
#include <string>
#include <vector>

#include "results/results_file.hpp"
#include "study/figures/gnuplot.hpp"
#include "study/tables/fits.hpp"

namespace jostle::inline cli {

/// What the figures of a report are written to.
struct FigureFolder {
  std::string path;  // made where there is none
  JournalColumns columns = JournalColumns::one;
  bool force = false;       // replace files that exist
  std::string sweep_point;  // empty: as figures_of() chooses
};

/// Writes the figures of the files: NAME.dat, NAME.gp, and, drawn by gnuplot, NAME.svg and
/// NAME.pdf. Data and scripts are there also where gnuplot is not. Returns what was written, for
/// people. Throws BadInput before anything is written, and ResultsError.
std::string write_figures(std::span<const ResultsFile> files, const FigureFolder& folder,
                          const Provenance& by);

/// Returns the fits of a measured curve, which `input` holds.
std::string write_figures(const FittedCurve& measured, const std::string& input,
                          const FigureFolder& folder, const Provenance& by);

}  // namespace jostle::inline cli
