#include <fmt/format.h>

#include <algorithm>

#include "results/file/tables.hpp"
#include "study/drawing/drawn/drawn_results.hpp"
#include "study/drawing/drawn/thinning.hpp"

namespace jostle::inline study {
namespace {

/// "point_0003" of its name; empty for a table of all points.
std::string point_of(const Table& table) {
  return table.name.starts_with("point_") ? table.name.substr(0, table.name.find('/')) : "";
}

bool is_wanted(const std::string& point, const WantedPoints& wanted) {
  return point.empty() || wanted.empty() ||
         std::ranges::any_of(wanted, [&](std::uint32_t wanted_point) {
           return point == fmt::format("point_{:04}", wanted_point);
         });
}

// From the finest on.
constexpr TableThinning table_thinnings[] = {
    {24, 400, 24}, {8, 400, 24}, {6, 200, 12}, {3, 100, 8}};

}  // namespace

std::vector<DrawnTable> drawn_tables(const ResultsFile& file, const DrawnRoom& all_room,
                                     const WantedPoints& wanted,
                                     std::vector<std::string>& left_out) {
  const std::size_t room = all_room.table_values;
  std::vector<DrawnTable> kept;
  for (const char* const group : derived_groups) {
    for (Table& table : file.tables(group)) {
      if (is_wanted(point_of(table), wanted)) kept.push_back({group, std::move(table)});
    }
  }
  std::size_t n_before = 0, needed = 0;
  for (const DrawnTable& table : kept) n_before += n_values(table.table);
  std::vector<DrawnTable> fitting;
  for (const TableThinning& thinning : table_thinnings) {
    fitting.clear();
    needed = 0;
    for (const DrawnTable& table : kept) {
      fitting.push_back({table.group, thinned(table.table, thinning)});
      needed += n_values(fitting.back().table);
    }
    if (needed <= room) break;
  }
  if (needed < n_before) left_out.push_back("tables are drawn at some of their taps and places");
  std::vector<std::string> points;
  for (const DrawnTable& table : fitting) {
    const std::string point = point_of(table.table);
    if (!point.empty() && std::ranges::find(points, point) == points.end()) points.push_back(point);
  }
  std::ranges::sort(points);
  if (needed > room && !points.empty()) {
    const double share = static_cast<double>(room) / static_cast<double>(needed);
    const auto most =
        std::max<std::size_t>(1, static_cast<std::size_t>(share * double(points.size())));
    left_out.push_back(fmt::format("tables are drawn of {} of {} sweep points, evenly spread", most,
                                   points.size()));
    std::vector<std::string> chosen;
    for (const std::size_t i : evenly_spread(points.size(), most)) chosen.push_back(points[i]);
    points = std::move(chosen);
  }
  std::vector<DrawnTable> tables;
  std::size_t taken = 0;
  bool too_large = false;
  for (DrawnTable& table : fitting) {
    const std::string point = point_of(table.table);
    if (!point.empty() && !std::ranges::binary_search(points, point)) continue;
    taken += n_values(table.table);
    if (taken > 2 * room) {
      too_large = true;
      break;
    }
    tables.push_back(std::move(table));
  }
  if (too_large) left_out.push_back("some tables are longer than a page has room for");
  return tables;
}

}  // namespace jostle::inline study
