#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ensemble/analysis/table.hpp"
#include "results/file/results_file.hpp"
#include "structure/measure.hpp"

namespace jostle::inline study {

/// Structure of the kept packings at the given sweep points, averaged over realizations: tables
/// point_PPPP/<part>, as results files keep them, and of two points or more comparison/<part>
/// (ensemble/analysis/structure_comparison.hpp). `taps`: of those with packings; all if none is
/// named. A point without packings, as where its realizations failed, has tables with the note
/// "refused" alone. The tables do not depend on the number of threads. Throws BadInput where no
/// point has packings, or one has none of a tap that is named.
std::vector<Table> structure_of(const ResultsFile& file, std::span<const std::uint32_t> points,
                                const StructureSettings& settings,
                                std::span<const std::uint64_t> taps, int threads);

/// Like the overload above, for extended XYZ files: each file is one realization, each frame a tap;
/// tables <part>. Throws BadInput as above, ResultsError for a file.
std::vector<Table> structure_of(std::span<const std::string> files,
                                const StructureSettings& settings,
                                std::span<const std::uint64_t> frames, int threads);

/// The parts that the scene of a results file requests; no part if it requests none.
StructureSettings structure_asked_for(const ResultsFile& file);

}  // namespace jostle::inline study
