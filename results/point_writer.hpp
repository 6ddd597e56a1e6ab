#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "results/hdf5_write.hpp"
#include "results/record.hpp"
#include "results/study.hpp"

namespace jostle {

/// Makes the groups that hold a group a point: /observables, /ensemble, /snapshots, ...
void create_point_folders(hid_t file);

/// The labels of all columns of a point's series: its observables, then the relaxation columns.
std::vector<ObservableLabel> column_labels(const StudyPoint& point);

/// Writes all that is stored of one sweep point. Holds its series, not its positions, in memory.
class PointWriter {
 public:
  PointWriter(hid_t file, const Study& study, std::uint32_t point);

  /// Takes the next realization; to be called for 0, 1, ... in order. Returns the status it is
  /// stored under: a realization that is done but has fewer taps than the study is running.
  RealizationStatus add(std::uint32_t realization, const RealizationRecord& record);
  /// Writes what is known only once all realizations are.
  void finish();

 private:
  void make_room(std::uint64_t n_rows);
  void take_series(std::uint32_t realization, const RealizationRecord& record);
  void take_snapshots(std::uint32_t realization, const RealizationRecord& record);
  void write_restart(std::uint32_t realization, const RealizationRecord& record);
  void write_observables();
  void write_ensemble();
  void write_snapshots();
  void write_fittings();
  void write_timing();
  Hdf5Handle group_under(const char* folder) const;

  hid_t file_;
  const StudyPoint& point_;
  std::uint32_t number_;
  std::uint32_t n_realizations_;
  std::uint64_t n_rows_ = 0;  // the most that any realization has, whatever is planned
  std::vector<ObservableLabel> labels_;
  std::vector<std::vector<double>> columns_;  // [n_columns] of [n_rows, n_realizations]
  std::vector<std::uint8_t> statuses_;
  std::vector<std::uint64_t> rows_;
  std::vector<std::string> reasons_;
  std::vector<Work> work_;
  std::vector<std::optional<FittingReport>> fittings_;  // [n_realizations]
  std::vector<double> coordination_;                    // [n_snapshot_taps, n_realizations]
  std::vector<std::vector<double>> histograms_;         // likewise
};

}  // namespace jostle
