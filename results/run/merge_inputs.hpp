#pragma once

#include <list>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "results/content/stored_realization.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline results {

/// Files that are merged, of which there may be thousands: few of them are open at once, and those
/// of one scene share one study.
class MergeInputs {
 public:
  /// Opens and verifies each. Throws ResultsError.
  explicit MergeInputs(std::span<const std::string> paths);

  const std::vector<ResultsFile>& files() const { return files_; }
  /// A file that is read from now on; the one that was read longest ago rests for it.
  const ResultsFile& open(std::size_t number);
  /// A realization of a file, by the file's own number of its point.
  std::unique_ptr<StoredRealization> realization(std::size_t number, RealizationId id);

 private:
  std::vector<ResultsFile> files_;
  std::list<std::size_t> open_;  // the last read first
};

}  // namespace jostle::inline results
