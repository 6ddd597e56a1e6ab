#include "study/report/page_tables.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "results/tables.hpp"
#include "study/report/page_json.hpp"
#include "study/report/thinning.hpp"

namespace jostle::inline study {
namespace {

/// A table, and the group that it is kept in.
struct KeptTable {
  const char* group;
  Table table;
};

/// "point_0003" of its name; empty where it is of all points.
std::string point_of(const Table& table) {
  return table.name.starts_with("point_") ? table.name.substr(0, table.name.find('/')) : "";
}

// From the finest on.
constexpr TableThinning table_thinnings[] = {
    {24, 400, 24}, {8, 400, 24}, {6, 200, 12}, {3, 100, 8}};

}  // namespace

Json page_tables(const ResultsFile& file, std::size_t room, std::vector<std::string>& left_out) {
  std::vector<KeptTable> kept;
  for (const char* const group : derived_groups) {
    for (Table& table : file.tables(group)) kept.push_back({group, std::move(table)});
  }
  std::size_t before = 0, needed = 0;
  for (const KeptTable& one : kept) before += n_values(one.table);
  std::vector<KeptTable> fitting;
  for (const TableThinning& thinning : table_thinnings) {
    fitting.clear();
    needed = 0;
    for (const KeptTable& one : kept) {
      fitting.push_back({one.group, thinned(one.table, thinning)});
      needed += n_values(fitting.back().table);
    }
    if (needed <= room) break;
  }
  if (needed < before) left_out.push_back("tables are drawn at some of their taps and places");
  std::vector<std::string> points;
  for (const KeptTable& one : fitting) {
    const std::string point = point_of(one.table);
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
  Json tables = Json::array();
  std::size_t taken = 0;
  bool too_large = false;
  for (const KeptTable& one : fitting) {
    const std::string point = point_of(one.table);
    if (!point.empty() && !std::ranges::binary_search(points, point)) continue;
    taken += n_values(one.table);
    if (taken > 2 * room) {
      too_large = true;
      break;
    }
    tables.push_back(page_table(one.table, one.group));
  }
  if (too_large) left_out.push_back("some tables are longer than a page has room for");
  return tables;
}

}  // namespace jostle::inline study
