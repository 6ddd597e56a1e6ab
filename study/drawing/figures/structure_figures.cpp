#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "study/drawing/drawn/thinning.hpp"
#include "study/drawing/figures/builders.hpp"

namespace jostle::inline study {
namespace {

constexpr std::size_t most_taps = 6;  // in one figure

enum class Over { the_axis, its_cube };

/// A curve of a part at several taps: what is drawn, over what, on which axes.
struct PartPlot {
  const char *y, *x, *title, *x_label, *y_label;
  AxisKind y_kind = AxisKind::linear;
  bool from_zero = false;
  Drawn drawn = Drawn::line;
  AxisKind x_kind = AxisKind::linear;
  Over over = Over::the_axis;
  const char* beside = nullptr;  // another curve of the same table
  const char* beside_name = "";
  std::optional<double> rule{};
  bool pooled = false;  // a ratio of sums over packings
};

/// Numbers of a packing against the tap, in one figure.
struct Trend {
  std::vector<const char*> names;
};

struct Part {
  const char* name;
  std::vector<PartPlot> plots;
  std::vector<Trend> trends;  // the first two that there are
};

constexpr auto logarithmic = AxisKind::logarithmic, linear = AxisKind::linear;

const std::vector<Part>& parts() {
  static const std::vector<Part> all{
      {"profile",
       {{"phi", "height", "Packing fraction by height", "height z (diameters)",
         "packing fraction Φ(z)"},
        {"phi_smoothed", "height", "Packing fraction by height, smoothed", "height z (diameters)",
         "packing fraction Φ(z), smoothed"}},
       {{{"alpha"}},
        {{"phi_region"}},
        {{"eq7_phi_0"}},
        {{"eq7_alpha"}},
        {{"eq7_beta"}},
        {{"eq7_z_star"}}}},
      {"sides",
       {{"phi_xy", "x", "Packing fraction across the bed", "x and y (diameters)",
         "packing fraction Φ"},
        {"phi_wall", "wall_distance", "Packing fraction by distance from the walls",
         "distance from the nearest wall (diameters)", "packing fraction Φ"},
        {"phi_radial", "radius", "Packing fraction by distance from the axis",
         "distance from the axis (diameters)", "packing fraction Φ"}},
       {{{"lateral"}}, {{"lateral_change"}}, {{"central"}}, {{"central_change"}}}},
      {"layers",
       {{"n", "height", "Centres by height, n(z)", "height z (diameters)",
         "fraction of centres in a bin", linear, true},
        {"share", "layer_height", "How sharp the layers are", "height of the hcp layer (diameters)",
         "share of the layer's centres in place", linear, true, Drawn::joined_points},
        {"filling", "layer_height", "How full the layers are",
         "height of the hcp layer (diameters)", "filling of the layer", linear, true,
         Drawn::joined_points}},
       {{{"grown_layers"}}}},
      {"coordination",
       {{"neighbour_share", "neighbours", "Number of neighbours", "neighbours within the cut",
         "share of spheres", linear, true, Drawn::joined_points},
        {"n_c_of_cut", "cut", "Coordination by cut", "cut (diameters)", "mean coordination N_c"}},
       {{{"n_c"}}, {{"n_c_all"}}, {{"normal_mean"}}, {{"normal_width"}}}},
      {"pair_correlation",
       {{.y = "g",
         .x = "r",
         .title = "Pair correlation g(r)",
         .x_label = "distance r (diameters)",
         .y_label = "g(r)",
         .from_zero = true,
         .rule = 1,
         .pooled = true}},
       {}},
      {"order",
       {{"q6_at_height", "height", "Bond order by height", "height z (diameters)", "mean q_6"},
        {"fcc_at_height", "height", "Fcc surroundings by height", "height z (diameters)",
         "share of spheres", linear, true},
        {"hcp_at_height", "height", "Hcp surroundings by height", "height z (diameters)",
         "share of spheres", linear, true}},
       {{{"fcc", "hcp"}}, {{"q6"}}}},
      {"voronoi",
       {{"free_volume_density", "free_volume", "Free volumes", "free volume (sphere volumes)",
         "probability density", logarithmic, false, Drawn::points},
        {"local_fraction_density", "local_fraction", "Local packing fractions",
         "sphere volume / cell volume", "probability density"},
        {"face_share", "faces", "Faces of the cells", "faces", "share of cells", linear, true,
         Drawn::joined_points}},
       {{{"mean_faces"}},
        {{"mean_free_volume"}},
        {{"mean_local_fraction"}},
        {{"k"}},
        {{"k_gamma_k"}}}},
      {"pores",
       {{"rho_v", "xi", "Pores by volume", "pore volume v = ξ³ (sphere volumes)", "ρ_v",
         logarithmic, false, Drawn::points, linear, Over::its_cube},
        {"rho_xi", "xi", "Pores by radius", "pore radius ξ = r/R", "ρ(ξ)", linear, true},
        {"v_rho_v", "xi", "Pores by logarithm of volume", "pore volume v = ξ³ (sphere volumes)",
         "v ρ_v", linear, true, Drawn::line, logarithmic, Over::its_cube}},
       {{{"n_pores"}},
        {{"nu"}},
        {{"tetrahedral"}},
        {{"octahedral"}},
        {{"mean_touched"}},
        {{"tail_v0"}}}},
      {"void_probability",
       {{.y = "p0",
         .x = "sigma",
         .title = "Void probability",
         .x_label = "radius of the random sphere (R)",
         .y_label = "P_0",
         .y_kind = logarithmic,
         .beside = "p0_gotoh",
         .beside_name = "Gotoh, Percus-Yevick fluid"}},
       {{{"phi"}}}},
      {"holes", {}, {{{"unclassified"}}}},
      {"gaps",
       {{"z_of_gap", "gap", "Contacts by gap", "gap that counts as a contact (diameters)",
         "mean number of contacts", linear, false, Drawn::joined_points, logarithmic},
        {"rattlers_of_gap", "gap", "Rattlers by gap", "gap that counts as a contact (diameters)",
         "share of rattlers", linear, true, Drawn::joined_points, logarithmic}},
       {{{"contacts", "backbone_contacts"}}, {{"rattlers"}}}},
      {"structure_factor",
       {{"s", "k", "Structure factor S(k)", "wave number k (1/diameters)", "S(k)", logarithmic,
         false, Drawn::joined_points}},
       {{{"s_0_of_line", "s_0_of_squares"}}}},
      {"clusters",
       {{"relative_variance", "cells", "Variance of clusters of cells", "cells of a cluster",
         "variance a cell over that of single cells", logarithmic, false, Drawn::joined_points,
         logarithmic},
        {"chi", "cells", "Compactivity of clusters of cells", "cells of a cluster",
         "χ (sphere volumes)", linear, false, Drawn::joined_points, logarithmic}},
       {{{"mean_volume"}}}}};
  return all;
}

std::vector<std::size_t> tap_places(const TableView& table) {
  return evenly_spread(table.axis("tap").size(), most_taps);
}

std::vector<FigureRow> rows_at(const TableView& table, const PartPlot& plot,
                               const std::string& quantity, bool with_errors, std::size_t place) {
  std::vector<double> xs = table.axis(plot.x);
  if (plot.over == Over::its_cube) {
    for (double& x : xs) x = x * x * x;
  }
  std::vector<FigureRow> rows =
      rows_of(xs, table.row(quantity, place),
              with_errors ? table.half_width_row(quantity, place) : std::vector<double>{});
  std::erase_if(rows, [&](const FigureRow& row) {
    return !std::isfinite(row.y) || (plot.y_kind == logarithmic && row.y <= 0);
  });
  return rows;
}

void add_plot(const DrawnFile& file, const TableView& table, const PartPlot& plot, Figures& into) {
  if (!table.has(plot.y) || !table.has_axis(plot.x)) return;
  const std::vector<std::size_t> places = tap_places(table);
  const std::vector<double> taps = table.axis("tap");
  FigurePanel panel{
      .title = plot.title,
      .caption = sentence(table.long_name(plot.y)) +
                 (plot.pooled ? "; over all realizations, at some of the kept taps, with 68 % "
                                "intervals by the jackknife."
                              : "; means over realizations at some of the kept taps, with 68 % "
                                "intervals."),
      .source = table.source(plot.y),
      .x = {plot.x_label, plot.x_kind},
      .y = {plot.y_label, plot.y_kind, plot.from_zero}};
  if (plot.rule) panel.rules.push_back({.y = plot.rule});
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
  for (std::size_t k = 0; plot.beside != nullptr && table.has(plot.beside) && k < places.size();
       ++k) {
    panel.series.push_back({.name = k == 0 ? plot.beside_name : "",
                            .colour = colour_of(k, places.size()),
                            .rows = rows_at(table, plot, plot.beside, false, places[k]),
                            .dash = 1,
                            .has_band = false});
  }
  add_panel(file, table.point(), std::move(panel), into);
}

/// How the field writes it.
std::string symbol_of(const std::string& name) {
  static const std::map<std::string, std::string> symbols{
      {"alpha", "α"},
      {"phi_region", "packing fraction Φ"},
      {"n_c", "mean coordination N_c"},
      {"q6", "q_6"},
      {"n_c_all", "mean coordination N_c, all spheres"},
      {"nu", "ν"},
      {"n_pores", "number of pores"},
      {"phi", "packing fraction Φ"}};
  const auto found = symbols.find(name);
  return found == symbols.end() ? words(name) : found->second;
}

void add_trends(const DrawnFile& file, const TableView& table, const Part& part, Figures& into) {
  constexpr std::size_t fewest_taps = 3, most_trends = 2;
  const std::vector<double> taps = table.axis("tap");
  if (taps.size() < fewest_taps) return;
  std::size_t n_drawn = 0;
  for (const Trend& trend : part.trends) {
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
        panel.y.label = symbol_of(name);
        title = words(name);
        panel.caption = sentence(table.long_name(name));
      } else {
        panel.y.label += ", " + symbol_of(name);
        title += " and " + words(name);
        panel.caption += "; " + sentence(table.long_name(name));
      }
      panel.series.push_back({.name = words(name),
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
    add_panel(file, table.point(), std::move(panel), into);
  }
}

void add_holes(const DrawnFile& file, const TableView& table, const std::string& quantity,
               const std::string& title, Figures& into) {
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
      .y = {"share", linear, true}};
  for (const std::string& name : names) panel.x.names.push_back(words(name));
  const auto row_at = [&](std::size_t j, double shift, const std::vector<double>& values,
                          const std::vector<double>& errors) {
    return FigureRow{.x = static_cast<double>(j) + shift,
                     .y = j < values.size() ? values[j] : no_value,
                     .error = j < errors.size() ? errors[j] : no_value,
                     .label = words(names[j])};
  };
  for (std::size_t k = 0; k < places.size(); ++k) {
    FigureSeries one{.name = fmt::format("tap {}", taps[places[k]]),
                     .colour = colour_of(k, places.size()),
                     .drawn = Drawn::points,
                     .symbol = k};
    const double shift =
        (static_cast<double>(k) - static_cast<double>(places.size() - 1) / 2) * 0.09;
    for (std::size_t j = 0; j < names.size(); ++j) {
      one.rows.push_back(row_at(j, shift, table.row(quantity, places[k]),
                                table.half_width_row(quantity, places[k])));
    }
    panel.series.push_back(std::move(one));
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
  add_panel(file, table.point(), std::move(panel), into);
}

}  // namespace

void add_structure(const DrawnFile& file, Figures& into) {
  for (const Part& part : parts()) {
    const std::vector<TableView> made = file.made_of("structure", part.name);
    for (const std::uint32_t point : points_of(file, made)) {
      const std::size_t n_before = into.size();
      const auto own = std::ranges::find_if(
          made, [&](const TableView& table) { return table.point() == point; });
      if (own == made.end()) continue;
      if (std::string_view(part.name) == "holes") {
        add_holes(file, *own, "number_fraction", "Holes by number", into);
        add_holes(file, *own, "volume_fraction", "Holes by volume", into);
      }
      for (const PartPlot& plot : part.plots) add_plot(file, *own, plot, into);
      add_trends(file, *own, part, into);
      for (std::size_t i = n_before; i < into.size(); ++i) into[i].section = part.name;
    }
  }
}

}  // namespace jostle::inline study
