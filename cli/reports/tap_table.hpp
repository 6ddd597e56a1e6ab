#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cli/tables/layout.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline cli {

/// The columns of a point, and how many realizations have come to each tap.
struct PointSeries {
  std::vector<EnsembleSeries> columns;
  std::vector<std::uint32_t> reached;  // [n_taps]
  std::uint32_t planned = 0;           // realizations planned in the file's share
  std::string copies = {};  // realizations left out of the columns because they repeat another
};

PointSeries point_series(const ResultsFile& file, std::uint32_t point,
                         std::span<const RealizationSummary> realizations);

/// A row for about three taps per decade: the observables' means with their standard errors, and
/// what of the engine's means has room beside them; with all columns, sigma and all of these.
std::string tap_table(const PointSeries& series, const Layout& layout);

/// 0, 1, 2, 5, 10, 20, 50, ... below `last`, and `last`.
std::vector<std::uint64_t> reported_taps(std::uint64_t last);

}  // namespace jostle::inline cli
