#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/drawing/drawn/thinning.hpp"
#include "study/drawing/figures/structure_parts.hpp"

namespace jostle::inline study {
namespace {

constexpr std::size_t most_taps = 6;  // in one figure

std::vector<std::size_t> tap_places(const TableView& table) {
  return evenly_spread(table.axis("tap").size(), most_taps);
}

void add_plot(const DrawnFile& file, const TableView& table, const PartPlot& plot,
              Figures& figures) {
  if (!table.has(plot.y) || !table.has_axis(plot.x)) return;
  const std::vector<std::size_t> places = tap_places(table);
  const std::vector<double> taps = table.axis("tap");
  FigurePanel panel = panel_of(table, plot);
  panel.caption = sentence(table.long_name(plot.y)) +
                  (plot.pooled ? "; over all realizations, at some of the kept taps, with 68 % "
                                 "intervals by the jackknife."
                               : "; means over realizations at some of the kept taps, with 68 % "
                                 "intervals.");
  for (std::size_t k = 0; k < places.size(); ++k) {
    std::vector<FigureRow> rows = rows_at(table, plot, plot.y, true, places[k]);
    if (rows.empty()) continue;
    panel.series.push_back({.name = fmt::format("tap {}", taps[places[k]]),
                            .colour = colour_of(k, places.size()),
                            .drawn = plot.drawn,
                            .rows = std::move(rows),
                            .symbol = panel.series.size()});
  }
  if (panel.series.empty()) return;
  for (std::size_t k = 0;
       plot.companion != nullptr && table.has(plot.companion) && k < places.size(); ++k) {
    panel.series.push_back({.name = k == 0 ? plot.beside_name : "",
                            .colour = colour_of(k, places.size()),
                            .rows = rows_at(table, plot, plot.companion, false, places[k]),
                            .dash = 1,
                            .has_band = false});
  }
  finish_panel(plot, panel);
  add_panel(file, table.point(), std::move(panel), figures);
}

void add_trends(const DrawnFile& file, const TableView& table, const DrawnPart& part,
                Figures& figures) {
  constexpr std::size_t fewest_taps = 3, most_trends = 2;
  const std::vector<double> taps = table.axis("tap");
  if (taps.size() < fewest_taps) return;
  std::size_t n_drawn = 0;
  for (const NumberTrend& trend : part.trends) {
    FigurePanel panel{.x = {"taps t", AxisKind::taps}};
    std::string title;
    for (const char* const name : trend.names) {
      const std::vector<double> values = table.values(name);
      if (std::ranges::none_of(values,
                               [](double value) { return std::isfinite(value) && value != 0; })) {
        continue;
      }
      if (title.empty()) {
        panel.source = table.source(name);
        panel.y.label = printed_name(name);
        title = printed_name(name);
        panel.caption = sentence(table.long_name(name));
      } else {
        panel.y.label += ", " + printed_name(name);
        title += " and " + printed_name(name);
        panel.caption += "; " + sentence(table.long_name(name));
      }
      panel.series.push_back({.name = printed_name(name),
                              .colour = kind_colour(panel.series.size()),
                              .drawn = Drawn::joined_points,
                              .rows = rows_of(taps, values, table.half_widths(name)),
                              .symbol = panel.series.size()});
    }
    if (panel.series.empty() || n_drawn == most_trends) continue;
    ++n_drawn;
    panel.title = sentence(title) + " by tap";
    panel.caption += "; means over realizations with 68 % intervals.";
    panel.y.label += unit_text(table.units(trend.names.front()));
    add_panel(file, table.point(), std::move(panel), figures);
  }
}

void add_holes(const DrawnFile& file, const TableView& table, const std::string& quantity,
               const std::string& title, Figures& figures) {
  if (!table.has(quantity)) return;
  const std::vector<std::string> names = table.axis_texts("hole");
  const std::vector<std::size_t> places = tap_places(table);
  const std::vector<double> taps = table.axis("tap");
  const std::string source = table.source(quantity);
  FigurePanel panel{
      .title = title,
      .caption = sentence(table.long_name(quantity)) +
                 "; means over realizations with 68 % intervals, beside the published share.",
      .source = source.empty() ? "Philippe & Bideau 2001, table I" : source,
      .x = {"Bernal's canonical holes", AxisKind::names},
      .y = {"share", AxisKind::linear, true}};
  for (const std::string& name : names) panel.x.names.push_back(words(name));
  const auto row_at = [&](std::size_t j, double shift, const std::vector<double>& values,
                          const std::vector<double>& errors) {
    return FigureRow{.x = static_cast<double>(j) + shift,
                     .y = j < values.size() ? values[j] : no_value,
                     .error = j < errors.size() ? errors[j] : no_value,
                     .label = words(names[j])};
  };
  for (std::size_t k = 0; k < places.size(); ++k) {
    FigureSeries series{.name = fmt::format("tap {}", taps[places[k]]),
                        .colour = colour_of(k, places.size()),
                        .drawn = Drawn::points,
                        .symbol = k};
    const double shift =
        (static_cast<double>(k) - static_cast<double>(places.size() - 1) / 2) * 0.09;
    for (std::size_t j = 0; j < names.size(); ++j) {
      series.rows.push_back(row_at(j, shift, table.row(quantity, places[k]),
                                   table.half_width_row(quantity, places[k])));
    }
    panel.series.push_back(std::move(series));
  }
  FigureSeries published{.name = "published",
                         .colour = ink_colour(),
                         .drawn = Drawn::points,
                         .symbol = 4,
                         .hollow = true};
  for (std::size_t j = 0; j < names.size(); ++j) {
    published.rows.push_back(row_at(j, 0.34, table.row(quantity + "_published", 0), {}));
  }
  panel.series.push_back(std::move(published));
  add_panel(file, table.point(), std::move(panel), figures);
}

/// g_ij of each two kinds of a mixture at the last of the kept taps.
void add_partial_pairs(const DrawnFile& file, const TableView& table, const PartPlot& plot,
                       Figures& figures) {
  const std::vector<double> taps = table.axis("tap");
  if (taps.empty()) return;
  FigurePanel panel{
      .title = "Partial pair correlation",
      .caption = fmt::format("Pair correlation of each two kinds of spheres at tap {}, against the "
                             "distance over the sum of the two radii; over all realizations, with "
                             "68 % intervals by the jackknife.",
                             taps.back()),
      .x = {"distance (sum of the two radii)"},
      .y = {"g_ij", AxisKind::linear, true}};
  panel.x.low = plot.x_low;
  panel.rules.push_back({.y = 1});
  for (const std::string& name : table.quantities()) {
    if (!name.starts_with("g_") || name.ends_with("_error") || name.ends_with("_dof")) continue;
    panel.series.push_back({.name = words(name.substr(2)),
                            .colour = kind_colour(panel.series.size()),
                            .rows = rows_at(table, plot, name, true, taps.size() - 1)});
  }
  if (panel.series.empty()) return;
  finish_panel(plot, panel);
  add_panel(file, table.point(), std::move(panel), figures);
}

}  // namespace

void add_structure(const DrawnFile& file, Figures& figures) {
  add_structure_of_points(file, figures);
  for (const DrawnPart& part : drawn_parts()) {
    const std::vector<TableView> made = file.made_of("structure", part.name);
    for (const std::uint32_t point : points_of(file, made)) {
      const std::size_t n_before = figures.size();
      const auto own = std::ranges::find_if(
          made, [&](const TableView& table) { return table.point() == point; });
      if (own == made.end()) continue;
      if (std::string_view(part.name) == "holes") {
        add_holes(file, *own, "number_fraction", "Holes by number", figures);
        add_holes(file, *own, "volume_fraction", "Holes by volume", figures);
      }
      for (const PartPlot& plot : part.plots) add_plot(file, *own, plot, figures);
      if (std::string_view(part.name) == "pair_correlation")
        add_partial_pairs(file, *own, part.plots.front(), figures);
      add_trends(file, *own, part, figures);
      for (std::size_t i = n_before; i < figures.size(); ++i) figures[i].section = part.name;
    }
  }
}

}  // namespace jostle::inline study
