#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "engine/bed/window.hpp"
#include "engine/instruction_set.hpp"
#include "engine/monte_carlo/moves.hpp"

namespace jostle::inline engine {

/// State of the trials of a realization; with the positions, all that the next trial depends on.
struct MoveState {
  std::uint64_t next_trial = 0;     // number of the next trial of the realization: Philox's counter
  double step = 0;                  // Metropolis: the current largest displacement, diameters
  std::uint64_t window_trials = 0;  // trials counted since the last adaptation of the step
  std::uint64_t window_base = 0;    // trials of which the share is taken
  std::uint64_t window_accepted = 0;  // accepted trials among these
  bool operator==(const MoveState&) const = default;
};

/// How a loop finds the trials that move a sphere. The law of the trajectory is the same.
enum class Sampler {
  exhaustive,      // looks at every trial
  rejection_free,  // advances over trials that are certain to be rejected, once few are accepted
};
inline constexpr NameTable<Sampler, 2> samplers{
    {{"exhaustive", Sampler::exhaustive}, {"skipping", Sampler::rejection_free}}};

/// The spheres that a loop is compiled for: equal ones cost less.
enum class SphereSizes { equal, several };

/// State of the rejection-free sampler besides MoveState; unused by the exhaustive one.
struct SamplerState {
  bool active = false;                // else every trial is looked at, as after each tap
  std::uint64_t window_trials = 0;    // looked at since it was last decided whether to be active
  std::uint64_t window_accepted = 0;  // window accepted trials
  std::uint64_t candidate = 0;        // number of the next candidate of the realization
  std::uint64_t pending = 0;          // number of the trial that it is
  double reference_step = 0;          // Metropolis: the step for which the bounds are, diameters
  bool operator==(const SamplerState&) const = default;
};

/// Counts since the loop was made; they steer nothing that is stored.
struct TrialTally {
  std::uint64_t trials = 0;
  std::uint64_t accepted = 0;
  std::uint64_t distance_tests = 0;
  std::uint64_t list_builds = 0;    // list builds of all neighbour lists at once
  std::uint64_t list_renewals = 0;  // list renewals of one sphere's list
  std::uint64_t candidates = 0;     // rejection-free: trials looked at while active
  std::uint64_t bound_rows = 0;     // rejection-free: makings of a sphere's bounds
};

/// Trial moves of hard spheres: proposes, tests for overlap, accepts or rejects. The container, the
/// move and whether spheres have sizes are chosen once, here; the loop inside is compiled for them.
class TrialLoop {
 public:
  virtual ~TrialLoop() = default;

  /// Takes over the centres and the sizes of a packing in the loop's container. Throws
  /// std::invalid_argument where it has sizes and the loop is made for equal spheres.
  virtual void load(const Packing& packing) = 0;
  /// Writes the centres back: packing.centres, [n_spheres], in the order they were loaded.
  virtual void store(Packing& packing) const = 0;
  /// Makes `n_trials` trials. The trajectory does not depend on how trials are split over calls.
  virtual void run(std::uint64_t n_trials) = 0;
  /// Begins the relaxation of a tap: resets the Metropolis step where the move asks for it.
  virtual void begin_tap() = 0;

  /// <Z> of the spheres at their positions, equal to mean_height() of their packing.
  virtual double mean_height() const = 0;
  /// Those of the kinds of a mixture, as kind_heights() of the packing gives them.
  virtual std::vector<double> kind_heights() const { return {}; }
  /// Packing fraction between two heights (engine/bed/slab.hpp).
  virtual double solids_fraction(HeightWindow window) const = 0;
  virtual std::uint32_t n_spheres() const = 0;
  virtual const MoveState& state() const = 0;
  virtual SamplerState sampler_state() const { return {}; }
  /// Resumes, with the centres loaded before, from the state of another loop.
  virtual void restore(const MoveState& state, const SamplerState& sampler = {}) = 0;
  virtual const TrialTally& tally() const = 0;
  /// Bytes held, positions and neighbour lists included.
  virtual std::size_t bytes() const = 0;
};

/// Why spheres in the container cannot move so; nothing if they can. A polar move needs gravity.
std::optional<std::string> move_fault(const Move& move, const Container& container);

/// Why the sampler does not suit the move in the container; nothing if it does. The rejection-free
/// sampler needs trials that never rise: gravity, and of the Metropolis move beta = infinity and an
/// adaptation that counts all trials.
std::optional<std::string> sampler_fault(Sampler sampler, const Move& move,
                                         const Container& container);

/// Chooses the loop for a container and a move. `key` is the stream of Purpose::trials. A loop for
/// several sizes takes equal spheres too, and then makes the same trajectory as the other.
/// Throws std::invalid_argument with move_fault or sampler_fault where there is one.
std::unique_ptr<TrialLoop> make_trial_loop(const Container& container, const Move& move,
                                           StreamKey key,
                                           InstructionSet set = best_instruction_set(),
                                           Sampler sampler = Sampler::exhaustive,
                                           SphereSizes sizes = SphereSizes::equal);

}  // namespace jostle::inline engine
