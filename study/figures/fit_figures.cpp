#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "study/figures/builders.hpp"

namespace jostle::inline study {
namespace {

std::string law_name(const TableView& table) {
  static const std::map<std::string, std::string> names{
      {"inverse_log", "inverse logarithm"},
      {"inverse_log_height", "inverse logarithm, eq. 4"},
      {"two_exponentials", "two exponentials"},
      {"kww", "stretched exponential"}};
  const auto found = names.find(table.path().back());
  return found == names.end() ? words(table.path().back()) : found->second;
}

/// Measured t may have any unit; wide ranges are those of relaxation.
FigureAxis t_axis(const TableView& table) {
  if (table.note("measured").empty()) return {"taps t", AxisKind::taps};
  const std::vector<double> t = table.axis("t");
  const auto [first, last] = std::ranges::minmax(t);
  return {"t", first > 0 && last > 100 * first ? AxisKind::logarithmic : AxisKind::linear};
}

std::string data_caption(const TableView& table, const std::string& range) {
  const std::string measured = table.note("measured");
  if (measured.empty()) {
    return fmt::format(
        "Mean over realizations (points; bars are standard errors pooled over "
        "taps) and the fitted laws, taps {}.",
        range);
  }
  if (measured == "realizations") {
    return fmt::format(
        "Mean over {} realizations (points; bars are pooled standard errors) and the "
        "fitted laws, t {}.",
        table.note("realizations"), range);
  }
  return fmt::format("Measured values (points{}) and the fitted laws, t {}.",
                     measured == "errors" ? "; bars are the errors given" : "", range);
}

FigurePanel data_panel(const std::vector<TableView>& laws, const std::string& observable) {
  const TableView& first = laws.front();
  std::string range = first.note("range");
  std::ranges::replace(range, ':', '-');
  FigurePanel panel{
      .title = "Fits of " + words(observable),
      .caption = data_caption(first, range),
      .x = t_axis(first),
      .y = {axis_label(observable, "")},
      .series = {{.name = "data",
                  .colour = "#222222",
                  .drawn = Drawn::points,
                  .rows = rows_of(first.axis("t"), first.values("x"), first.values("x_error"))}}};
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
  FigurePanel panel{
      .title = "Residuals of " + words(observable),
      .caption = scaled ? "Data less law, in standard errors of the mean." : "Data less law.",
      .x = t_axis(laws.front()),
      .y = {scaled ? "residual / error" : "residual"},
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

void add_fits(const DrawnFile& file, Figures& into) {
  std::vector<TableView> made;
  for (const TableView& table : file.made_of("fits")) {
    if (table.has("fitted")) made.push_back(table);
  }
  for (const std::uint32_t point : points_of(file, made)) {
    std::vector<std::string> observables;
    std::map<std::string, std::vector<TableView>> laws;
    for (const TableView& table : made) {
      if (table.point() != point) continue;
      const std::string& observable = table.path().front();
      if (!laws.contains(observable)) observables.push_back(observable);
      const bool known = std::ranges::any_of(laws[observable], [&](const TableView& law) {
        return law.note("restated_model") == table.path().back();  // the same curve
      });
      if (known) continue;
      laws[observable].push_back(table);
    }
    for (const std::string& observable : observables) {
      add_panel(file, point, data_panel(laws[observable], observable), into);
      into.back().panels.push_back(residual_panel(laws[observable], observable));
    }
  }
}

}  // namespace jostle::inline study
