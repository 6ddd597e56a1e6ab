#include "study/report/page_data.hpp"

#include "results/file/layout.hpp"
#include "study/report/page_json.hpp"
#include "study/report/page_packings.hpp"
#include "study/report/page_run.hpp"

namespace jostle::inline study {
namespace {

Json page_curve(const DrawnCurve& curve) {
  Json columns = Json::array();
  for (const DrawnColumn& column : curve.columns) {
    columns.push_back({{"name", page_text(column.label.name)},
                       {"kind", column.is_observable ? "observable" : "engine"},
                       {"shown", shown_names[static_cast<std::size_t>(column.label.shown)]},
                       {"units", page_text(column.label.units)},
                       {"long_name", page_text(column.label.long_name)},
                       {"source", page_text(column.label.source)},
                       {"mean", page_numbers(column.mean)},
                       {"error", page_numbers(column.error)},
                       {"sigma", page_numbers(column.sigma)},
                       {"count", column.count}});
  }
  return {{"point", curve.point}, {"taps", curve.taps}, {"columns", columns}};
}

Json page_snapshots(const DrawnSnapshots& kept) {
  Json heights = Json::array();
  for (const DrawnHeights& one : kept.heights) {
    heights.push_back({{"tap", one.tap}, {"n", page_numbers(one.n)}});
  }
  return {{"point", kept.point},
          {"taps", kept.taps},
          {"coordination", page_numbers(kept.coordination)},
          {"coordination_error", page_numbers(kept.coordination_error)},
          {"bin_width", kept.bin_width},
          {"heights", heights}};
}

}  // namespace

Json page_data(const ResultsFile& file, const std::string& digest, const PageRoom& room,
               int threads) {
  std::vector<std::string> left_out;
  Json data = page_run(file, digest, left_out);
  Json curves = Json::array(), snapshots = Json::array(), tables = Json::array();
  for (const DrawnCurve& one : drawn_curves(file, room.drawn, {}, left_out)) {
    curves.push_back(page_curve(one));
  }
  for (const DrawnSnapshots& one : drawn_snapshots(file, {}, left_out)) {
    snapshots.push_back(page_snapshots(one));
  }
  for (const DrawnTable& one : drawn_tables(file, room.drawn, {}, left_out)) {
    tables.push_back(page_table(one.table, one.group));
  }
  data["curves"] = curves;
  data["snapshots"] = snapshots;
  data["tables"] = tables;
  data["packings"] = page_packings(file, room.packing_bytes, threads, left_out);
  Json texts = Json::array();
  for (const std::string& text : left_out) texts.push_back(page_text(text));
  data["left_out"] = texts;
  return data;
}

}  // namespace jostle::inline study
