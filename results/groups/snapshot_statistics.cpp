#include "results/groups/snapshot_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/bed/boundary.hpp"
#include "engine/numbers.hpp"
#include "results/content/stored_realization.hpp"
#include "results/groups/axes.hpp"
#include "results/hdf5/read.hpp"
#include "results/hdf5/write.hpp"

namespace jostle::inline results {
namespace {

class StatisticsWriter {
 public:
  StatisticsWriter(hid_t group, const StudyPoint& point, std::uint32_t n_realizations)
      : group_(group),
        point_(point),
        n_taps_(point.snapshots.taps.size()),
        n_realizations_(n_realizations),
        taps_(write_numbers(group, "tap", point.snapshots.taps)) {
    write_label(taps_, {"tap", "1", "number of taps; 0 is the start", ""});
    make_axis(taps_, "tap");
    realizations_ = write_realization_axis(group, n_realizations);
  }

  void write_coordination(const std::vector<double>& coordination) {
    const Shape shape{n_taps_, n_realizations_};
    const Hdf5Handle dataset = write_numbers<double>(group_, "coordination", shape, coordination,
                                                     chunk_along_first(shape));
    write_label(dataset, {"coordination", "1",
                          point_.mixture ? "mean number of centres within contact_cut times the "
                                           "sum of the two radii"
                                         : "mean number of centres within contact_cut",
                          "Rosato et al. 2010"});
    write_attribute(dataset, "contact_cut", point_.snapshots.contact_cut);
    const Hdf5Handle* const axes[] = {&taps_, &realizations_};
    attach_axes(dataset, axes);
  }

  void write_profiles(const SnapshotStatistics& statistics) {
    std::array<std::size_t, n_height_profiles> longest{};
    for (std::size_t k = 0; k < n_height_profiles; ++k)
      for (std::size_t tap = 0; tap < n_taps_; ++tap)
        for (std::uint32_t r = 0; r < n_realizations_; ++r)
          longest[k] = std::max(longest[k], statistics.profile(k, tap, r).size());
    const std::size_t n_bins = std::ranges::max(longest);
    if (n_bins == 0) return;
    std::vector<double> heights;
    for (std::size_t k = 0; k < n_bins; ++k)
      heights.push_back((static_cast<double>(k) + 0.5) * point_.snapshots.bin_width);
    const Hdf5Handle axis = write_numbers(group_, "height", heights);
    write_label(axis,
                {"height", "diameter", "height of the middle of the bin above the floor", ""});
    make_axis(axis, "height");
    for (std::size_t k = 0; k < n_height_profiles; ++k)
      if (longest[k] > 0) write_profile(k, statistics, axis, n_bins);
  }

  void write_forces(const std::vector<std::optional<BedForces>>& forces) {
    const std::vector<std::string> names = wall_names(point_.container);
    const hsize_t n_walls = names.size();
    const Hdf5Handle walls = write_texts(group_, "wall", {n_walls}, names);
    make_axis(walls, "wall");
    const Hdf5Handle directions = write_bare_axis(group_, "direction", 3),
                     arms = write_bare_axis(group_, "arm", 3),
                     force = write_bare_axis(group_, "force", 3);
    std::vector<double> normal, friction, moment;
    for (const auto& bed_forces : forces) {
      for (std::size_t k = 0; k < 9; ++k)
        moment.push_back(bed_forces ? bed_forces->moment[k] : not_a_number);
      for (std::size_t w = 0; w < n_walls; ++w) {
        const WallForce wall =
            bed_forces ? bed_forces->walls.at(w)
                       : WallForce{not_a_number, {not_a_number, not_a_number, not_a_number}};
        normal.push_back(wall.normal);
        for (const double x : {wall.friction.x, wall.friction.y, wall.friction.z})
          friction.push_back(x);
      }
    }
    write_along({"wall_normal_force", "m g", "sum of the normal forces of the wall", "jostle"},
                normal, {n_walls}, {&walls});
    write_along({"wall_friction_force", "m g",
                 "sum of the tangential forces of the wall on the bed", "jostle"},
                friction, {n_walls, 3}, {&walls, &directions});
    write_along(
        {"force_moment", "m g d",
         "sum over contacts of arm (x) force, positive under pressure; per volume the stress",
         "jostle"},
        moment, {3, 3}, {&arms, &force});
  }

