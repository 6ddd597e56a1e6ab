#include "study/tables/motion.hpp"

#include <algorithm>

#include "ensemble/analysis/motion/motion_tables.hpp"
#include "results/groups/layout.hpp"
#include "study/bad_input.hpp"

namespace jostle::inline study {

namespace {

Table without_motion(const std::string& prefix) {
  return {.name = prefix + "displacement", .notes = {{"refused", "no realization has taps"}}};
}

}  // namespace

std::vector<Table> motion_of(const ResultsFile& file, std::span<const std::uint32_t> points) {
  if (!follows_motion(file)) {
    throw BadInput(
        file.path() +
        ": its scene does not follow the motion of spheres, and what was not followed cannot be "
        "found afterwards; give a new run's scene the key \"motion\" (docs/reference/analyses.md)");
  }
  std::vector<Table> tables;
  for (const std::uint32_t point : points) {
    const std::string name = point_name(point) + "/motion/";
    const auto records = file.motion(point);
    std::vector<std::string> kinds;
    if (const auto& mixture = file.study().points[point].mixture) kinds = mixture->names_of_kinds();
    std::vector<Table> of_point =
        records ? motion_tables(name, *records, kinds) : std::vector{without_motion(name)};
    const std::string& label = file.study().points[point].label;
    for (Table& table : of_point) {
      if (!label.empty()) table.notes.insert(table.notes.begin(), {"sweep_point", label});
      tables.push_back(std::move(table));
    }
  }
  return tables;
}

bool follows_motion(const ResultsFile& file) {
  return std::ranges::any_of(file.study().points,
                             [](const StudyPoint& point) { return point.motion.has_value(); });
}

}  // namespace jostle::inline study
