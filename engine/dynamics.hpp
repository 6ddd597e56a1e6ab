#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "engine/bed/bed_mechanics.hpp"
#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "engine/starts/starts.hpp"
#include "engine/taps.hpp"

// The seam between what moves spheres and what runs ensembles of beds: one virtual call a slice.
namespace jostle::inline engine {

/// How far a bed is after a tap: it moves, it is at rest, or a limit ended it before it was.
enum class DynamicsStatus : std::uint32_t { running = 0, settled = 1, capped = 2 };

/// Work of moving the spheres.
struct Effort {
  std::uint64_t units = 0;       // units of the engine: trials, sphere steps
  std::uint64_t pair_tests = 0;  // pair distances computed in them

  Effort& operator+=(const Effort& rhs) {
    units += rhs.units;
    pair_tests += rhs.pair_tests;
    return *this;
  }
  Effort operator-(const Effort& rhs) const {
    return {units - rhs.units, pair_tests - rhs.pair_tests};
  }
};

/// The streams of an engine's random numbers: while the start comes to rest, and after taps.
struct DynamicsStreams {
  StreamKey start, taps;
};

/// A state that this program cannot resume; what() gives the reason and what to do.
class StateError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The mechanics of one realization, whatever moves the spheres. Between load, settle and the taps
/// it is advanced by slices; what it does depends neither on how it is sliced nor on whether it was
/// saved and restored between two of them.
class Dynamics {
 public:
  virtual ~Dynamics() = default;

  /// Takes over a bed: as a start was made, or as store() gave it, before restore().
  virtual void load(const Packing& bed) = 0;
  /// Begins to bring a start, made in this way, to rest. One that needs none is at rest at once.
  virtual void settle(const Start& start) = 0;
  /// Excites the bed as it is, or begins to. `random` is the stream of Purpose::tap.
  virtual void tap(const Tap& tap, RandomStream& random) = 0;
  /// For the tap that was just begun, keeps what the bed does while the floor moves, in bins of
  /// this height (diameters): mechanics().driven. Nothing else depends on it. An engine without
  /// time, or a tap that moves no floor, has nothing to keep.
  virtual void watch_motion(double /*bin_width*/) {}
  /// Advances by about so many units, or until the bed is at rest. At rest it does nothing. Throws
  /// std::invalid_argument where the engine's settings do not suit the container.
  virtual DynamicsStatus advance(std::uint64_t units) = 0;
  /// Gives the bed as it is: the container, and [n_spheres] centres in the order of load().
  virtual void store(Packing& bed) const = 0;
  /// For the last tap, along the engine's columns. To be called once the bed is at rest.
  virtual std::vector<double> diagnostics() const = 0;
  /// Velocities, forces and contacts in the bed at the positions that store() gives; to be called
  /// once the bed is at rest. Nothing that follows depends on whether it was. Nothing where spheres
  /// do not move in time.
  virtual BedMechanics mechanics() const { return {}; }
  /// Since this object was made.
  virtual Effort effort() const = 0;
  /// Units that take about a tenth of a second on one core.
  virtual std::uint64_t units_per_slice() const = 0;
  /// Bytes held: positions, and what finds neighbours.
  virtual std::size_t bytes() const = 0;

  /// All that the engine needs besides the bed to resume bit for bit. The bytes begin with their
  /// version.
  virtual std::vector<std::byte> save() const = 0;
  /// Resumes, with the bed loaded before, from the state of save(). Throws StateError for the bytes
  /// of another engine or another version.
  virtual void restore(std::span<const std::byte> state) = 0;
};

}  // namespace jostle::inline engine
