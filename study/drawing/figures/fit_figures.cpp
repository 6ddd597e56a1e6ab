#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "study/drawing/figures/builders.hpp"

namespace jostle::inline study {
namespace {

/// Measured t may have any unit; wide ranges are those of relaxation.
FigureAxis t_axis(const TableView& table) {
  if (table.note("measured").empty()) return {"taps t", AxisKind::taps};
  const std::vector<double> t = table.axis("t");
  const auto [first, last] = std::ranges::minmax(t);
  return {"t" + unit_text(table.note("t_unit")),
          first > 0 && last > 100 * first ? AxisKind::logarithmic : AxisKind::linear};
}

/// " 38 of 320 points are drawn.", or empty where all are.
std::string drawn_share(const TableView& table) {
  const std::string drawn = table.note("drawn");
  return drawn.empty() ? "" : fmt::format(" {} points are drawn.", drawn);
}

std::string data_caption(const TableView& table, const std::string& range) {
  const std::string measured = table.note("measured"), drawn = drawn_share(table);
  if (measured.empty()) {
    return fmt::format(
        "Mean over realizations (points; bars are 68 % intervals by the variance pooled over "
        "taps) and the fitted laws, taps {}.{}",
        range, drawn);
  }
  if (measured == "realizations") {
    return fmt::format(
        "Mean over {} realizations (points; bars are 68 % intervals by the pooled variance) and "
        "the fitted laws, t {}.{}",
        table.note("realizations"), range, drawn);
  }
  return fmt::format("Measured values (points{}) and the fitted laws, t {}.{}",
                     measured == "errors" ? "; bars are the errors given" : "", range, drawn);
}

FigurePanel data_panel(const std::vector<TableView>& laws, const std::string& observable) {
  const TableView& first = laws.front();
  std::string range = first.note("range");
  if (const std::size_t colon = range.find(':'); colon != std::string::npos) {
    range.replace(colon, 1, " to ");
  }
  const std::string measured_unit = first.note("x_unit");
  FigurePanel panel{
      .title = "Fits of " + words(observable),
      .caption = data_caption(first, range),
      .x = t_axis(first),
      .y = {axis_label(observable, measured_unit.empty() ? first.units("x") : measured_unit)},
      .series = {{.name = "data",
                  .colour = ink_colour(),
                  .drawn = Drawn::points,
                  .rows = rows_of(first.axis("t"), first.values("x"), first.half_widths("x"))}}};
  for (std::size_t i = 0; i < laws.size(); ++i) {
    panel.series.push_back({.name = law_name(laws[i]),
                            .colour = kind_colour(i),
                            .rows = rows_of(laws[i].axis("t"), laws[i].values("fitted")),
                            .dash = i});
    const std::string source = laws[i].note("source");
    if (!source.empty() && panel.source.find(source) == std::string::npos) {
      panel.source += (panel.source.empty() ? "" : "; ") + source;
    }
  }
  return panel;
}

FigurePanel residual_panel(const std::vector<TableView>& laws, const std::string& observable) {
  const bool scaled =
      std::ranges::any_of(laws.front().values("x_error"), [](double error) { return error > 0; });
  const std::string unit = scaled ? ", in standard errors of the mean. Neighbouring points are not "
                                    "independent: a trend matters, a single point does not."
                                  : ".";
  FigurePanel panel{.title = "Residuals of " + words(observable),
                    .caption = "Data minus law" + unit + drawn_share(laws.front()),
                    .x = t_axis(laws.front()),
                    .y = {scaled ? "(data − law) / standard error" : "data − law"},
                    .rules = {{.y = 0}}};
  for (std::size_t i = 0; i < laws.size(); ++i) {
    std::vector<double> residuals = laws[i].values("x");
    const std::vector<double> fitted = laws[i].values("fitted"), errors = laws[i].values("x_error");
    for (std::size_t k = 0; k < residuals.size(); ++k) {
      const double error = !scaled ? 1 : k < errors.size() ? errors[k] : no_value;
      residuals[k] = (residuals[k] - (k < fitted.size() ? fitted[k] : no_value)) / error;
      if (!std::isfinite(residuals[k])) residuals[k] = no_value;
    }
    panel.series.push_back({.name = law_name(laws[i]),
                            .colour = kind_colour(i),
                            .rows = rows_of(laws[i].axis("t"), residuals),
                            .dash = i});
  }
  return panel;
}

}  // namespace

std::string law_name(const std::string& model) {
  static const std::map<std::string, std::string> names{
      {"inverse_log", "inverse logarithm"},
      {"inverse_log_height", "inverse logarithm, eq. 4"},
      {"two_exponentials", "two exponentials"},
      {"kww", "stretched exponential"},
      {"own", "own law"}};
  const auto found = names.find(model);
  return found == names.end() ? words(model) : found->second;
}

std::string law_name(const TableView& table) {
  return law_name(table.path().back());
}

std::vector<FittedLaws> fitted_laws(const std::vector<TableView>& made, std::uint32_t point) {
  std::vector<FittedLaws> curves;
  for (const TableView& table : made) {
    if (table.point() != point) continue;
    const std::string& observable = table.path().front();
    auto curve = std::ranges::find(curves, observable, &FittedLaws::observable);
    if (curve == curves.end()) curve = curves.insert(curve, {observable, {}});
    const bool is_known = std::ranges::any_of(curve->laws, [&](const TableView& law) {
      return law.note("restated_model") == table.path().back();  // this curve
    });
    if (!is_known) curve->laws.push_back(table);
  }
  return curves;
}

void add_fits(const DrawnFile& file, Figures& figures) {
  std::vector<TableView> made;
  for (const TableView& table : file.made_of("fits")) {
    if (table.has("fitted")) made.push_back(table);
  }
  for (const std::uint32_t point : points_of(file, made)) {
    for (const FittedLaws& curve : fitted_laws(made, point)) {
      add_panel(file, point, data_panel(curve.laws, curve.observable), figures, curve.observable);
      figures.back().panels.push_back(residual_panel(curve.laws, curve.observable));
    }
  }
}

}  // namespace jostle::inline study
