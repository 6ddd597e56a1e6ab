#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/sweep.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline study {

/// The scene that a results file keeps and those of its sweep points, read once.
class PointScenes {
 public:
  /// Throws BadInput for a scene that this version does not read.
  explicit PointScenes(const ResultsFile& file);

  /// With its sweep.
  const Scene& scene() const { return *read_.scene; }
  /// Without a sweep.
  const Scene& point_scene(std::uint32_t point) const { return read_.points.at(point); }
  /// The value that a JSON pointer leads to in the scene of a point; nothing where it leads
  /// nowhere.
  std::optional<Json> value_at(std::uint32_t point, const std::string& pointer) const;
  /// True if two pointers are swept together, zipped: where one is known, so is the other.
  bool vary_together(const std::string& a, const std::string& b) const;

 private:
  ParsedScene read_;
  std::vector<SweepPoint> points_;
};

}  // namespace jostle::inline study
