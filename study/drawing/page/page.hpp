#pragma once

#include <span>
#include <string>

#include "results/file/results_file.hpp"

namespace jostle::inline study {

/// A results file, and its digest (empty if unknown, as for a run in progress).
struct PageSource {
  const ResultsFile& file;
  std::string digest;
};

/// One HTML page that shows the files: it needs no network and no other file, and runs no code from
/// them. It is smaller than about 10 MB for any file: large data are thinned, and the page reports
/// it. `provenance` made the page. Throws ResultsError.
std::string report_page(std::span<const PageSource> sources, const Provenance& provenance,
                        int threads);

}  // namespace jostle::inline study
