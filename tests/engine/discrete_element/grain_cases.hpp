#pragma once

#include <cmath>
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
inline ReducedSettings settings(const ContactLaw& law, double gravity = 0, double finer = 1) {
  DiscreteElement engine;
  engine.spheres = law;
  ReducedSettings out = reduced(engine);
  out.gravity = gravity;
  out.time_step /= finer;
  for (LawConstants* one : {&out.spheres, &out.floor, &out.sides}) one->time_step = out.time_step;
  return out;
}

inline GrainLoop loop_of(const Container& container, const ReducedSettings& settings,
                         const std::vector<GrainState>& grains,
                         InstructionSet set = best_instruction_set()) {
  GrainLoop loop(container, settings, set);
  GrainLoop::State state;
  state.grains = grains;
  loop.restore(state);
  return loop;
}

/// Until two spheres that met have parted, or one has left the floor.
inline void run_contact(GrainLoop& loop, const ReducedSettings& settings) {
  loop.run(static_cast<std::uint64_t>(4 * settings.contact_time / settings.time_step));
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
