#pragma once

#include <string>

#include "results/checkpoints/part.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline results {

/// Writes the parts of one realization while it runs. One thread at a time.
class Recorder {
 public:
  /// Resumes from `part`, the last checkpoint or an empty one.
  Recorder(std::string results_path, PartIdentity identity, std::size_t n_columns, PartState part);

  void append(const TapRow& row);
  void snapshot(const SnapshotRecord& record);
  /// Both publish a state, with the work of all processes, and return its content.
  RealizationSummary checkpoint(const RealizationState& state, const Work& work);
  RealizationSummary end(const RealizationState& state, const Outcome& outcome);

 private:
  std::uint64_t next_row() const;
  void publish_tail_if_large();
  void set_work(const Work& of_this_process);
  RealizationSummary publish_state();

  std::string results_path_;
  PartIdentity identity_;
  std::size_t n_columns_;
  PartState part_;
  Work work_before_;  // work by earlier processes
};

}  // namespace jostle::inline results
