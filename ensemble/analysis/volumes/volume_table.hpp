#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "ensemble/analysis/steady_state.hpp"
#include "ensemble/analysis/table.hpp"
#include "ensemble/analysis/volumes/compactivity.hpp"
#include "structure/observables.hpp"

namespace jostle::inline ensemble {

/// How an observable becomes a volume, in volumes of a sphere: that of `spheres` spheres at a
/// packing fraction, or `per_height` times a mean height.
struct VolumeOf {
  double spheres = 0;
  std::optional<double> per_height = std::nullopt;
  double operator()(double value) const {
    return per_height ? *per_height * value : spheres / value;
  }
};

/// One strength, or one step of a protocol.
struct VolumeState {
  double strength = 0;
  std::uint64_t first_tap = 0, last_tap = 0;
  SteadyState steady{};        // steadiness of the observable
  SteadyVolumes observable{};  // statistics of the observable itself
  SteadyVolumes volumes{};     // counted
  bool used() const { return steady.verdict() != Verdict::not_reached; }
};

/// Mean and variance of observable and volume at each strength, 1/X by both estimators from the
/// first steady one on, and their comparison. States that are not steady have no part in 1/X and
/// are named. `bins`: bins of the volumes of the others.
Table volume_table(std::string name, const Column& observable, const std::string& control,
                   const std::string& units, const VolumeOf& volume_of,
                   std::span<const VolumeState> states, const VolumeBins& bins);

}  // namespace jostle::inline ensemble
