#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ensemble/motion/motion_records.hpp"
#include "results/content/stored_realization.hpp"
#include "results/content/study.hpp"
#include "results/groups/mixtures.hpp"
#include "results/groups/snapshot_statistics.hpp"
#include "results/hdf5/write.hpp"

namespace jostle::inline results {

/// Makes the groups that hold a group a point: /observables, /ensemble, /snapshots, ...
void create_point_folders(hid_t file);

/// Writes all that is stored of one sweep point, piece by piece: neither its series nor its
/// positions are held in memory. A point none of whose realizations has begun leaves nothing: a
/// stop costs what was made, not what is planned.
class PointWriter {
 public:
  PointWriter(hid_t file, const Study& study, std::uint32_t point);

  /// Takes the next realization, 0, 1, ... in order, and its snapshots. Returns the status it is
  /// stored under: a realization that is done but has fewer taps than the study is running.
  RealizationStatus add(std::unique_ptr<StoredRealization> realization);
  /// Writes what is known only once all realizations are.
  void finish();

 private:
  void begin();
  std::vector<double> diameters_of(const RealizationState& state) const;
  void take_snapshots(StoredRealization& realization, const std::vector<double>& diameters);
  void write_restart(const RealizationState& state);
  void write_observables();
  void write_series(hid_t group, const Hdf5Handle& taps, const Hdf5Handle& realizations);
  void write_snapshots();
  void write_fittings();
  void write_motion();
  void write_timing();
  Hdf5Handle group_under(const char* folder) const;

  hid_t file_;
  const StudyPoint& point_;
  std::uint32_t number_;
  std::uint32_t n_realizations_;
  bool begun_ = false;  // true if the point's groups are there
  std::vector<Column> labels_;
  std::vector<std::unique_ptr<StoredRealization>> realizations_;  // added
  std::vector<std::uint8_t> statuses_;
  std::vector<std::uint64_t> rows_;
  std::vector<std::string> reasons_;
  std::vector<Work> work_;
  std::vector<std::optional<FittingReport>> fittings_;  // [n_realizations]
  std::optional<MotionRecords> motion_;                 // where it is followed
  std::optional<DrawnDiameters> diameters_;             // diameters of mixtures that draw them
  SnapshotStatistics statistics_;                       // statistics of snapshots
};

}  // namespace jostle::inline results
