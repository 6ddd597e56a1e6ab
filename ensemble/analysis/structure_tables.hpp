#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ensemble/analysis/table.hpp"
#include "structure/measure.hpp"

// The structure of packings averaged over realizations, tap by tap.
namespace jostle::inline ensemble {

/// Results of measure() for every packing, with common settings.
struct EnsembleStructure {
  std::vector<std::uint64_t> taps;                              // [n_taps], ascending
  std::vector<std::vector<std::vector<Measurement>>> packings;  // [n_taps][n_realizations][n_parts]
                                                                // no parts: no packing
};

/// One table a part, `prefix` + its name: every quantity against tap (and its places), the mean
/// over realizations with its standard error (not a number with one realization); changes since the
/// first tap, whose error is that of the differences realization by realization; the laws that the
/// papers fit to a part, fitted to the mean curves, with jackknife errors. A part that every
/// packing refuses gives a table with the note "refused" alone.
std::vector<Table> structure_tables(const std::string& prefix, const EnsembleStructure& structure,
                                    const StructureSettings& settings);

}  // namespace jostle::inline ensemble
