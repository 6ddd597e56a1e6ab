#pragma once

#include <string>
#include <vector>

#include "config/json/json.hpp"
#include "study/drawing/figures/catalogue.hpp"

namespace jostle::inline cli {

/// A figure that matplotlib drew.
struct PaperFigure {
  std::string svg, pdf;
};

/// Draws the figures of a catalogue by the Python module jostle.plot, which is looked for beside
/// the program (../lib/python3/dist-packages), then where python3 finds it. python3 gets the
/// catalogue as a file in a scratch folder: no shell, and no text of a figure among its arguments.
/// Throws ResultsError where python3, matplotlib or the module is missing, or fails.
std::vector<PaperFigure> draw_with_python(const std::vector<Json>& figures, JournalColumns columns);

}  // namespace jostle::inline cli
