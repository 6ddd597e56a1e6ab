#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/sweep.hpp"
#include "results/results_file.hpp"

namespace jostle {

/// The scenes of a results file's sweep points, from the scene that the file keeps.
class PointScenes {
 public:
  /// Throws BadInput for a scene that this version does not read.
  explicit PointScenes(const ResultsFile& file);

  /// Without a sweep.
  Scene at(std::uint32_t point) const;
  /// Whether two pointers are swept together, zipped: where one is known, so is the other.
  bool vary_together(const std::string& a, const std::string& b) const;

 private:
  Json resolved_;
  std::vector<SweepAxis> axes_;
  std::vector<SweepPoint> points_;
};

}  // namespace jostle
