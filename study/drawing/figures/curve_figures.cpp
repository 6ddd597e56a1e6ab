#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "ensemble/statistics/finite_text.hpp"
#include "study/drawing/figures/builders.hpp"

namespace jostle::inline study {
namespace {

bool is_any_finite(const std::vector<double>& values) {
  return std::ranges::any_of(values, [](double value) { return std::isfinite(value); });
}

/// Names of the columns of this kind that any sweep point has.
template <class Wanted>
std::vector<std::string> names_of(const DrawnFile& file, Wanted wanted) {
  std::vector<std::string> names;
  for (const DrawnCurve& curve : file.curves()) {
    for (const DrawnColumn& column : curve.columns) {
      if (!wanted(column) || !is_any_finite(column.mean)) continue;
      if (std::ranges::find(names, column.label.name) == names.end()) {
        names.push_back(column.label.name);
      }
    }
  }
  return names;
}

enum class Shows { mean, sigma };

std::vector<FigureSeries> column_series(const DrawnFile& file, const std::string& name,
                                        Shows shows) {
  std::vector<FigureSeries> series;
  for (const ShownPoint& point : file.shown_points()) {
    const DrawnCurve& curve = *file.curve(point.number);
    FigureSeries point_series{.name = point.label, .colour = point.colour, .point = point.number};
    for (const DrawnColumn& column : curve.columns) {
      if (column.label.name != name) continue;
      const std::vector<double> taps(curve.taps.begin(), curve.taps.end());
      point_series.rows = shows == Shows::mean ? rows_of(taps, column.mean, column.half_width)
                                               : rows_of(taps, column.sigma);
    }
    series.push_back(std::move(point_series));
  }
  return series;
}

/// Single realizations beside the means, as thin lines.
std::vector<FigureSeries> realization_series(const DrawnFile& file, const std::string& name) {
  std::vector<FigureSeries> series;
  for (const ShownPoint& point : file.shown_points()) {
    const DrawnCurve& curve = *file.curve(point.number);
    const std::vector<double> taps(curve.taps.begin(), curve.taps.end());
    for (const DrawnColumn& column : curve.columns) {
      if (column.label.name != name) continue;
      for (const DrawnRealization& realization : column.realizations) {
        const std::string label = fmt::format("realization {}", realization.number);
        series.push_back({.name = point.label.empty() ? label : point.label + ", " + label,
                          .colour = point.colour,
                          .rows = rows_of(taps, realization.values),
                          .is_thin = true,
                          .point = point.number});
      }
    }
  }
  return series;
}

/// "thin lines: 5 of 8 realizations"; at several sweep points as many of each.
std::string thin_lines(const DrawnFile& file, const std::string& name) {
  std::size_t most = 0, n_points = 0;
  for (const ShownPoint& point : file.shown_points()) {
    for (const DrawnColumn& column : file.curve(point.number)->columns) {
      if (column.label.name != name || column.realizations.empty()) continue;
      most = std::max(most, column.realizations.size());
      ++n_points;
    }
  }
  return fmt::format("thin lines: {} of {} realizations{}", most, file.n_realizations(),
                     n_points > 1 ? " of each sweep point" : "");
}

void add_mean(const DrawnFile& file, const std::string& name, Figures& figures) {
  const Column& label = file.column(name)->label;
  const std::string errors = file.n_realizations() > 1
                                 ? "the band is the 68 % interval of the mean over realizations"
                                 : "of one realization, without an error";
  std::vector<FigureSeries> series = column_series(file, name, Shows::mean);
  std::vector<FigureSeries> thin = realization_series(file, name);
  const std::string lines = thin.empty() ? "" : "; " + thin_lines(file, name);
  series.insert(series.end(), std::make_move_iterator(thin.begin()),
                std::make_move_iterator(thin.end()));
  add_panel(file, std::nullopt,
            {.title = sentence(words(name)),
             .caption = fmt::format(
                 "{}, against the number of taps; {}{}. Tap 0 is the starting packing.",
                 sentence(label.long_name.empty() ? words(name) : label.long_name), errors, lines),
             .source = label.source == "jostle" ? "" : label.source,
             .x = file.tap_axis(),
             .y = {axis_label(name, label.units)},
             .series = std::move(series)},
            figures);
}

constexpr std::string_view kind_height = "height_";  // before the name of the kind

/// The heights of a mixture's kinds in one figure, at each of the shown sweep points.
void add_kind_heights(const DrawnFile& file, Figures& figures) {
  std::vector<std::uint32_t> points;
  for (const DrawnCurve& curve : file.curves()) points.push_back(curve.point);
  for (const std::uint32_t point : file.chosen(points)) {
    const DrawnCurve& curve = *file.curve(point);
    const std::vector<double> taps = as_numbers(curve.taps);
    std::vector<FigureSeries> series;
    std::string units;
    for (const DrawnColumn& column : curve.columns) {
      if (!column.label.name.starts_with(kind_height) || !is_any_finite(column.mean)) continue;
      units = column.label.units;
      series.push_back({.name = words(column.label.name.substr(kind_height.size())),
                        .colour = kind_colour(series.size()),
                        .rows = rows_of(taps, column.mean, column.half_width)});
    }
    if (series.size() < 2) continue;
    add_panel(
        file, point,
        {.title = "Heights of the kinds",
         .caption = fmt::format(
             "Mean height of the centres of every observed kind of spheres, weighted by "
             "volume, against the number of taps{}. Tap 0 is the starting packing.",
             file.n_realizations() > 1 ? "; bands are 68 % intervals of the means over realizations"
                                       : ""),
         .x = file.tap_axis(),
         .y = {"height z" + unit_text(units)},
         .series = std::move(series)},
        figures, "kind_heights");
  }
}

}  // namespace

void add_compaction(const DrawnFile& file, Figures& figures) {
  const auto is_observable = [](const DrawnColumn& column) { return column.is_observable; };
  for (const std::string& name : names_of(file, is_observable)) add_mean(file, name, figures);
  add_kind_heights(file, figures);
}

void add_spread(const DrawnFile& file, Figures& figures) {
  if (file.n_realizations() < 2) return;
  const auto varies = [](const DrawnColumn& column) {
    return column.is_observable &&
           std::ranges::any_of(column.sigma, [](double sigma) { return sigma > 0; });
  };
  for (const std::string& name : names_of(file, varies)) {
    add_panel(
        file, std::nullopt,
        {.title = "Spread of " + words(name),
         .caption =
             fmt::format("Standard deviation of {} over realizations at each tap (population "
                         "deviation, 1/M). The standard error of the mean is σ/√(M−1).",
                         words(name)),
         .source = "Rosato et al. 2010",
         .x = file.tap_axis(),
         .y = {fmt::format("σ of {}{}", words(name), unit_text(file.column(name)->label.units)),
               AxisKind::linear, true},
         .series = column_series(file, name, Shows::sigma)},
        figures);
  }
}

void add_engine(const DrawnFile& file, Figures& figures) {
  const auto is_told = [](const DrawnColumn& column) {
    return !column.is_observable && column.label.shown != Shown::count &&
           column.label.shown != Shown::share && std::ranges::any_of(column.mean, [](double mean) {
             return mean != 0 && std::isfinite(mean);
           });
  };
  for (const std::string& name : names_of(file, is_told)) add_mean(file, name, figures);
}

void add_snapshots(const DrawnFile& file, Figures& figures) {
  std::vector<FigureSeries> series;
  for (const ShownPoint& point : file.shown_points()) {
    for (const DrawnSnapshots& kept : file.snapshots()) {
      if (kept.point != point.number || !is_any_finite(kept.coordination)) continue;
      series.push_back(
          {.name = point.label,
           .colour = point.colour,
           .drawn = Drawn::joined_points,
           .rows = rows_of(as_numbers(kept.taps), kept.coordination, kept.coordination_half_width),
           .symbol = series.size(),
           .point = point.number});
    }
  }
  if (!series.empty()) {
    add_panel(
        file, std::nullopt,
        {.title = "Coordination of the kept packings",
         .caption = "Mean number of centres within the contact cut of a centre (of spheres of "
                    "several sizes, the cut times the sum of the two radii), all spheres, "
                    "at the taps of the snapshots; bars are 68 % intervals over "
                    "realizations.",
         .x = file.tap_axis(),
         .y = {"mean coordination N_c"},
         .series = std::move(series)},
        figures, "coordination");
  }
  if (!file.made_of("structure", "layers").empty()) return;  // they have n(z), with errors
  std::vector<std::uint32_t> points;
  for (const DrawnSnapshots& kept : file.snapshots()) {
    if (!kept.heights.empty()) points.push_back(kept.point);
  }
  for (const std::uint32_t point : file.chosen(points)) {
    const DrawnSnapshots& kept =
        *std::ranges::find(file.snapshots(), point, &DrawnSnapshots::point);
    FigurePanel panel{.title = "Centres by height, n(z)",
                      .caption = finite_text(
                          "Fraction of all centres in a bin of height, {:.6g} diameters, means "
                          "over realizations, at some of the kept taps.",
                          kept.bin_width),
                      .source = "Rosato et al. 2010, fig. 6",
                      .x = {"height z (diameters)"},
                      .y = {"fraction of centres in a bin", AxisKind::linear, true}};
    for (std::size_t k = 0; k < kept.heights.size(); ++k) {
      std::vector<double> heights;
      for (std::size_t i = 0; i < kept.heights[k].n.size(); ++i) {
        heights.push_back((static_cast<double>(i) + 0.5) * kept.bin_width);
      }
      panel.series.push_back({.name = fmt::format("tap {}", kept.heights[k].tap),
                              .colour = colour_of(k, kept.heights.size()),
                              .rows = rows_of(heights, kept.heights[k].n)});
    }
    add_panel(file, point, std::move(panel), figures, "heights");
  }
}

}  // namespace jostle::inline study
