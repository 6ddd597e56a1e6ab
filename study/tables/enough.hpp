#pragma once

#include <cstdint>
#include <string>

#include "ensemble/analysis/table.hpp"
#include "ensemble/enough.hpp"
#include "results/results_file.hpp"

namespace jostle {

/// How far a file is from what a scene calls enough realizations.
struct EnoughStatus {
  std::uint32_t realizations = 0, next = 0;  // `next` is the same where no more are to be made
  bool met = false;
  /// One row a sweep point and target: the largest spread over its taps. /analysis/enough.
  Table table;
};

/// `until` has targets, all of observables in the file. `file` holds its data. Throws ResultsError.
EnoughStatus enough_status(const ResultsFile& file, const Enough& until);

}  // namespace jostle
