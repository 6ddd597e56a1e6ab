#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "config/scene.hpp"
#include "ensemble/table.hpp"
#include "results/results_file.hpp"

namespace jostle {

/// The tables of all analyses at the given sweep points, point_PPPP/<analysis>/<observable>, as
/// results files keep them. An analysis that is not possible gives a table with the note "refused"
/// alone. Throws BadInput for an observable that there is not.
std::vector<Table> analyse(const ResultsFile& file, std::span<const std::uint32_t> points,
                           const Analyses& analyses);

/// Whether the table holds an analysis, and no refusal.
bool is_made(const Table& table);

/// Makes, prints briefly (unless quiet) and stores the analyses that the scene of a complete
/// results file asks for. Throws ResultsError.
void make_scene_analyses(const std::string& results, int threads, bool quiet);

}  // namespace jostle
