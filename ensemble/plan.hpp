#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/bed/container.hpp"
#include "engine/bed/mixture.hpp"
#include "engine/bed/random.hpp"
#include "engine/engines.hpp"
#include "engine/fields.hpp"
#include "engine/starts/starts.hpp"
#include "engine/taps.hpp"
#include "ensemble/motion/motion.hpp"
#include "structure/observables.hpp"

namespace jostle::inline ensemble {

/// Realizations of a plan, at most.
inline constexpr std::uint32_t most_realizations = 1'000'000;

/// For all sweep points together, at most: realizations, observables, values of the sweep, taps
/// with snapshots.
inline constexpr std::uint64_t most_realizations_in_all = 10'000'000;
inline constexpr std::uint64_t most_observables_in_all = 2'000'000;
inline constexpr std::uint64_t most_swept_values_in_all = 2'000'000;
inline constexpr std::uint64_t most_snapshots_in_all = 50'000'000;

/// `count` taps of the same kind and strength.
struct Stage {
  Tap tap;
  std::uint64_t count = 0;
  bool operator==(const Stage&) const = default;
};

/// Data kept at chosen taps (tap 0 is the start).
struct Snapshots {
  std::vector<std::uint64_t> taps;  // ascending, each at most the number of taps
  bool positions = true;
  bool coordination = true;
  double contact_cut = 1.05;  // diameters
  bool height_histogram = true;
  double bin_width = 0.1;  // diameters
  // For engines that move spheres in time (BedMechanics):
  bool velocities = false;            // and spins; where positions are kept
  bool contacts = false;              // where positions are kept
  bool granular_temperature = false;  // in bins as those of the histogram
  bool forces = false;                // BedForces
  bool driven_temperature = false;    // DrivenBed, in the same bins, of taps that move the floor
  bool operator==(const Snapshots&) const = default;
};

/// True if every sweep point draws its own random numbers, or start and tap streams are the same at
/// all points (those of point id 0), so that points are compared on paired packings. The trials
/// after taps always draw the point's own.
enum class Streams { independent, matched };
inline constexpr NameTable<Streams, 2> stream_kinds{
    {{"independent", Streams::independent}, {"matched", Streams::matched}}};

/// All that one sweep point of a study needs: what is simulated, what is measured, which numbers
/// are drawn. Realizations differ only in their index.
struct Plan {
  std::string label;  // "epsilon = 0.005", for people; empty without a sweep
  std::vector<std::pair<std::string, std::string>> sweep_values;  // JSON pointer, JSON value
  std::uint64_t point_id = 0;  // hash of sweep_values: 0 without a sweep
  std::uint64_t seed = 1;
  Streams streams = Streams::independent;

  Container container;
  std::uint32_t n_spheres = 0;     // n spheres of all kinds
  std::vector<MixtureKind> kinds;  // kinds of a mixture whose sizes are drawn; empty: equal
                                   // spheres, or those of a given packing
  PourOrder pour_order = PourOrder::random;  // pour order of a mixture
  Start start;
  std::vector<Stage> protocol;
  EngineSettings engine;

  std::vector<Observable> observables;
  Snapshots snapshots;
  std::optional<MotionSettings> motion;
};

/// Taps of the whole protocol.
std::uint64_t total_taps(const Plan& plan);

/// The stream of a realization at the plan's sweep point. Matched: the start, its relaxation and
/// the taps draw at every point what they draw at the point without values.
StreamKey stream_key(const Plan& plan, std::uint32_t realization, Purpose purpose);

/// The sizes of the spheres of a realization: drawn from its stream of Purpose::sizes, or those of
/// the given packing; null for equal spheres.
std::shared_ptr<const Sizes> sizes_of(const Plan& plan, std::uint32_t realization);

/// True if realizations may differ in the diameters of their spheres.
bool has_drawn_sizes(const Plan& plan);

/// The spheres that a start places, with these sizes.
StartSpheres start_spheres(const Plan& plan, std::shared_ptr<const Sizes> sizes);

/// The tap with number t in 1 .. total_taps(plan).
const Tap& tap_number(const Plan& plan, std::uint64_t t);

}  // namespace jostle::inline ensemble
