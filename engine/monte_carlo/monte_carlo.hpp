#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/column.hpp"
#include "engine/dynamics.hpp"
#include "engine/monte_carlo/moves.hpp"
#include "engine/monte_carlo/stops.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/starts/starts.hpp"

// The Monte Carlo engine: after a tap, trials of single spheres bring the bed to rest.
namespace jostle::inline engine {

/// How a bed comes to rest: the moves, how they are found and when they end.
struct Relaxation {
  Move move;
  Stop stop;
  Sampler sampler = Sampler::exhaustive;
  bool operator==(const Relaxation&) const = default;

  template <class Self = Relaxation>
  static constexpr auto fields() {
    return std::tuple{
        alternative(&Self::move), inlined(&Self::stop),
        field("sampler", &Self::sampler, word(samplers),
              "exhaustive: every trial is tested. skipping: where few trials are accepted, trials "
              "that are certain to be rejected are counted without a test; results have the same "
              "distribution, but other random numbers. Not for a finite beta, fully_periodic, or "
              "an adaptation of not_upward",
              {.title = "Sampler"})};
  }
};

struct MonteCarlo {
  static constexpr const char *unit = "trials", *round = "sweeps";
  /// Sweeps of the relaxation after each tap, a sweep being n_spheres trials: what a tap takes.
  static constexpr const char *work_column = "sweeps", *work = "sweeps";

  Relaxation relax;                                      // after every tap
  std::optional<Relaxation> relax_start = std::nullopt;  // relaxation of the start itself
  bool operator==(const MonteCarlo&) const = default;
};

/// How the start is relaxed before tap 0 is recorded: by `relax_start`; without it a random
/// settle as after a tap, any other start not at all (null).
const Relaxation* relaxation_of_start(const MonteCarlo& settings, const Start& start);

/// Columns of every relaxation: sweeps, a multiple of 1 / n_spheres; acceptance, NaN
/// without trials; capped; dropped_offsets, of a shake.
std::vector<Column> columns(const MonteCarlo& settings, Spheres spheres = Spheres::equal);

/// One realization's mechanics. A unit is a trial; slices end at the end of a sweep.
/// engine/monte_carlo/state.hpp has the saved state.
std::unique_ptr<Dynamics> make_dynamics(const MonteCarlo& settings, const DynamicsStreams& streams);

}  // namespace jostle::inline engine
