#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/bed/random.hpp"
#include "engine/discrete_element/grain_loop.hpp"
#include "engine/starts/starts.hpp"

// Spheres set in motion by hand, in the engine's own units: gravity is 1 or 0.
namespace jostle::grain_cases {

inline GrainState grain(Vec3 centre, Vec3 velocity = {}, Vec3 spin = {}) {
  return {.centre = centre,
          .velocity = velocity,
          .spin = spin,
          .seen_velocity = velocity,
          .seen_spin = spin};
}

/// `finer`: how many times shorter than by default the time step is.
inline ReducedSettings settings(const ContactLaw& law, double gravity = 0, double finer = 1,
                                const LightestMasses& lightest = {}) {
  DiscreteElement engine;
  engine.spheres = law;
  ReducedSettings settings = reduced(engine, lightest);
  settings.gravity = gravity;
  settings.time_step /= finer;
  for (LawConstants* constants : {&settings.spheres, &settings.floor, &settings.sides})
    constants->time_step = settings.time_step;
  return settings;
}

inline GrainLoop loop_of(const Container& container, const ReducedSettings& settings,
                         const std::vector<GrainState>& grains,
                         InstructionSet set = best_instruction_set(),
                         std::shared_ptr<const Sizes> sizes = nullptr) {
  GrainLoop loop(container, settings, set, std::move(sizes));
  GrainLoop::State state;
  state.grains = grains;
  loop.restore(state);
  return loop;
}

/// Until two spheres that met have parted, or one has left the floor.
inline void run_contact(GrainLoop& loop, const ReducedSettings& settings) {
  loop.run(static_cast<std::uint64_t>(4 * settings.contact_time / settings.time_step));
}

/// Spheres of these diameters, each of a kind and a density of its own.
inline std::shared_ptr<const Sizes> sizes_of(const std::vector<double>& diameters,
                                             const std::vector<double>& densities) {
  std::vector<std::uint32_t> kinds;
  std::vector<SphereKind> of_kinds;
  for (const double density : densities) {
    kinds.push_back(static_cast<std::uint32_t>(kinds.size()));
    of_kinds.push_back({"kind" + std::to_string(kinds.size()), density});
  }
  return std::make_shared<const Sizes>(diameters, kinds, of_kinds);
}

/// A bed under gravity, whose lightest spheres decide the step.
inline ReducedSettings settings_for(const ContactLaw& law, const Packing& bed, double finer = 1) {
  return settings(law, 1, finer, lightest_masses(bed));
}

/// The bed at rest.
inline GrainLoop loop_for(const Packing& bed, const ReducedSettings& units,
                          InstructionSet set = best_instruction_set()) {
  GrainLoop loop(bed.container, units, set, bed.sizes);
  loop.load(bed);
  return loop;
}

inline std::uint64_t steps_of(double time, const ReducedSettings& units) {
  return static_cast<std::uint64_t>(time / units.time_step);
}

inline double length(Vec3 a) {
  return std::sqrt(norm_squared(a));
}

/// A loose bed of a few hundred spheres under gravity, as poured from a dilute column.
inline Packing dilute_column(const Container& container, std::uint32_t n, std::uint64_t seed) {
  RandomStream random(stream_key(seed, 0, 0, Purpose::start));
  return make_start(RandomSettle{0.2}, container, n, random);
}

}  // namespace jostle::grain_cases
