#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "results/checkpoints/part.hpp"
#include "results/file/results_file.hpp"

// The folder NAME.parts/ as a whole. All throw ResultsError.
namespace jostle::inline results {

bool parts_exist(const std::string& results_path);
/// Makes the folder if it is not there.
void make_parts_folder(const std::string& results_path);
/// Deletes every part, states before their segments, and the folder once it is empty. Files that
/// are not parts stay.
void remove_parts(const std::string& results_path);
std::uint64_t parts_bytes(const std::string& results_path);

/// The realizations that have a checkpoint, ascending.
std::vector<RealizationId> realizations_with_parts(const std::string& results_path);

RealizationSummary summary_of(RealizationId id, const PartState& part);

/// Verifies every part of a run before it resumes, and removes incomplete files of a killed
/// process: temporary files and segments that no checkpoint counts.
std::map<RealizationId, RealizationSummary> verify_parts(const std::string& results_path,
                                                         const std::string& run_id,
                                                         const Study& study);

/// Data of a realization in the file (`base`), continued by its parts, which are verified now
/// and read as they are asked for. `results_path` must outlive it.
std::unique_ptr<StoredRealization> continued(std::unique_ptr<StoredRealization> base,
                                             const std::string& results_path,
                                             const PartIdentity& identity, std::size_t n_columns,
                                             Content content = Content::everything);

}  // namespace jostle::inline results
