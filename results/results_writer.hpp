#pragma once

#include <functional>
#include <string>
#include <vector>

#include "results/record.hpp"
#include "results/results_file.hpp"
#include "results/study.hpp"

namespace jostle {

/// What a results file is written from.
struct FileContent {
  const Study& study;
  Shard shard;
  std::vector<Provenance> provenance;
  std::string run_id;
  /// Called once for every realization of the study, in the order of (point, realization). Absent:
  /// the small file of a run that has just begun.
  std::function<RealizationRecord(RealizationId)> record;
};

/// Writes a whole results file and publishes it under `path`. Throws ResultsError.
void write_results(const std::string& path, const FileContent& content);

}  // namespace jostle
