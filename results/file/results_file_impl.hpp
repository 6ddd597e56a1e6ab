#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "results/file/recently_used.hpp"
#include "results/file/results_file.hpp"
#include "results/file/study_writer.hpp"
#include "results/groups/axes.hpp"
#include "results/groups/layout.hpp"
#include "results/groups/particles.hpp"
#include "results/hdf5/read.hpp"

namespace jostle::inline results {

/// Stored data of a point except series, positions and restart states.
struct PointTables {
  std::uint32_t point = 0;
  std::vector<std::uint8_t> statuses;
  std::vector<std::uint64_t> rows;
  std::vector<std::string> reasons;
  std::vector<Work> work;
  std::vector<double> coordination;              // [n_snapshot_taps, n_realizations], or empty
  std::vector<std::optional<BedForces>> forces;  // by snapshot, too
  std::array<std::size_t, n_height_profiles> n_bins{};  // 0 where there are none
};

/// An open file, and the blocks of it that were read last.
class ResultsFile::Impl {
 public:
  /// Keeps the study of `sibling` for its own where both have one scene.
  Impl(const std::string& name, const std::string& known_as, Verify verify,
       const Impl* sibling = nullptr);

  /// Opened anew where rest() closed it. Throws ResultsError where another was put in its place.
  const Hdf5Handle& file() const;
  void rest();
  void forget_rows() { row_blocks_.clear(); }

  /// Taps that the columns of a point hold: those beyond which no realization has come are left
  /// out.
  std::uint64_t stored_rows(const Hdf5Handle& observables, std::uint32_t point) {
    const Shape shape = shape_of(open_dataset(observables, "tap"));
    const auto most = std::ranges::max(tables(point).rows);
    if (shape.size() != 1 || shape[0] < most || shape[0] < 1 ||
        shape[0] > study.points.at(point).taps + 1)
      throw Hdf5Error("tap does not have the length of the columns along it");
    return shape[0];
  }

  /// True if the file has the groups of a point: not before one of its realizations has begun.
  bool has_point(std::uint32_t point) const {
    return exists(file(), "observables/" + point_name(point));
  }

  const PointTables& tables(std::uint32_t point) {
    if (!cached_ || cached_->point != point) cached_ = read_tables(point);
    return *cached_;
  }

  RealizationSummary summary(RealizationId id);

  /// [n_columns] of [n, n_realizations]: the block of rows that `row` is in.
  const std::vector<std::vector<double>>& row_block(std::uint32_t point, std::uint64_t row) {
    const std::uint64_t first = row / block_rows(point) * block_rows(point);
    return row_blocks_.get({point, first}, [&] {
      const Hdf5Handle observables = open_group(file(), "observables/" + point_name(point));
      const std::uint64_t rows = stored_rows(observables, point);
      const std::uint64_t n = std::min(block_rows(point), rows - std::min(first, rows));
      std::vector<std::vector<double>> columns;
      for (const Column& label : study.points.at(point).columns()) {
        require_shape(observables, label.name, {rows, study.realizations});
        columns.push_back(read_block(observables, label.name, {first, 0}, {n, study.realizations}));
      }
      return columns;
    });
  }
  std::uint64_t block_rows(std::uint32_t point) const {
    return rows_a_block(study.realizations, n_columns(point));
  }
  std::size_t n_columns(std::uint32_t point) const { return study.points.at(point).n_columns(); }

  /// A snapshot's height_profiles[which], with what pads it.
  std::span<const double> profile(RealizationId id, std::size_t snapshot, std::size_t index) {
    const std::size_t n_bins = tables(id.point).n_bins[index];
    const std::uint64_t n_taps = study.points.at(id.point).snapshots.taps.size();
    if (n_bins == 0) return {};
    const Shape all{n_taps, study.realizations, n_bins};
    const std::uint64_t n_a_block = chunk_along_first(all)[0];
    const std::uint64_t first = snapshot / n_a_block * n_a_block;
    const auto& block = profile_blocks_[index].get({id.point, first}, [&] {
      const Hdf5Handle group = open_group(file(), "snapshots/" + point_name(id.point));
      return read_block(group, height_profiles[index].name, {first, 0, 0},
                        {std::min(n_a_block, n_taps - first), study.realizations, n_bins});
    });
    const std::size_t cell = (snapshot - first) * study.realizations + id.realization;
    return std::span(block).subspan(cell * n_bins, n_bins);
  }

  const ParticleFrames& frames(RealizationId id) {
    return frames_.get(id, [&] {
      const StudyPoint& point = study.points.at(id.point);
      return ParticleFrames(file(), particles_name(id), point.n_spheres, point.container);
    });
  }

  std::string path;

 private:
  /// Device, number, size and time of change.
  using Version = std::array<std::uint64_t, 5>;
  static Version version_of(const std::string& name);
  PointTables read_tables(std::uint32_t point) const;

  std::string name_;
  mutable Hdf5Handle file_;
  Version version_;
  std::shared_ptr<const Study> shared_study_;

 public:
  const Study& study;
  FileProvenance provenance;

 private:
  std::optional<PointTables> cached_;
  using Block =
      std::pair<std::uint32_t, std::uint64_t>;  // block of a point, from a row or a snapshot on
  // Two, as what is written from them comes in other blocks where it has more realizations.
  RecentlyUsed<Block, std::vector<std::vector<double>>, 2> row_blocks_;
  std::array<RecentlyUsed<Block, std::vector<double>, 2>, n_height_profiles> profile_blocks_;
  RecentlyUsed<RealizationId, ParticleFrames, 1> frames_;
};

}  // namespace jostle::inline results
