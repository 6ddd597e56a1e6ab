#pragma once

#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ensemble/sink.hpp"

namespace jostle::inline results {

/// Data of every sphere in snapshots, as one H5MD element each: `name`/{step, value}.
struct SphereVector {
  const char* name;
  std::vector<Vec3> SnapshotRecord::*values;
  const char *units, *long_name;
};
inline constexpr SphereVector sphere_vectors[] = {
    {"position", &SnapshotRecord::centres, "diameter",
     "centres of the spheres along x, y, z (z is up)"},
    {"velocity", &SnapshotRecord::velocities, "diameter / s",
     "velocities of the centres, at the time of the positions"},
    {"spin", &SnapshotRecord::spins, "rad / s",
     "angular velocities, at the time of the positions"}};
inline constexpr std::size_t n_sphere_vectors = std::size(sphere_vectors), kept_positions = 0;

/// Data by height, one dataset of /snapshots/P each. `padding` fills heights above a bed.
struct HeightProfile {
  const char* name;
  std::vector<double> SnapshotRecord::*values;
  double padding;
  const char *units, *long_name, *source;
};
inline constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
inline constexpr HeightProfile height_profiles[] = {
    {"height_histogram", &SnapshotRecord::height_histogram, 0, "1",
     "n(z), fraction of all centres in the bin", "Rosato et al. 2010, fig. 6"},
    {"granular_temperature_lateral", &SnapshotRecord::temperature_lateral, no_number,
     "(diameter / s)^2",
     "variance of horizontal velocities about their mean in the bin, a direction", "jostle"},
    {"granular_temperature_vertical", &SnapshotRecord::temperature_vertical, no_number,
     "(diameter / s)^2", "variance of vertical velocities about their mean in the bin", "jostle"},
    {"driven_height_histogram", &SnapshotRecord::driven_fraction, 0, "1",
     "fraction of all centres in the bin, while the floor moves, above it", "jostle"},
    {"driven_temperature_lateral", &SnapshotRecord::driven_lateral, no_number, "(diameter / s)^2",
     "variance of horizontal velocities about their mean in the bin, a direction, while the floor "
     "moves, by height above it",
     "jostle"},
    {"driven_temperature_vertical", &SnapshotRecord::driven_vertical, no_number, "(diameter / s)^2",
     "variance of vertical velocities about their mean in the bin, while the floor moves, by "
     "height "
     "above it",
     "jostle"}};
inline constexpr std::size_t n_height_profiles = std::size(height_profiles), kept_histogram = 0;

/// Stored data of one realization except its series and snapshots.
struct RealizationHead {
  RealizationStatus status = RealizationStatus::missing;
  std::string reason;                     // reason of a failure
  Work work{};                            // over all processes that reported
  std::optional<RealizationState> state;  // state for a resume; none for missing and failed ones
};

/// All that is stored of one realization.
struct RealizationRecord : RealizationHead {
  std::vector<double> rows;               // [n_rows, StudyPoint::n_columns], NaN where undefined
  std::vector<SnapshotRecord> snapshots;  // ascending taps
};

/// True if squares of the coordinates are numbers: a bed that is tapped before it has fallen back
/// grows without end.
inline bool is_position(const Vec3& centre) {
  constexpr double bound = 1e100;
  return std::abs(centre.x) <= bound && std::abs(centre.y) <= bound && std::abs(centre.z) <= bound;
}

}  // namespace jostle::inline results
