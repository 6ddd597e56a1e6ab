#pragma once

#include "config/scene.hpp"

// Defaults that depend on other keys. Where these are swept and the default differs between points,
// it is left out of the resolved scene, from which the points are made: each has its own.
namespace jostle::inline config {

/// True if `steps_per_contact` was not given and the swept laws of contact have other defaults.
/// Requires discrete elements.
bool leaves_steps_out(const Scene& scene);

/// True if `keep` is the engine's default and the engine is swept.
bool leaves_kept_data_out(const Scene& scene);

/// True if `observe` is the default of the kinds, and other kinds are swept.
bool leaves_observables_out(const Scene& scene);

}  // namespace jostle::inline config
