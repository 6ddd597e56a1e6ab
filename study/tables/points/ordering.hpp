#pragma once

#include <cstdint>
#include <span>

#include "config/scene.hpp"
#include "ensemble/analysis/ordering/ordering_table.hpp"
#include "results/file/results_file.hpp"
#include "study/tables/observable_series.hpp"

namespace jostle::inline study {

/// For all taps of every realization. Throws BadInput where there are fewer than `hold`.
OrderingAnalysis ordering_of(const ObservableSeries& series, const OrderingSettings& settings);

/// Throws BadArgument where a point has no observable of the name that the settings compare.
void require_equilibrium(const ResultsFile& file, std::span<const std::uint32_t> points,
                         const OrderingSettings& settings);

/// Two or more sweep points compared: which orders first, which ends highest. A comparison that is
/// not possible gives a table with the note "refused" alone.
Table ordering_over_points(const ResultsFile& file, std::span<const std::uint32_t> points,
                           const AnalysisRequest<OrderingSettings>& request, Streams streams);

}  // namespace jostle::inline study
