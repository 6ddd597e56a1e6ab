#pragma once

#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "ensemble/sink.hpp"

namespace jostle {

inline constexpr std::size_t n_relaxation_columns = std::size(relaxation_columns);

/// What is stored of one realization but for its series and its snapshots.
struct RealizationHead {
  RealizationStatus status = RealizationStatus::missing;
  std::string reason;                     // of a failure
  Work work{};                            // over all processes that reported
  std::optional<RealizationState> state;  // where it goes on; none for missing and failed ones
};

/// All that is stored of one realization.
struct RealizationRecord : RealizationHead {
  std::vector<double> rows;  // [n_rows, n_observables + n_relaxation_columns], NaN where undefined
  std::vector<SnapshotRecord> snapshots;  // ascending taps
};

}  // namespace jostle
