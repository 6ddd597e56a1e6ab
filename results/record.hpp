#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ensemble/sink.hpp"

namespace jostle::inline results {

/// What is stored of one realization but for its series and its snapshots.
struct RealizationHead {
  RealizationStatus status = RealizationStatus::missing;
  std::string reason;                     // of a failure
  Work work{};                            // over all processes that reported
  std::optional<RealizationState> state;  // where it goes on; none for missing and failed ones
};

/// All that is stored of one realization.
struct RealizationRecord : RealizationHead {
  std::vector<double> rows;               // [n_rows, StudyPoint::n_columns], NaN where undefined
  std::vector<SnapshotRecord> snapshots;  // ascending taps
};

}  // namespace jostle::inline results
