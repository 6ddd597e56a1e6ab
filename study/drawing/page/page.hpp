#pragma once

#include <span>
#include <string>

#include "results/results_file.hpp"

namespace jostle::inline study {

/// A results file, and its digest (empty where it is not known, as of a run that goes on).
struct PageSource {
  const ResultsFile& file;
  std::string digest;
};

/// One HTML page that shows the files: it needs no network and no other file, and runs nothing that
/// stands in them. Less than about 10 MB, whatever they hold: what has no room is thinned, and the
/// page says so. `by` made the page. Throws ResultsError.
std::string report_page(std::span<const PageSource> sources, const Provenance& by, int threads);

}  // namespace jostle::inline study
