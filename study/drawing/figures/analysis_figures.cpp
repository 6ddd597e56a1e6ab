#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ensemble/statistics/finite_text.hpp"
#include "study/drawing/figures/builders.hpp"

namespace jostle::inline study {
namespace {

FigurePanel measured_ageing(const TableView& table) {
  return {.title = fmt::format("Ageing of {}, as measured", words(table.path().back())),
          .caption =
              "A(t, t_W) = ⟨(X(t_W+t) − X(t_W))²⟩ over realizations against the lag t, one "
              "curve per waiting time t_W; bars are 68 % intervals.",
          .source = table.source("a").empty() ? "Philippe & Bideau 2001, eq. 5" : table.source("a"),
          .x = {"lag t (taps)", AxisKind::logarithmic},
          .y = {"A(t, t_W)" + unit_text(table.units("a")), AxisKind::logarithmic},
          .series = by_waiting_time(table, [&](std::size_t k, std::size_t j, double lag) {
            return FigureRow{.x = lag,
                             .y = value_at(table.row("a", k), j),
                             .low = value_at(table.row("a_low_68", k), j),
                             .high = value_at(table.row("a_high_68", k), j)};
          })};
}

FigurePanel fluctuations(const TableView& table) {
  return {.title = fmt::format("Ageing of {}: fluctuations", words(table.path().back())),
          .caption =
              "V(t, t_W), the variance of X(t_W+t) − X(t_W) over realizations: A without the "
              "change that they share; bars are 68 % intervals.",
          .source = table.source("v"),
          .x = {"lag t (taps)", AxisKind::logarithmic},
          .y = {"V(t, t_W)" + unit_text(table.units("v")), AxisKind::logarithmic},
          .series = by_waiting_time(table, [&](std::size_t k, std::size_t j, double lag) {
            return FigureRow{.x = lag,
                             .y = value_at(table.row("v", k), j),
                             .low = value_at(table.row("v_low_68", k), j),
                             .high = value_at(table.row("v_high_68", k), j)};
          })};
}

std::string collapse_text(const TableView& table) {
  const double scaled = table.value("collapse_relative"),
               unscaled = table.value("unscaled_collapse_relative");
  if (!std::isfinite(scaled) || !std::isfinite(unscaled)) {
    return " Curves whose fit does not limit the scales are missing.";
  }
  return finite_text(" The curves differ by {:.2g} of their values, and by {:.2g} before scaling.",
                     scaled, unscaled);
}

FigurePanel scaled_ageing(const TableView& table) {
  return {.title = fmt::format("Ageing of {}, scaled", words(table.path().back())),
          .caption =
              "A/A∞ against t/τ, with the scales of fits that share one B; the curves fall "
              "on one where ageing is a change of scales alone; bars are 68 % intervals." +
              collapse_text(table),
          .source = "Philippe & Bideau 2001, eq. 6",
          .x = {"t / τ(t_W)", AxisKind::logarithmic},
          .y = {"A / A_∞(t_W)"},
          .series = by_waiting_time(table, [&](std::size_t k, std::size_t j, double) {
            return FigureRow{.x = value_at(table.row("scaled_lag", k), j),
                             .y = value_at(table.row("scaled_a", k), j),
                             .error = value_at(table.half_width_row("scaled_a", k), j)};
          })};
}

FigurePanel covariance_ratio(const TableView& table) {
  return {
      .title = "Covariance ratio of " + words(table.path().back()),
      .caption =
          "C(t, t_W): covariance over realizations of the values at t_W and t_W+t, over the "
          "variance at t_W alone: 1 at lag 0, above 1 where realizations spread apart. Bars are 68 "
          "% intervals; those longer than 1 to a side are not drawn.",
      .source = table.source("c"),
      .x = {"lag t (taps)", AxisKind::logarithmic},
      .y = {"C(t, t_W)"},
      .rules = {{.y = 0}},
      .series = by_waiting_time(table, [&](std::size_t k, std::size_t j, double lag) {
        const double error = value_at(table.half_width_row("c", k), j);
        return FigureRow{
            .x = lag, .y = value_at(table.row("c", k), j), .error = error <= 1 ? error : no_value};
      })};
}

/// The line of the slope, through the geometric mean of what it was fitted to.
std::vector<FigureRow> slope_line(const TableView& table) {
  const double slope = table.value("slope");
  double lowest = 0, highest = 0;
  if (std::sscanf(table.note("band").c_str(), "%lf to %lf per tap", &lowest, &highest) != 2 ||
      !std::isfinite(slope)) {
    return {};
  }
  const std::vector<double> frequencies = table.axis("frequency"),
                            density = table.values("density");
  std::vector<double> inside;
  double f0 = 0, p0 = 0;
  for (std::size_t i = 0; i < std::min(frequencies.size(), density.size()); ++i) {
    const double f = std::log(frequencies[i]), p = std::log(density[i]);
    if (!(f >= std::log(lowest * 0.99) && f <= std::log(highest * 1.01)) || !std::isfinite(p)) {
      continue;
    }
    inside.push_back(f);
    f0 += f;
    p0 += p;
  }
  if (inside.size() < 2) return {};
  const auto n = static_cast<double>(inside.size());
  std::vector<FigureRow> rows;
  for (const double f : {inside.front(), inside.back()}) {
    rows.push_back({.x = std::exp(f), .y = std::exp(p0 / n + slope * (f - f0 / n))});
  }
  return rows;
}

/// Settings whose error and time no other beats, in the order of their times; and the others.
std::vector<FigureSeries> settings_of(const TableView& table) {
  FigureSeries best{.name = "no other is better and faster",
                    .colour = kind_colour(0),
                    .drawn = Drawn::joined_points,
                    .has_labels = true};
  FigureSeries other_settings{.name = "others",
                              .colour = kind_colour(1),
                              .drawn = Drawn::points,
                              .symbol = 1,
                              .hollow = true};
  const std::vector<std::string> names = table.axis_texts("setting");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double error = table.half_width("bias", i);
    const FigureRow row{.x = table.value("tap_seconds", i),
                        .y = std::abs(table.value("bias", i)) + (std::isfinite(error) ? error : 0),
                        .label = names[i]};
    if (!(row.x > 0) || !(row.y > 0)) continue;
    (table.value("pareto", i) == 1 ? best : other_settings).rows.push_back(row);
  }
  std::ranges::stable_sort(best.rows, {}, &FigureRow::x);
  return {std::move(best), std::move(other_settings)};
}

}  // namespace

