#pragma once

#include <optional>
#include <span>
#include <string>

#include "results/content/study.hpp"
#include "results/locks/patience.hpp"

namespace jostle::inline results {

/// Joins the complete files of all shards of one study into one whose digest is that of a single
/// run. Files of different studies are joined to `whole`, of which each holds some sweep points.
/// Throws ResultsError naming the file, where an input is unfinished or damaged, has another
/// scene, holds a realization that an earlier input holds too, or where no input holds one; and
/// where `output` exists, unless `force`.
void merge_files(std::span<const std::string> inputs, const std::string& output,
                 const Provenance& provenance, bool force = false,
                 const std::optional<Study>& whole = std::nullopt, const Patience& patience = {});

}  // namespace jostle::inline results