 private:
  void write_profile(std::size_t index, const SnapshotStatistics& statistics,
                     const Hdf5Handle& heights, std::size_t n_bins) {
    const HeightProfile& profile = height_profiles[index];
    const Shape all{n_taps_, n_realizations_, n_bins}, chunk = chunk_along_first(all);
    RowsDataset<double> dataset(group_, profile.name, all, chunk);
    std::vector<double> values;
    for (std::size_t first = 0; first < n_taps_; first += chunk[0]) {
      values.clear();
      for (std::size_t tap = first; tap < std::min<std::size_t>(first + chunk[0], n_taps_); ++tap) {
        for (std::uint32_t r = 0; r < n_realizations_; ++r) {
          const std::vector<double> bins = statistics.profile(index, tap, r);
          const double absent = bins.empty() ? not_a_number : profile.padding;
          values.insert(values.end(), bins.begin(), bins.end());
          values.insert(values.end(), n_bins - bins.size(), absent);
        }
      }
      dataset.write(first, values);
    }
    write_label(dataset.dataset(),
                {profile.name, profile.units, profile.long_name, profile.source});
    const Hdf5Handle* const axes[] = {&taps_, &realizations_, &heights};
    attach_axes(dataset.dataset(), axes);
  }

  /// Along taps, realizations and what follows them.
  void write_along(const Column& label, const std::vector<double>& values,
                   const Shape& other_extents, std::vector<const Hdf5Handle*> axes) {
    Shape shape{n_taps_, n_realizations_};
    shape.insert(shape.end(), other_extents.begin(), other_extents.end());
    const Hdf5Handle dataset =
        write_numbers<double>(group_, label.name, shape, values, chunk_along_first(shape));
    write_label(dataset, label);
    axes.insert(axes.begin(), {&taps_, &realizations_});
    attach_axes(dataset, axes);
  }

  hid_t group_;
  const StudyPoint& point_;
  hsize_t n_taps_, n_realizations_;
  Hdf5Handle taps_, realizations_;
};

}  // namespace

void write_snapshot_statistics(hid_t group, const StudyPoint& point, std::uint32_t n_realizations,
                               const SnapshotStatistics& statistics) {
  StatisticsWriter writer(group, point, n_realizations);
  if (point.snapshots.coordination) writer.write_coordination(statistics.coordination);
  writer.write_profiles(statistics);
  if (point.snapshots.forces) writer.write_forces(statistics.forces);
}

std::vector<std::optional<BedForces>> read_bed_forces(hid_t group, const StudyPoint& point,
                                                      std::uint32_t n_realizations) {
  if (!exists(group, "force_moment")) return {};
  const hsize_t n_taps = point.snapshots.taps.size();
  const std::size_t n_walls = wall_names(point.container).size();
  const Shape of_moment{n_taps, n_realizations, 3, 3}, of_normal{n_taps, n_realizations, n_walls},
      of_friction{n_taps, n_realizations, n_walls, 3};
  const auto moment = read_numbers<double>(group, "force_moment", &of_moment),
             normal = read_numbers<double>(group, "wall_normal_force", &of_normal),
             friction = read_numbers<double>(group, "wall_friction_force", &of_friction);
  std::vector<std::optional<BedForces>> forces(n_taps * n_realizations);
  for (std::size_t cell = 0; cell < forces.size(); ++cell) {
    if (std::isnan(moment[9 * cell])) continue;
    BedForces& bed_forces = forces[cell].emplace();
    std::copy_n(moment.begin() + static_cast<std::ptrdiff_t>(9 * cell), 9,
                bed_forces.moment.begin());
    for (std::size_t w = cell * n_walls; w < (cell + 1) * n_walls; ++w)
      bed_forces.walls.push_back(
          {normal[w], {friction[3 * w], friction[3 * w + 1], friction[3 * w + 2]}});
  }
  return forces;
}

}  // namespace jostle::inline results
