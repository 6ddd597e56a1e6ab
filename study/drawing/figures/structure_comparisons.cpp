#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "study/drawing/drawn/thinning.hpp"
#include "study/drawing/figures/structure_parts.hpp"

// The structure of sweep points beside each other.
namespace jostle::inline study {
namespace {

/// The table of a part at a sweep point of the figure.
struct PointTable {
  ShownPoint point;
  const TableView* table;
};

/// Tables of the points that were measured with the settings that most of them have.
struct ComparableTables {
  std::vector<PointTable> tables;
  std::string left_out;  // a sentence on the other points, for captions
};

ComparableTables tables_of_points(const DrawnFile& file, const std::vector<TableView>& made) {
  std::vector<std::vector<PointTable>> groups;
  for (const ShownPoint& point : file.shown_points()) {
    const auto own = std::ranges::find_if(
        made, [&](const TableView& table) { return table.point() == point.number; });
    if (own == made.end()) continue;
    auto group = std::ranges::find_if(groups, [&](const std::vector<PointTable>& tables) {
      return measured_alike(*tables.front().table, *own);
    });
    if (group == groups.end()) group = groups.insert(group, std::vector<PointTable>{});
    group->push_back({point, &*own});
  }
  if (groups.empty()) return {};
  const auto most = std::ranges::max_element(groups, {}, &std::vector<PointTable>::size);
  std::vector<std::string> labels;
  for (const std::vector<PointTable>& tables : groups)
    if (&tables != &*most)
      for (const PointTable& table : tables) labels.push_back(table.point.label);
  return {spread(*most, most_shown),
          labels.empty() ? ""
                         : fmt::format(" Measured with other settings, and left out: {}.",
                                       fmt::join(labels, ", "))};
}

/// The last tap that all have.
std::optional<double> last_common_tap(const std::vector<PointTable>& tables) {
  const std::vector<double> taps = tables.front().table->axis("tap");
  for (std::size_t i = taps.size(); i-- > 0;) {
    const bool is_common = std::ranges::all_of(tables, [&](const PointTable& table) {
      const std::vector<double> own = table.table->axis("tap");
      return std::ranges::find(own, taps[i]) != own.end();
    });
    if (is_common) return taps[i];
  }
  return std::nullopt;
}

std::size_t place_of(const TableView& table, double tap) {
  const std::vector<double> taps = table.axis("tap");
  return static_cast<std::size_t>(std::ranges::find(taps, tap) - taps.begin());
}

void add_curves(const DrawnFile& file, const ComparableTables& comparable, const PartPlot& plot,
                double tap, Figures& figures) {
  const auto& [tables, left_out] = comparable;
  const TableView& first = *tables.front().table;
  if (!first.has(plot.y) || !first.has_axis(plot.x)) return;
  FigurePanel panel = panel_of(first, plot);
  panel.title += fmt::format(", sweep points after {} taps", tap);
  panel.caption =
      sentence(first.long_name(plot.y)) +
      fmt::format("; one curve per sweep point after {} taps, {} with 68 % intervals.", tap,
                  plot.pooled ? "over all realizations" : "means over realizations") +
      left_out;
  for (const auto& [point, table] : tables) {
    std::vector<FigureRow> rows = rows_at(*table, plot, plot.y, true, place_of(*table, tap));
    if (rows.empty()) continue;
    panel.series.push_back({.name = point.label,
                            .colour = point.colour,
                            .drawn = plot.drawn,
                            .rows = std::move(rows),
                            .symbol = panel.series.size(),
                            .point = point.number});
  }
  if (panel.series.size() < 2) return;
  finish_panel(plot, panel);
  add_panel(file, std::nullopt, std::move(panel), figures, comparison_subject);
}

bool has_value(const TableView& table, const char* name) {
  return std::ranges::any_of(table.values(name), [](double value) { return std::isfinite(value); });
}

/// The first number that is not 0 everywhere, against taps.
void add_numbers(const DrawnFile& file, const ComparableTables& comparable,
                 const std::vector<NumberTrend>& trends, Figures& figures) {
  const auto& [tables, left_out] = comparable;
  for (const NumberTrend& trend : trends) {
    const char* const name = trend.names.front();
    const TableView& first = *tables.front().table;
    if (!has_value(first, name) || first.axis("tap").size() < 2) continue;
    FigurePanel panel{
        .title = sentence(printed_name(name)) + " by tap, sweep points",
        .caption = sentence(first.long_name(name)) +
                   "; one curve per sweep point, means over realizations with 68 % intervals." +
                   left_out,
        .source = first.source(name),
        .x = {"taps t", AxisKind::taps},
        .y = {printed_name(name) + unit_text(first.units(name))}};
    for (const auto& [point, table] : tables) {
      panel.series.push_back(
          {.name = point.label,
           .colour = point.colour,
           .drawn = Drawn::joined_points,
           .rows = rows_of(table->axis("tap"), table->values(name), table->half_widths(name)),
           .symbol = panel.series.size(),
           .point = point.number});
    }
    add_panel(file, std::nullopt, std::move(panel), figures, comparison_subject);
    return;
  }
}

}  // namespace

void add_structure_of_points(const DrawnFile& file, Figures& figures) {
  for (const DrawnPart& part : drawn_parts()) {
    const std::vector<TableView> made = file.made_of("structure", part.name);
    const ComparableTables comparable = tables_of_points(file, made);
    if (comparable.tables.size() < 2) continue;
    const std::size_t n_before = figures.size();
    const std::optional<double> tap = last_common_tap(comparable.tables);
    if (tap && !part.plots.empty()) add_curves(file, comparable, part.plots.front(), *tap, figures);
    add_numbers(file, comparable, part.trends, figures);
    for (std::size_t i = n_before; i < figures.size(); ++i) figures[i].section = part.name;
  }
}

}  // namespace jostle::inline study
