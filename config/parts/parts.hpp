#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "config/fields/fields.hpp"
#include "config/scene.hpp"

// The parts of a scene whose fields are listed here or that scenes write in forms of their own,
// each in a file. All others are read, written and described by the lists beside them.
namespace jostle::inline config {

bool read_value(const OneOf<Container>& form, const Reader& reader, Container& target);
Json written_value(const OneOf<Container>& form, const Container& container);
Json value_schema(const OneOf<Container>& form, Definitions& definitions);

/// The default observables of a mixture: those that are defined for several sizes.
std::vector<Observable> default_observables(const std::vector<MixtureKind>& kinds);
/// The number of equal spheres, or the kinds of a mixture.
void read_spheres(const Reader& reader, Scene& scene);
Json written_spheres(const Scene& scene);
Json spheres_schema(Definitions& definitions);
bool read_part(const Reader& reader, MixtureKind& kind);
Json written_part(const MixtureKind& kind);
Json part_schema(std::type_identity<MixtureKind> type, Definitions& definitions);

bool read_value(const OneOf<StartChoice>& form, const Reader& reader, StartChoice& target);
Json written_value(const OneOf<StartChoice>& form, const StartChoice& start);
Json value_schema(const OneOf<StartChoice>& form, Definitions& definitions);
bool read_part(const Reader& reader, Crystal& crystal);
Json part_schema(std::type_identity<Crystal> type, Definitions& definitions);
bool read_part(const Reader& reader, PackingFile& file);
Json written_part(const PackingFile& file);
Json part_schema(std::type_identity<PackingFile> type, Definitions& definitions);
/// The start as the engine has it; the packing of a file is read later.
Start engine_start(const StartChoice& choice);
/// The name of the kind of start in scenes: "pour", ...
std::string key_of(const StartChoice& start);

bool read_part(const Reader& reader, ProtocolLine& line);
Json written_part(const ProtocolLine& line);
Json part_schema(std::type_identity<ProtocolLine> type, Definitions& definitions);

bool read_value(const OneOf<StopRule>& form, const Reader& reader, StopRule& target);
Json value_schema(const OneOf<StopRule>& form, Definitions& definitions);
bool read_part(const Reader& reader, Relaxation& relaxation);
Json written_part(const Relaxation& relaxation);
Json part_schema(std::type_identity<Relaxation> type, Definitions& definitions);

bool read_part(const Reader& reader, DiscreteElement& grains);
Json written_part(const DiscreteElement& grains);
Json part_schema(std::type_identity<DiscreteElement> type, Definitions& definitions);
/// The grains' settings; nothing for Monte Carlo, whose own are "relax" and "relax_start".
std::optional<DiscreteElement> read_engine(const Reader& reader);
Json written_engine(const DiscreteElement& grains);
Json engine_schema(Definitions& definitions);

/// A window that is tapered below the floor, or can be.
std::optional<std::string> part_fault(const BulkFraction& bulk);

bool read_value(const TapNumbers& form, const Reader& reader, TapChoice& target);
bool read_value(const TapNumbers& form, const Reader& reader, std::vector<std::uint64_t>& target);
Json written_value(const TapNumbers& form, const TapChoice& choice);
Json written_value(const TapNumbers& form, const std::vector<std::uint64_t>& taps);
Json value_schema(const TapNumbers& form, Definitions& definitions);

bool read_part(const Reader& reader, SnapshotChoice& snapshots);
Json written_part(const SnapshotChoice& snapshots);
Json part_schema(std::type_identity<SnapshotChoice> type, Definitions& definitions);
/// By default everything that the engine has is kept.
SnapshotChoice default_snapshots(bool grains);
/// Faults of kept parts that only discrete elements have, and of those that require positions.
std::optional<std::string> keep_fault(const SnapshotChoice& snapshots, bool grains);

/// The form of a sweep.
struct SweptPointers {};
bool read_value(const SweptPointers& form, const Reader& reader, std::vector<SweepAxis>& sweep);
Json written_value(const SweptPointers& form, const std::vector<SweepAxis>& sweep);
Json value_schema(const SweptPointers& form, Definitions& definitions);

bool read_part(const Reader& reader, FitRequest& fit);
Json written_part(const FitRequest& fit);
Json part_schema(std::type_identity<FitRequest> type, Definitions& definitions);

bool read_part(const Reader& reader, Region& region);
Json written_part(const Region& region);
Json part_schema(std::type_identity<Region> type, Definitions& definitions);
/// Bond lengths of which there are none.
std::optional<std::string> part_fault(const HolesSettings& holes);
bool read_part(const Reader& reader, StructureSettings& settings);
Json written_part(const StructureSettings& settings);
Json part_schema(std::type_identity<StructureSettings> type, Definitions& definitions);

/// The scene of a JSON object, with defaults in the place of what is faulty or missing. Sweeps are
/// read, not expanded.
Scene read_scene(const Reader& reader);

/// Notes what is at odds in values that are right one by one.
void check_consistency(const Scene& scene, std::vector<Fault>& faults);
/// Notes faults of its analyses.
void check_analyses(const Scene& scene, std::vector<Fault>& faults);
/// Checks the kinds of a mixture, as a part of check_consistency().
void check_kinds(const Scene& scene, std::vector<Fault>& faults);
/// Checks widths, steps and parts that take equal spheres alone, for spheres of these kinds whose
/// diameters are in the range.
void check_mixture(const Scene& scene, const DiameterRange& range,
                   const std::vector<std::string>& kinds, std::vector<Fault>& faults);
/// The sizes of a packing from a file (null: equal spheres) as a scene takes them: with the kinds
/// that it lists, which must match. Throws StartError where they do not, or where something in the
/// scene does not take spheres of several sizes.
std::shared_ptr<const Sizes> sizes_for(const std::shared_ptr<const Sizes>& of_file,
                                       const Scene& scene, const std::string& path);
/// Notes faults of the followed motion.
void check_motion(const Scene& scene, std::vector<Fault>& faults);
/// Notes faults of the measured structure.
void check_structure(const Scene& scene, std::vector<Fault>& faults);
/// Notes faults of the number of realizations.
void check_until(const Scene& scene, std::vector<Fault>& faults);
/// Notes analyses over the points of a sweep that does not have what they need.
void check_sweep_analyses(const Scene& scene, std::vector<Fault>& faults);

}  // namespace jostle::inline config
