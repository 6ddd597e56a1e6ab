#pragma once

#include <optional>
#include <vector>

#include "config/scene.hpp"

// Lists that a scene gives by a rule.
namespace jostle::inline config {

/// The double nearest to the value's first 15 significant digits: 1e-7, not 1.0000000000000001e-07.
double rounded_to_15_digits(double value);

/// How many steps lead from one end of a ramp to the other; nothing where no whole number does, to
/// one part in 1e6 of a step.
std::optional<std::uint64_t> whole_steps(const Ramp& ramp);

/// The stages of a protocol, ramps written out, stages without taps left out.
std::vector<Stage> stages(const std::vector<ProtocolLine>& protocol);

std::uint64_t total_taps(const std::vector<ProtocolLine>& protocol);

/// The taps that are chosen, ascending, none twice.
std::vector<std::uint64_t> chosen_taps(const TapChoice& choice);

/// The most snapshots that a rule can choose in one realization.
inline constexpr std::uint64_t most_snapshots_by_rule = 100'000;

/// The taps of a protocol of so many taps after which packings are kept, ascending, none twice:
/// those that are named, and those of `every`, of which at most most_snapshots_by_rule + 1.
std::vector<std::uint64_t> snapshot_taps(const SnapshotChoice& choice, std::uint64_t taps);

/// Returns the waiting times and lags for so many taps. Default grids begin alike for any number of
/// taps, so that a run can be resumed with more.
MotionSettings motion_settings(const MotionChoice& choice, std::uint64_t taps,
                               std::size_t n_kinds = 0);

}  // namespace jostle::inline config
