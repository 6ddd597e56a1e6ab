#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "ensemble/statistics/finite_text.hpp"
#include "study/drawing/figures/builders.hpp"

namespace jostle::inline study {
namespace {

/// One table of a point, as "displacement".
std::optional<TableView> table_of(const std::vector<TableView>& made, std::uint32_t point,
                                  const std::string& name) {
  for (const TableView& table : made) {
    if (table.point() == point && table.path().back() == name) return table;
  }
  return std::nullopt;
}

/// Values along waiting time, lag and, of n places, a third axis.
class ByLag {
 public:
  ByLag(const TableView& table, const std::string& quantity, std::size_t n)
      : ByLag(table, table.values(quantity), n) {}
  ByLag(const TableView& table, std::vector<double> values, std::size_t n)
      : values_(std::move(values)), n_lags_(table.axis("lag").size()), n_(n) {}
  double operator()(std::size_t k, std::size_t j, std::size_t place = 0) const {
    return value_at(values_, (k * n_lags_ + j) * n_ + place);
  }

 private:
  std::vector<double> values_;
  std::size_t n_lags_, n_;
};

FigurePanel squares(const TableView& table, const std::string& name, const std::string& title,
                    const std::string& ordinate) {
  const ByLag square(table, name, 1), error(table, table.half_widths(name), 1);
  return {.title = title,
          .caption = ordinate +
                     " in a lag t from the waiting time t_W on, mean over spheres and "
                     "realizations; bars are 68 % intervals.",
          .source = table.source(name),
          .x = {"lag t (taps)", AxisKind::logarithmic},
          .y = {"mean square" + unit_text(table.units(name)), AxisKind::logarithmic},
          .series = by_waiting_time(table, [&](std::size_t k, std::size_t j, double lag) {
            return FigureRow{.x = lag, .y = square(k, j), .error = error(k, j)};
          })};
}

/// At the longest lag that every waiting time has.
FigurePanel by_height(const TableView& table) {
  const std::string name = "msd_lateral";
  const std::vector<double> ages = table.axis("waiting_time"), lags = table.axis("lag");
  const std::size_t n = table.axis("layer").size();
  const ByLag height(table, "height", n), square(table, name, n),
      error(table, table.half_widths(name), n);
  const auto has_all = [&](std::size_t j) {
    for (std::size_t k = 0; k < ages.size(); ++k) {
      if (!std::isfinite(square(k, j))) return false;
    }
    return true;
  };
  std::size_t longest = lags.size();
  while (longest > 0 && !has_all(longest - 1)) --longest;
  if (longest == 0) return {};
  --longest;
  FigurePanel panel{
      .title = "Lateral motion by height",
      .caption = fmt::format("Mean square of the lateral displacement in {} taps, of layers of as "
                             "many spheres each, against their mean height; bars are 68 % "
                             "intervals.",
                             lags[longest]),
      .source = table.source(name),
      .x = {"height (diameter)"},
      .y = {"mean square" + unit_text(table.units(name)), AxisKind::logarithmic}};
  for (std::size_t k = 0; k < ages.size(); ++k) {
    FigureSeries series{.name = fmt::format("t_W = {}", ages[k]),
                        .colour = colour_of(k, ages.size()),
                        .drawn = Drawn::joined_points,
                        .symbol = k};
    for (std::size_t layer = 0; layer < n; ++layer)
      series.rows.push_back({.x = height(k, longest, layer),
                             .y = square(k, longest, layer),
                             .error = error(k, longest, layer)});
    panel.series.push_back(std::move(series));
  }
  return panel;
}

/// A curve of every kind, from the first waiting time on.
FigurePanel by_kind(const TableView& table, const std::string& name, const std::string& title,
                    const std::string& ordinate, const FigureAxis& y) {
  const std::vector<std::string> kinds = table.axis_texts("kind");
  const std::vector<double> ages = table.axis("waiting_time"), lags = table.axis("lag");
  const ByLag value(table, name, kinds.size()), error(table, table.half_widths(name), kinds.size());
  FigurePanel panel{.title = title,
                    .caption = fmt::format("{} in a lag t from tap {} on, of each kind, mean over "
                                           "realizations; bars are 68 % intervals.",
                                           ordinate, ages.front()),
                    .source = table.source(name),
                    .x = {"lag t (taps)", AxisKind::logarithmic},
                    .y = {y.label + unit_text(table.units(name)), y.kind}};
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    FigureSeries series{.name = kinds[kind],
                        .colour = kind_colour(kind),
                        .drawn = Drawn::joined_points,
                        .symbol = kind};
    for (std::size_t j = 0; j < lags.size(); ++j) {
      if (std::isfinite(value(0, j, kind)))
        series.rows.push_back({.x = lags[j], .y = value(0, j, kind), .error = error(0, j, kind)});
    }
    if (!series.rows.empty()) panel.series.push_back(std::move(series));
  }
  return panel;
}

void add_kinds(const DrawnFile& file, std::uint32_t point, const TableView& table,
               Figures& figures) {
  add_panel(file, point,
            by_kind(table, "rise", "Rise of the kinds in the bed",
                    "Mean vertical displacement less that of all spheres", {"rise"}),
            figures);
  add_panel(
      file, point,
      by_kind(table, "msd_lateral", "Lateral motion of the kinds",
              "Mean square of the lateral displacement", {"mean square", AxisKind::logarithmic}),
      figures);
}

/// At the overlap length where the susceptibility is greatest.
FigurePanel susceptibility(const TableView& table) {
  const std::string name = "lateral_chi_4";
  const std::vector<double> lengths = table.axis("overlap_length"), values = table.values(name);
  const std::size_t n = lengths.size();
  std::optional<std::size_t> greatest;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i]) && !(greatest && values[i] <= values[*greatest])) greatest = i;
  }
  if (!greatest || n == 0) return {};
  const std::size_t place = *greatest % n;
  const ByLag chi(table, name, n), low(table, name + "_low_68", n),
      high(table, name + "_high_68", n);
  return {
      .title = "Spheres that move together",
      .caption = finite_text(
          "χ_4, the variance over realizations of the share of spheres that moved sideways by "
          "less than {:.4g} d, times their number, at the overlap length where it is greatest, a "
          "choice that biases it upwards; bars are 68 % intervals, left out where few spheres have "
          "moved.",
          lengths[place]),
      .source = table.source(name),
      .x = {"lag t (taps)", AxisKind::logarithmic},
      .y = {"χ_4"},
      .series = by_waiting_time(table, [&](std::size_t k, std::size_t j, double lag) {
        return FigureRow{
            .x = lag, .y = chi(k, j, place), .low = low(k, j, place), .high = high(k, j, place)};
      })};
}

}  // namespace

void add_motion(const DrawnFile& file, Figures& figures) {
  const std::vector<TableView> made = file.made_of("analysis", "motion");
  for (const std::uint32_t point : points_of(file, made)) {
    if (const auto table = table_of(made, point, "displacement")) {
      add_panel(
          file, point,
          squares(*table, "msd_lateral", "Lateral motion", "Square of the lateral displacement"),
          figures);
      add_panel(file, point,
                squares(*table, "msd_z_about_mean", "Vertical motion about the settling",
                        "Square of the vertical displacement less its mean over the bed,"),
                figures);
    }
    if (const auto table = table_of(made, point, "layers"))
      add_panel(file, point, by_height(*table), figures);
    if (const auto table = table_of(made, point, "kinds")) add_kinds(file, point, *table, figures);
    if (const auto table = table_of(made, point, "overlap"))
      add_panel(file, point, susceptibility(*table), figures);
  }
}

}  // namespace jostle::inline study
