#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/bed/container.hpp"
#include "engine/bed/sizes.hpp"
#include "ensemble/plan.hpp"
#include "ensemble/sink.hpp"
#include "structure/observables.hpp"

namespace jostle::inline results {

/// Spheres of mixtures of all sweep points together, at most; points with the same spheres count
/// once.
inline constexpr std::uint64_t most_mixed_spheres_in_all = 50'000'000;

/// The spheres of a mixture at one sweep point.
struct PointSpheres {
  std::vector<SphereKind> kinds;       // in the order of the scene's list
  std::vector<std::uint32_t> kind_of;  // [n_spheres]
  std::vector<double> diameters;       // [n_spheres]; empty where realizations draw their own
  bool operator==(const PointSpheres&) const = default;

  bool drawn() const { return diameters.empty(); }
  /// [n_kinds].
  std::vector<std::string> names_of_kinds() const;
  /// With the diameters of a realization where they are drawn.
  std::shared_ptr<const Sizes> sizes(const std::vector<double>& of_realization) const;
};

/// Description of one sweep point with which a results file stores and reads its numbers.
struct StudyPoint {
  std::string label;                                              // for people; may be empty
  std::vector<std::pair<std::string, std::string>> sweep_values;  // JSON pointer, JSON value
  std::uint64_t id = 0;                                           // Plan::point_id
  std::uint64_t seed = 0;
  Container container;
  std::uint32_t n_spheres = 0;
  std::shared_ptr<const PointSpheres> mixture{};  // null: equal spheres; shared by equal points
  std::uint64_t taps = 0;           // the series have taps + 1 rows: tap 0 is the start
  std::vector<Column> observables;  // in the scene's order
  std::vector<Column> diagnostics;  // the engine's
  std::string unit = "trials";      // name of a unit of its work
  Snapshots snapshots;
  std::optional<MotionSettings> motion{};
  std::string start_sum{};  // SHA-256 of the spheres of a start from a file; else empty

  /// All columns of the series: the observables, then the diagnostics.
  std::vector<Column> columns() const;
  std::size_t n_columns() const { return observables.size() + diagnostics.size(); }
};

/// A whole study: every sweep point times `realizations`.
struct Study {
  std::string scene;           // the scene file, word for word
  std::string resolved_scene;  // the scene with all defaults, which a resume compares
  std::uint32_t realizations = 0;
  std::vector<StudyPoint> points;
};

/// The unit of the work of all sweep points; empty where their engines differ, whose units
/// do not add up.
std::string common_unit(const Study& study);

/// The study of the given plans, one point a plan.
Study make_study(std::span<const Plan> plans, std::string scene, std::string resolved_scene,
                 std::uint32_t realizations);

/// The numbers of a study's sweep points by their ids. A point keeps its id when values are added
/// to a sweep, not its number.
class PointNumbers {
 public:
  explicit PointNumbers(const Study& study);
  /// Nothing where no point has this id.
  std::optional<std::uint32_t> find(std::uint64_t id) const;

 private:
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
};

/// The first sweep point of `a` that starts in both studies from files, but from different
/// packings.
std::optional<std::uint32_t> other_start(const Study& a, const Study& b);

/// The share number `index` of `count`, index in 1 .. count. A realization belongs to share
/// (realization * n_points + point) % count + 1: more realizations leave the old ones where they
/// were.
struct Shard {
  std::uint32_t index = 1, count = 1;
  bool operator==(const Shard&) const = default;
};
bool in_share(const Shard& shard, const Study& study, RealizationId id);

/// Every realization of a share, in the order of (realization, point).
std::vector<RealizationId> realizations_of(const Study& study, const Shard& shard);

/// Bytes on disk that a run needs at its largest, parts and folded file together, uncompressed.
std::uint64_t disk_estimate(const Study& study, const Shard& shard);

/// Who computed: one of these a process that worked on the file. Never part of the digest.
struct Provenance {
  std::string version, git_revision;  // git revision of jostle
  std::string libraries;              // "HDF5 1.10.8, ..."
  std::string host, cpu, instruction_set;
  std::string threads;
  std::string command_line;
  std::string started;  // UTC, ISO 8601
};

/// Host, processor model, time and HDF5's and OpenSSL's versions filled in; the rest is the
/// caller's.
Provenance provenance_of_this_machine();

}  // namespace jostle::inline results
