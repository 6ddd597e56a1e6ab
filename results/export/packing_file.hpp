#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/bed/packing.hpp"

// Packings kept by an earlier run or made elsewhere.
namespace jostle::inline results {

/// Selection of a snapshot of a results file; an extended XYZ file has frames (`tap` then is the
/// frame's number from 0) and no points or realizations.
struct PackingSelector {
  std::uint32_t point = 0;
  std::uint32_t realization = 0;
  std::optional<std::uint64_t> tap{};  // the last kept snapshot if absent
};

/// Reads one packing: from our HDF5, or from extended XYZ (name ends in .xyz or .extxyz), by the
/// rules of docs/reference/file-format.md#extended-xyz. Throws ResultsError if there is no such
/// packing or it is malformed; overlaps are not looked for.
Packing read_packing(const std::string& path, const PackingSelector& selector = {});

/// The packing with its centres inside the container, where cells and neighbours are sought; those
/// of another program may be periods away. Throws std::invalid_argument naming a sphere that no
/// period brings inside.
Packing wrapped_inside(const Packing& packing);

/// Writes one frame of extended XYZ that reads back to the same bits.
void write_extended_xyz(const std::string& path, const Packing& packing);

}  // namespace jostle::inline results
