#pragma once

#include <span>
#include <string>
#include <vector>

#include "results/file/results_file.hpp"
#include "study/drawing/figures/catalogue.hpp"
#include "study/tables/fits.hpp"

namespace jostle::inline cli {

/// Output of the figures of a report.
struct FigureFolder {
  std::string path;  // made where there is none
  JournalColumns columns = JournalColumns::single;
  bool force = false;       // replace files that exist
  std::string sweep_point;  // empty: as figures_of() chooses
};

/// Writes the figures of the files: NAME.csv, NAME.json, NAME.py, and, drawn by matplotlib,
/// NAME.svg and NAME.pdf. The first three are written also where matplotlib is missing. Returns
/// what was written, for people. Throws BadInput before anything is written, and ResultsError.
std::string write_figures(std::span<const ResultsFile> files, const FigureFolder& folder,
                          const Provenance& provenance);

/// The catalogue of the files' figures as JSON, all digits. `sweep_point`: as of FigureFolder.
std::string figure_catalogue(std::span<const ResultsFile> files, const std::string& sweep_point,
                             const Provenance& provenance);

/// Does so for the fits of a measured curve, which `input` holds.
std::string write_figures(const FittedCurve& measured, const std::string& input,
                          const FigureFolder& folder, const Provenance& provenance);

}  // namespace jostle::inline cli
