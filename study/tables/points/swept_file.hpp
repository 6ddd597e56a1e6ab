#pragma once

#include <vector>

#include "ensemble/analysis/table.hpp"
#include "results/file/results_file.hpp"
#include "study/tables/points/derived_value.hpp"
#include "study/tables/points/point_scenes.hpp"

namespace jostle::inline study {

/// A file with what is read of it once for all sweeps.
class SweptFile {
 public:
  SweptFile(const ResultsFile& file, const MadeTables& made)
      : file_(file), scenes_(file), made_(made) {}

  const ResultsFile& file() const { return file_; }
  const PointScenes& scenes() const { return scenes_; }
  /// Those just made, then those that the file keeps.
  const MadeTables& tables() {
    if (!kept_are_read_) {
      kept_are_read_ = true;
      append(made_.analyses, file_.tables("analysis"));
      append(made_.fits, file_.tables("fits"));
    }
    return made_;
  }

 private:
  static void append(std::vector<Table>& tables, const std::vector<Table>& added) {
    tables.insert(tables.end(), added.begin(), added.end());
  }

  const ResultsFile& file_;
  PointScenes scenes_;
  MadeTables made_;
  bool kept_are_read_ = false;
};

}  // namespace jostle::inline study
