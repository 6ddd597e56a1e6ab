#pragma once

#include <span>
#include <string>
#include <vector>

#include "config/scene.hpp"
#include "ensemble/analysis/table.hpp"
#include "results/file/results_file.hpp"
#include "study/tables/points/derived_value.hpp"

namespace jostle::inline study {

/// Quantities against the swept value, sweep/<observable>/<quantity> with '_' for '/': over the
/// points of all files together, each file with its own sweep or none. A strength of taps is drawn
/// as its control parameter, eps^(1/2) for a dilation. Where other values are swept too, one table
/// for every combination of them, numbered. Fits and analyses are taken from `made`, of the first
/// file, else from what the files keep. An impossible analysis, for example of an unknown
/// observable, gives a table with only the note "refused". Throws ResultsError.
std::vector<Table> sweep_tables(std::span<const ResultsFile* const> files, const MadeTables& made,
                                const std::vector<AnalysisRequest<SweepSettings>>& requests);

}  // namespace jostle::inline study
