#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensemble/statistics/finite_text.hpp"
#include "study/drawing/figures/builders.hpp"

// Figures of ordering, volumes and memory.
namespace jostle::inline study {
namespace {

FigurePanel compactivity(const TableView& table) {
  FigurePanel panel{
      .title = "Compactivity, by " + words(table.path().back()),
      .caption =
          "1/X less that of the first steady state, X the compactivity, against the mean "
          "volume of the states; bars are 68 % intervals.",
      .source = table.source("inverse_x_fluctuations"),
      .x = {"volume per sphere" + unit_text(table.units("volume"))},
      .y = {"Δ(1/X)" + unit_text(table.units("inverse_x_fluctuations"))},
      .rules = {{.y = 0}}};
  for (const auto& [name, label] :
       {std::pair{"inverse_x_fluctuations", "by fluctuations"},
        std::pair{"inverse_x_histograms", "by overlapping histograms"}}) {
    const std::size_t i = panel.series.size();
    panel.series.push_back(
        {.name = label,
         .colour = kind_colour(i),
         .drawn = Drawn::joined_points,
         .rows = rows_of(table.values("volume"), table.values(name), table.half_widths(name)),
         .symbol = i,
         .hollow = i > 0});
    std::erase_if(panel.series.back().rows,
                  [](const FigureRow& row) { return !std::isfinite(row.y); });
  }
  return panel;
}

/// Values of a quantity between the ends of their 68 % intervals.
std::vector<FigureRow> rows_between(const std::vector<double>& xs, const TableView& table,
                                    const std::string& quantity) {
  std::vector<FigureRow> rows = rows_of(xs, table.values(quantity));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].low = table.value(quantity + "_low_68", i);
    rows[i].high = table.value(quantity + "_high_68", i);
  }
  return rows;
}

FigurePanel variances(const TableView& table) {
  return {.title = "Variance of the volume, by " + words(table.path().back()),
          .caption =
              "Variance of a bed's volume per sphere of each state, over taps and "
              "realizations, against its mean; bars are 68 % intervals.",
          .source = table.source("volume_variance"),
          .x = {"volume per sphere" + unit_text(table.units("volume"))},
          .y = {"variance" + unit_text(table.units("volume_variance"))},
          .series = {{.name = "",
                      .colour = kind_colour(0),
                      .drawn = Drawn::joined_points,
                      .rows = rows_between(table.values("volume"), table, "volume_variance")}}};
}

FigurePanel response(const TableView& table) {
  const std::string name = table.observable(), control = control_of(table);
  const std::vector<double> lags = table.axis("lag_window");
  const std::size_t n = table.axis("history").size();
  FigurePanel panel{
      .title = "Memory of " + words(name),
      .caption = fmt::format(
          "Change of {} since the switch to taps of one strength, mean over "
          "windows of lags, one curve per history; bars are 68 % intervals. "
          "Histories that came to one value have one curve where it alone is the state.",
          words(name)),
      .source = table.source("response"),
      .x = {"end of the window of lags (taps)", AxisKind::logarithmic},
      .y = {"change of " + axis_label(name, table.units("response"))},
      .rules = {{.y = 0}}};
  for (std::size_t k = 0; k < n; ++k)
    panel.series.push_back(
        {.name =
             finite_text("{} = {:.4g} before", control_symbol(control), table.value(control, k)),
         .colour = colour_of(k, n),
         .drawn = Drawn::joined_points,
         .rows = rows_of(lags, table.row("response", k), table.half_width_row("response", k)),
         .symbol = k});
  return panel;
}

}  // namespace

void add_ordering(const DrawnFile& file, Figures& figures) {
  std::vector<TableView> made = file.made_of("analysis", "ordering");
  std::erase_if(made, [](const TableView& table) { return !table.point(); });
  std::vector<std::string> observables;
  for (const TableView& table : made) {
    if (std::ranges::find(observables, table.path().back()) == observables.end())
      observables.push_back(table.path().back());
  }
  for (const std::string& observable : observables) {
    FigurePanel panel{.title = "Not yet ordered, by " + words(observable),
                      .x = {"taps t", AxisKind::taps},
                      .y = {"share not yet ordered"}};
    for (const ShownPoint& point : file.shown_points()) {
      for (const TableView& table : made) {
        if (table.point() != point.number || table.path().back() != observable) continue;
        panel.caption = fmt::format(
            "Share of the beds that are not yet ordered ({}), by Kaplan & Meier's estimate; "
            "bars are 95 % intervals.",
            table.note("rule"));
        panel.source = table.source("survival");
        FigureSeries series{.name = point.label,
                            .colour = point.colour,
                            .drawn = Drawn::stepped_points,
                            .symbol = panel.series.size(),
                            .point = point.number};
        const std::vector<double> taps = table.axis("tap"), share = table.values("survival"),
                                  low = table.values("survival_low_95"),
                                  high = table.values("survival_high_95");
        for (std::size_t i = 0; i < taps.size(); ++i)
          series.rows.push_back({.x = taps[i],
                                 .y = value_at(share, i),
                                 .low = value_at(low, i),
                                 .high = value_at(high, i)});
        panel.series.push_back(std::move(series));
      }
    }
    add_panel(file, std::nullopt, std::move(panel), figures);
  }
}

void add_volumes(const DrawnFile& file, Figures& figures) {
  for (const TableView& table : file.made_of("analysis", "volumes")) {
    add_panel(file, std::nullopt, compactivity(table), figures, table.name());
    add_panel(file, std::nullopt, variances(table), figures, table.name());
  }
}

void add_memory(const DrawnFile& file, Figures& figures) {
  for (const TableView& table : file.made_of("analysis", "memory"))
    add_panel(file, std::nullopt, response(table), figures, table.name());
}

}  // namespace jostle::inline study
