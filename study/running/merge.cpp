#include "study/running/merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>
#include <vector>

#include "config/sweep.hpp"
#include "results/disk/error.hpp"
#include "results/file/results_file.hpp"
#include "study/running/stored_scene.hpp"

namespace jostle::inline study {
namespace {

/// One file open at a time: there may be thousands. Whoever reads them verifies them.
bool have_one_scene(std::span<const std::string> inputs) {
  const ResultsFile first(inputs.front(), Verify::end_of_file);
  return std::ranges::all_of(inputs, [&](const std::string& input) {
    return ResultsFile(input, Verify::end_of_file, first).study().resolved_scene ==
           first.study().resolved_scene;
  });
}

}  // namespace

std::optional<Study> joined_study(std::span<const std::string> inputs) {
  if (inputs.empty() || have_one_scene(inputs)) return std::nullopt;
  std::vector<ResultsFile> files;
  for (const std::string& input : inputs) files.emplace_back(input);
  ParsedScene joined = checked_scene(stored_scene(files.front()));
  for (const ResultsFile& file : std::span(files).subspan(1)) {
    joined = join_sweeps(joined, checked_scene(stored_scene(file)));
    if (!joined.scene) {
      throw ResultsError(file.path(),
                         fmt::format("cannot be merged with {}: {}", files.front().path(),
                                     fault_lines(joined.faults)));
    }
  }
  const std::string scene = resolved(*joined.scene).dump(2);
  Study study{scene, scene, files.front().study().realizations, {}};
  std::unordered_map<std::uint64_t, const StudyPoint*> held;
  for (const ResultsFile& file : files) {
    for (const StudyPoint& point : file.study().points) held[point.id] = &point;
  }
  for (const SweepPoint& point : sweep_points(joined.scene->sweep)) {
    const auto holder = held.find(point_id(point));
    if (holder == held.end()) {
      throw ResultsError(files.front().path(),
                         fmt::format("cannot be merged: together the sweeps have the point {}, "
                                     "which no file holds; run it, as a resume of one of them",
                                     point_label(point)));
    }
    study.points.push_back(*holder->second);
  }
  return study;
}

}  // namespace jostle::inline study
