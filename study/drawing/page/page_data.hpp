#pragma once

#include <cstddef>
#include <string>

#include "config/json/json.hpp"
#include "results/file/results_file.hpp"
#include "study/drawing/drawn/drawn_results.hpp"

namespace jostle::inline study {

/// The part of one file that fits into a page.
struct PageRoom {
  DrawnRoom drawn;
  std::size_t packing_bytes = 0;  // bytes of text
};

/// The data that a page shows of a results file: what was run, the figures of the catalogue,
/// derived tables and packings. docs/reference/report.md names its members. `digest`: of the file,
/// or empty. Packings are looked at on so many threads. Throws ResultsError.
Json page_data(const ResultsFile& file, const std::string& digest, const PageRoom& room,
               int threads);

}  // namespace jostle::inline study
