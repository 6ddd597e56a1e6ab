#pragma once

#include <string>

#include "results/file/results_file.hpp"
#include "results/run/run_store.hpp"
#include "synthetic.hpp"

// Whole runs of the synthetic study.
namespace jostle::synthetic {

inline void run_pending(RunStore& store, const Study& study, const Conduct& conduct = {}) {
  for (const RealizationId id : store.pending()) run(store, study, id, conduct);
}

/// Runs a shard of a study from start to end into a file; returns its digest.
inline std::string run_to_end(const std::string& path, const StudySize& sizes = {},
                              const Shard& shard = {}) {
  const Study all = study(sizes);
  const auto store = RunStore::create(path, all, shard, provenance(), true);
  run_pending(*store, all);
  store->finish();
  return digest_of(path);
}

}  // namespace jostle::synthetic
