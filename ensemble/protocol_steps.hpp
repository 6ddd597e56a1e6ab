#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "ensemble/plan.hpp"

// The stages of a protocol as steps of a control parameter, each with its steady-state value.
namespace jostle::inline ensemble {

/// Taps first .. last of a step, both included.
struct StepTaps {
  std::uint64_t first = 0, last = 0;
  bool operator==(const StepTaps&) const = default;
};

struct ProtocolSteps {
  std::string control, units;     // units of all steps
  std::vector<double> strengths;  // [n_steps], in the order of the protocol
  std::vector<StepTaps> windows;  // [n_steps], the last taps of each
};

/// One step a stage, with its last `last_taps` taps (at least 1; all of a shorter stage). A message
/// where the stages tap in different ways, whose strengths cannot be compared, or all with one
/// strength.
std::variant<ProtocolSteps, std::string> protocol_steps(std::span<const Stage> protocol,
                                                        std::uint64_t last_taps);

/// Means over rows [n_rows, n_realizations] of each realization; NaN where a row has none.
std::vector<double> means_over_rows(std::span<const double> rows, std::uint32_t realizations);

}  // namespace jostle::inline ensemble
