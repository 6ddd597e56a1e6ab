#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "results/content/stored_realization.hpp"
#include "results/content/study.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline results {

/// Source of the data of a results file.
struct FileContent {
  const Study& study;
  Shard shard;
  std::vector<Provenance> provenance;
  std::string run_id;
  /// Called once for every realization of the study, in the order of (point, realization); those of
  /// a point are kept while it is written. Absent: the small file of a run that has just begun.
  std::function<std::unique_ptr<StoredRealization>(RealizationId)> realization;
  /// Receives the number of written realizations and the total; may be absent.
  StoringProgress progress = {};
  /// The file whose derived tables are kept, with their origins; may be absent.
  const ResultsFile* tables_of = nullptr;
};

/// Writes a whole results file and publishes it under `path`; `prepare` is called when all has been
/// written, before what was there is replaced. In memory it holds some 32 MB of
/// the series of a point, a snapshot, and about 1 kB for every realization and 500 bytes for every
/// snapshot of a point. Throws ResultsError.
void write_results(const std::string& path, const FileContent& content,
                   const std::function<void()>& prepare = {});

}  // namespace jostle::inline results