void add_steady(const DrawnFile& file, Figures& figures) {
  const std::vector<TableView> made = file.made_of("analysis", "steady");
  for (const std::uint32_t point : points_of(file, made)) {
    for (const TableView& table : made) {
      if (table.point() != point) continue;
      add_panel(
          file, point,
          {.title = "Blocking of " + words(table.path().back()),
           .caption =
               fmt::format("Standard error of the mean of taps {}, if blocks of so many taps were "
                           "independent; bars are its 68 % intervals. The error grows with the "
                           "length until blocks are independent, then it stays constant. "
                           "Plateau: {}.",
                           table.note("taps"), table.note("plateau")),
           .source = table.source("block_error"),
           .x = {"block length (taps)", AxisKind::logarithmic},
           .y = {"standard error of the mean" + unit_text(table.units("block_error")),
                 AxisKind::logarithmic},
           .series = {{.name = "",
                       .colour = kind_colour(0),
                       .drawn = Drawn::joined_points,
                       .rows = rows_of(table.axis("block_length"), table.values("block_error"),
                                       table.half_widths("block_error"))}}},
          figures, table.name());
    }
  }
}

void add_ageing(const DrawnFile& file, Figures& figures) {
  const std::vector<TableView> made = file.made_of("analysis", "ageing");
  for (const std::uint32_t point : points_of(file, made)) {
    for (const TableView& table : made) {
      if (table.point() != point) continue;
      for (FigurePanel& panel :
           std::vector<FigurePanel>{measured_ageing(table), fluctuations(table),
                                    scaled_ageing(table), covariance_ratio(table)}) {
        add_panel(file, point, std::move(panel), figures, table.name());
      }
    }
  }
}

void add_spectra(const DrawnFile& file, Figures& figures) {
  const std::vector<TableView> made = file.made_of("analysis", "spectrum");
  std::vector<std::string> observables;
  for (const TableView& table : made) {
    if (std::ranges::find(observables, table.path().back()) == observables.end()) {
      observables.push_back(table.path().back());
    }
  }
  for (const std::string& observable : observables) {
    FigurePanel panel{.title = "Spectrum of " + words(observable),
                      .x = {"frequency (1/taps)", AxisKind::logarithmic},
                      .y = {"", AxisKind::logarithmic}};
    for (const ShownPoint& point : file.shown_points()) {
      for (const TableView& table : made) {
        if (table.point() != point.number || table.path().back() != observable) continue;
        if (panel.series.empty()) {
          panel.caption = fmt::format(
              "One-sided power spectral density of taps {} ({} window, {} removed, {}), averaged "
              "over realizations; bars are 68 % intervals, dashed lines the log-log slopes.",
              table.note("taps"), table.note("window"), table.note("detrending"),
              table.note("segments"));
          panel.source = table.source("density");
          panel.y.label = "power density" + unit_text(table.units("density"));
        }
        panel.series.push_back({.name = point.label,
                                .colour = point.colour,
                                .drawn = Drawn::points,
                                .rows = rows_of(table.axis("frequency"), table.values("density"),
                                                table.half_widths("density")),
                                .symbol = panel.series.size(),
                                .point = point.number});
        std::vector<FigureRow> line = slope_line(table);
        if (line.empty()) continue;
        panel.series.push_back({.name = "",
                                .colour = point.colour,
                                .rows = std::move(line),
                                .dash = 1,
                                .is_guide = true,
                                .point = point.number});
      }
    }
    add_panel(file, std::nullopt, std::move(panel), figures);
  }
}

void add_cost(const DrawnFile& file, Figures& figures) {
  for (const TableView& table : file.made_of("analysis", "cost")) {
    const std::string reference = table.note("reference");
    add_panel(file, std::nullopt,
              {.title = fmt::format("Accuracy of {} against time", words(table.observable())),
               .caption = fmt::format(
                   "|bias| of each setting plus half its 68 % interval, against {}, and the core "
                   "time of a late tap. Line: settings that no other setting beats on both axes.",
                   reference.empty() ? "the most complete" : reference),
               .x = {"core time of a tap (s)", AxisKind::logarithmic},
               .y = {"|bias| + half its 68 % interval" + unit_text(table.units("bias")),
                     AxisKind::logarithmic},
               .series = settings_of(table)},
              figures, table.name());
  }
}

}  // namespace jostle::inline study
