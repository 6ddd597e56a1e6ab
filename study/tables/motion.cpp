#include "study/tables/motion.hpp"

#include <algorithm>
#include <cmath>

#include "ensemble/analysis/motion/motion_tables.hpp"
#include "results/groups/layout.hpp"
#include "study/bad_input.hpp"
#include "study/tables/repeated_series.hpp"

namespace jostle::inline study {

namespace {

Table without_motion(const std::string& prefix) {
  return {.name = prefix + "displacement", .notes = {{"refused", "no realization has taps"}}};
}

/// Clears the values of some realizations, as if they had reached no tap.
MotionRecords leave_out(MotionRecords records, const std::vector<std::uint32_t>& realizations) {
  const auto clear = [&](std::vector<double>& values) {
    for (const std::uint32_t r : realizations)
      for (std::size_t i = r; i < values.size(); i += records.n_realizations)
        values[i] = std::nan("");
  };
  for (std::vector<double>& values : records.values) clear(values);
  clear(records.layer_height);
  clear(records.largest_step);
  return records;
}

}  // namespace

std::vector<Table> motion_of(const ResultsFile& file, std::span<const std::uint32_t> points) {
  if (!follows_motion(file)) {
    throw BadInput(
        file.path() +
        ": its scene has no key \"motion\", so displacements were not recorded: add \"motion\" to "
        "the scene and run it again (docs/reference/analyses.md)");
  }
  std::vector<Table> tables;
  for (const std::uint32_t point : points) {
    const std::string name = point_name(point) + "/motion/";
    const auto records = file.motion(point);
    std::vector<std::string> kinds;
    if (const auto& mixture = file.study().points[point].mixture) kinds = mixture->names_of_kinds();
    const Repetitions copies = repetitions(file, point);
    std::vector<Table> of_point =
        records ? motion_tables(name, leave_out(*records, copies.realizations), kinds)
                : std::vector{without_motion(name)};
    const std::string& label = file.study().points[point].label;
    for (Table& table : of_point) {
      if (!copies.text.empty()) table.notes.emplace_back("copies", copies.text);
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
