#pragma once

#include <cstdint>
#include <string>

#include "ensemble/analysis/table.hpp"
#include "ensemble/target_precision.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline study {

/// Compares the precision of a file with the target of its scene.
struct PrecisionStatus {
  std::uint32_t realizations = 0, next = 0;  // `next` is the same where no more are to be made
  bool met = false;
  /// The target that is farthest from being met.
  struct Target {
    std::string observable, spread;  // "sigma" or "standard_error"
    double value = 0, at_most = 0;
  };
  Target farthest;
  std::string copies = {};  // realizations that repeat another, which count once
  /// One row a sweep point and target: the largest spread over its taps.
  /// /analysis/target_precision.
  Table table;
};

/// `until` has targets, all of observables in the file. `file` holds its data. Throws ResultsError.
PrecisionStatus precision_status(const ResultsFile& file, const TargetPrecision& until);

}  // namespace jostle::inline study
