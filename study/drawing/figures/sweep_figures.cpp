#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensemble/analysis/sweeps/sweep_curve.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "study/drawing/figures/builders.hpp"

namespace jostle::inline study {
namespace {

/// A branch with the step at which the branch before it turned: of several steps of that strength,
/// the last belongs to the later branch already.
std::vector<std::size_t> steps_of(const std::vector<double>& branch, std::size_t b,
                                  const std::vector<double>& numbers,
                                  const std::vector<double>& strengths) {
  std::vector<std::size_t> steps;
  for (std::size_t i = 0; i < branch.size(); ++i) {
    const bool is_turn = b > 0 && i + 1 < branch.size() && branch[i + 1] == numbers[b] &&
                         branch[i] == numbers[b - 1] && strengths[i] != strengths[i + 1];
    if (branch[i] == numbers[b] || is_turn) steps.push_back(i);
  }
  return steps;
}

FigurePanel loop_panel(const TableView& table) {
  const std::string observable = table.observable(), control = table.note("control");
  FigurePanel panel{
      .title = "Hysteresis of " + words(observable),
      .caption =
          "Mean of the last taps of every step of the protocol, in the order of the steps; "
          "bars are 68 % intervals over realizations. A branch ends where the strength "
          "turns.",
      .source = table.source(observable),
      .x = {control_label(control, table.units(control))},
      .y = {axis_label(observable, table.units(observable))}};
  const std::vector<double> branch = table.values("branch"), strengths = table.values(control);
  std::vector<double> numbers;
  for (const double value : branch) {
    if (std::ranges::find(numbers, value) == numbers.end()) numbers.push_back(value);
  }
  const double first = branch.empty() ? 0 : std::ranges::min(branch);
  for (std::size_t b = 0; b < numbers.size(); ++b) {
    FigureSeries series{.name = "",
                        .colour = kind_colour(b),
                        .drawn = Drawn::joined_points,
                        .dash = b % 3,
                        .symbol = b};
    for (const std::size_t i : steps_of(branch, b, numbers, strengths)) {
      series.rows.push_back({.x = table.value(control, i),
                             .y = table.value(observable, i),
                             .error = table.half_width(observable, i)});
    }
    series.name =
        fmt::format("branch {}, {}", numbers[b] - first + 1,
                    series.rows.back().x > series.rows.front().x ? "upwards" : "downwards");
    panel.series.push_back(std::move(series));
  }
  return panel;
}

bool is_sweep(const TableView& table) {
  return table.is_in("analysis", "sweep") && !table.is_refused();
}

// Draws the place of a maximum or minimum that was found.
void mark_extremum(const TableView& table, const std::string& name, const char* place,
                   FigurePanel& panel) {
  if (!table.has(name + "_p") || !(table.value(name + "_p") < SweepExtremum::level)) return;
  const double location = table.value(name + "_at");
  panel.caption += finite_text(
      " The {} point of a parabola is at {:.3g}; dashed: it and the 95 % interval of the {}'s "
      "place.",
      place, location, name);
  for (const double x : {location, table.value(name + "_at_low"), table.value(name + "_at_high")}) {
    if (std::isfinite(x)) panel.rules.push_back({.x = x});
  }
}

}  // namespace

void add_hysteresis(const DrawnFile& file, Figures& figures) {
  const std::vector<TableView> made = file.made_of("analysis", "hysteresis");
  for (const std::uint32_t point : points_of(file, made)) {
    for (const TableView& table : made) {
      if (table.point() != point || table.axis("step").empty()) continue;
      add_panel(file, point, loop_panel(table), figures, table.name());
    }
  }
}

void add_sweeps(const DrawnFile& file, Figures& figures) {
  for (const TableView& table : file.tables()) {
    if (!is_sweep(table)) continue;
    const std::string x = table.note("against"), y = table.note("observable");
    if (!table.has_axis(x) || !table.has(y)) continue;
    FigurePanel panel{
        .title = fmt::format("{} against {}", sentence(words(y)),
                             control_label(x, "1", table.long_name(x))),
        .caption = "One point per sweep point; bars are 68 % intervals.",
        .source = table.source(y),
        .x = {control_label(x, table.units(x), table.long_name(x))},
        .y = {axis_label(y, table.units(y))},
        .series = {{.name = "",
                    .colour = kind_colour(0),
                    .drawn = Drawn::joined_points,
                    .rows = rows_of(table.axis(x), table.values(y), table.half_widths(y))}}};
    mark_extremum(table, "maximum", "highest", panel);
    mark_extremum(table, "minimum", "lowest", panel);
    add_panel(file, std::nullopt, std::move(panel), figures, table.name());
  }
}

}  // namespace jostle::inline study
