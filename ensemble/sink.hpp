#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/bed/vec3.hpp"
#include "engine/bed/window.hpp"
#include "engine/dynamics.hpp"
#include "ensemble/fitting_report.hpp"
#include "ensemble/motion/motion.hpp"
#include "structure/forces.hpp"

// Receives an ensemble's numbers. The storage is up to the implementation.
namespace jostle::inline ensemble {

/// One realization of one sweep point: both are indices into the study.
struct RealizationId {
  std::uint32_t point = 0;
  std::uint32_t realization = 0;
  auto operator<=>(const RealizationId&) const = default;
};

/// Other columns of a sweep point: no observable may have one of these names.
inline constexpr const char* names_beside_series[] = {"tap",    "realization", "status",
                                                      "reason", "rows",        "trial_key"};

/// One row of the series: tap 0 is the start.
struct TapRow {
  std::uint64_t tap = 0;
  std::vector<double> observables;  // [n_observables of the plan]
  std::vector<double> diagnostics;  // diagnostics of the engine, along columns(plan.engine)
};

struct SnapshotRecord {
  std::uint64_t tap = 0;
  std::vector<Vec3> centres;  // [n_spheres], or empty where not kept
  std::optional<double>
      coordination;  // mean number of centres within the cut, as coordination() has it
  std::vector<double> height_histogram;  // [n_bins], or empty where not kept
  // For engines that move spheres in time, empty where not kept. BedMechanics, GranularTemperature:
  std::vector<Vec3> velocities{}, spins{};
  std::vector<Contact> contacts{};
  std::vector<double> temperature_lateral{}, temperature_vertical{};
  std::optional<BedForces> forces{};
  std::vector<double> driven_fraction{}, driven_lateral{}, driven_vertical{};  // DrivenBed
};

/// A realization between two slices: what it needs to go on bit for bit.
struct RealizationState {
  std::uint64_t rows = 0;                 // recorded: taps 0 .. rows - 1; the next is tap `rows`
  bool relaxing = false;                  // tap `rows` was excited and is not yet at rest
  std::vector<std::byte> engine;          // Dynamics::save; empty until there is a start
  std::uint64_t tap_stream_position = 0;  // tap stream position of Purpose::tap
  std::vector<HeightWindow> observable_windows;
  std::optional<FittingReport> fitting;  // record of a fitted pour
  std::vector<Vec3> centres;
  std::optional<MotionState> motion{};  // where the plan asks for it, from tap 0 on
  std::vector<double> diameters{};      // [n_spheres], where realizations draw their own
};

enum class RealizationStatus : std::uint32_t { missing = 0, running = 1, done = 2, failed = 3 };

/// Cost of a realization, not physics, so it depends on where a run was resumed.
struct Work {
  double seconds = 0;        // seconds of processor time
  double start_seconds = 0;  // seconds until tap 0 was recorded
  Effort effort{};

  Work& operator+=(const Work& rhs) {
    seconds += rhs.seconds;
    start_seconds += rhs.start_seconds;
    effort += rhs.effort;
    return *this;
  }
};

/// How a realization ended.
struct Outcome {
  RealizationStatus status = RealizationStatus::done;
  std::string reason;  // reason of a failure
  Work work{};         // in this process
};

/// Receives the records of realizations. Calls for one realization come one after another, calls
/// for different ones concurrently. A sink that cannot store throws; the run then stops.
class Sink {
 public:
  virtual ~Sink() = default;

  /// Opens a realization. Returns the state of its last checkpoint, or nothing if it begins anew;
  /// rows and snapshots appended after that checkpoint are forgotten.
  virtual std::optional<RealizationState> begin(RealizationId id) = 0;
  virtual void append(RealizationId id, const TapRow& row) = 0;
  virtual void snapshot(RealizationId id, const SnapshotRecord& record) = 0;
  /// Makes everything appended so far, the state, and the work of this process so far durable.
  virtual void checkpoint(RealizationId id, const RealizationState& state, const Work& work) = 0;
  /// Makes everything durable and closes the realization. The outcome's status is done; running,
  /// where the run was stopped; or failed: the state is then empty, and a retry begins anew.
  virtual void end(RealizationId id, const RealizationState& state, const Outcome& outcome) = 0;
};

}  // namespace jostle::inline ensemble
