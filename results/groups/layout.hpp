#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/engines.hpp"
#include "ensemble/sink.hpp"
#include "results/content/study.hpp"

// Names inside a results file; docs/reference/file-format.md describes them.
namespace jostle::inline results {

/// Attribute `jostle_format` of the root; raised when a reader of the old layout would go wrong.
inline constexpr std::uint32_t layout_version = 1;
/// The layout of files with a mixture, which a reader of layout 1 would take for equal spheres.
inline constexpr std::uint32_t layout_of_mixtures = 2;

/// Group of the spheres of points with a mixture, and its datasets at every point.
inline constexpr const char *spheres_folder = "spheres", *kind_names = "name",
                            *kind_densities = "density", *sphere_kinds = "kind",
                            *sphere_diameters = "diameter";

inline std::string point_name(std::uint32_t point) {
  return fmt::format("point_{:04}", point);
}
inline std::string realization_name(std::uint32_t realization) {
  return fmt::format("realization_{:05}", realization);
}
inline std::string particles_name(RealizationId id) {
  return point_name(id.point) + "_" + realization_name(id.realization);
}

/// For a sweep point with the contents of an earlier one: the number of the earlier point, which
/// alone has the datasets of /sweep/P. So a point of a long sweep takes some hundred bytes.
inline constexpr const char* keeps_what_point_keeps = "keeps_what_point_keeps";

/// The columns of the engine are named in the file where they are not those of Monte Carlo, which
/// every file without names has.
inline constexpr const char *diagnostics_name = "diagnostics", *diagnostics_prefix = "diagnostics_";
inline constexpr const char* diagnostics_unit = "diagnostics_unit";  // else trials
inline std::vector<Column> unnamed_diagnostics() {
  return columns(MonteCarlo{});
}
inline constexpr std::string_view shown_names[] = {"spread", "mean", "count", "share",
                                                   "stored"};  // words of Shown

/// Attribute `snapshots_keep` of /sweep/P: what is kept of snapshots, in this order; the first
/// three of every engine.
inline constexpr bool Snapshots::*kept_fields[] = {
    &Snapshots::positions,  &Snapshots::coordination,      &Snapshots::height_histogram,
    &Snapshots::velocities, &Snapshots::contacts,          &Snapshots::granular_temperature,
    &Snapshots::forces,     &Snapshots::driven_temperature};
inline constexpr std::size_t n_kept_by_all = 3;

/// Attributes of /sweep/P where the motion is followed, and the group of what was found.
inline constexpr const char *motion_origins = "motion_origins", *motion_lags = "motion_lags",
                            *motion_lengths = "motion_overlap_lengths",
                            *motion_layers = "motion_layers", *motion_kinds = "motion_kinds",
                            *motion_folder = "motion";

/// Records of fitting for points that start from a fitted pour.
inline constexpr const char* fitting_folder = "fitting";

/// The datasets of /provenance, one text a process that worked on the file.
struct ProvenanceField {
  const char* name;
  std::string Provenance::*field;
};
inline constexpr ProvenanceField provenance_fields[] = {
    {"version", &Provenance::version},
    {"git_revision", &Provenance::git_revision},
    {"libraries", &Provenance::libraries},
    {"host", &Provenance::host},
    {"cpu", &Provenance::cpu},
    {"instruction_set", &Provenance::instruction_set},
    {"threads", &Provenance::threads},
    {"command_line", &Provenance::command_line},
    {"started", &Provenance::started}};

}  // namespace jostle::inline results
