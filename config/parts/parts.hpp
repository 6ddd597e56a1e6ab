#pragma once

#include <vector>

#include "config/json/reader.hpp"
#include "config/scene.hpp"

// The parts of a scene, in from JSON and out to it. A read_* function always returns a part; where
// it noted a fault, the part is a default that stands in for it.
namespace jostle::inline config {

Container read_container(const Reader& in);
StartChoice read_start(const Reader& in);
std::vector<ProtocolLine> read_protocol(const Reader& in);
Relaxation read_relaxation(const Reader& in);
/// The grains' settings; nothing for Monte Carlo, whose own are "relax" and "relax_start".
std::optional<DiscreteElement> read_engine(const Reader& in);
Window read_window(const Reader& in);
HeightWindow read_heights(const Reader& in);
std::vector<Observable> read_observables(const Reader& in);
TapChoice read_taps(const Reader& in);
/// By default everything that the engine has is kept.
SnapshotChoice default_snapshots(bool grains);
SnapshotChoice read_snapshots(const Reader& in, bool grains);
/// The kept parts that only discrete elements have, and those that stand beside positions, where
/// they cannot be kept: why.
std::optional<std::string> keep_fault(const SnapshotChoice& snapshots, bool grains);
MotionChoice read_motion(const Reader& in);
std::vector<SweepAxis> read_sweep(const Reader& in);
std::vector<FitRequest> read_fits(const Reader& in);
TargetPrecision read_until(const Reader& in);
Analyses read_analyses(const Reader& in);
StructureSettings read_structure(const Reader& in);

Json written(const Container& container);
Json written(const StartChoice& start);
/// The start as the engine has it; the packing of a file is read later.
Start engine_start(const StartChoice& choice);
/// What scenes call the kind of start: "pour", ...
std::string key_of(const StartChoice& start);
Json written(const std::vector<ProtocolLine>& protocol);
Json written(const Relaxation& relaxation);
Json written_engine(const DiscreteElement& engine);
Json written(const Window& window);
Json written(const std::vector<Observable>& observables);
Json written(const SnapshotChoice& snapshots);
Json written_taps(const TapChoice& choice);
Json written(const MotionChoice& motion);
Json written(const std::vector<SweepAxis>& sweep);
Json written(const std::vector<FitRequest>& fits);
Json written(const TargetPrecision& wanted);
Json written(const Analyses& analyses);
Json written(const StructureSettings& settings);
/// [low, high]
Json written_bounds(double low, double high);

/// A number as a person writes it: 16, not 16.0.
Json plain_number(double value);

/// Default of "observe": one of each kind.
std::vector<Observable> default_observables();

/// The scene of a JSON object, with defaults in the place of what is faulty or missing. Sweeps are
/// read, not expanded.
Scene read_scene(const Reader& in);

/// Notes what is at odds in values that are right one by one.
void check_consistency(const Scene& scene, std::vector<Fault>& faults);
/// Of these, what concerns its analyses.
void check_analyses(const Scene& scene, std::vector<Fault>& faults);
/// Of these, what concerns the motion of spheres.
void check_motion(const Scene& scene, std::vector<Fault>& faults);
/// Of these, what concerns the structure of its packings.
void check_structure(const Scene& scene, std::vector<Fault>& faults);
/// Of these, what concerns the number of realizations.
void check_until(const Scene& scene, std::vector<Fault>& faults);
/// Notes analyses over the points of a sweep that does not have what they need.
void check_sweep_analyses(const Scene& scene, std::vector<Fault>& faults);

}  // namespace jostle::inline config
