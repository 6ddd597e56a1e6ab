#include "study/drawing/figures/structure_parts.hpp"

#include <algorithm>
#include <cmath>

#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline study {
namespace {

constexpr auto logarithmic = AxisKind::logarithmic, linear = AxisKind::linear;

/// True for a row between two places, both included.
bool is_within(const FigureRow& row, double first, double last) {
  return row.x >= first && row.x <= last;
}

/// Leaves out the places below the first and above the last value that is not 0, but for one on
/// either side.
void trim(FigurePanel& panel) {
  std::vector<double> zero, counterpart;
  for (const FigureSeries& series : panel.series) {
    for (const FigureRow& row : series.rows) (row.y == 0 ? zero : counterpart).push_back(row.x);
  }
  if (counterpart.empty()) return;
  double first = std::ranges::min(counterpart), last = std::ranges::max(counterpart);
  const double lowest = first, highest = last;
  for (const double x : zero) {
    if (x < lowest && (first == lowest || x > first)) first = x;
    if (x > highest && (last == highest || x < last)) last = x;
  }
  for (FigureSeries& series : panel.series) {
    std::erase_if(series.rows, [&](const FigureRow& row) { return !is_within(row, first, last); });
  }
}

/// Ends the axis above what lies beyond the peak, where the peak is much higher.
void clip_peak(double peak_end, FigurePanel& panel) {
  constexpr double ratio = 2, room = 1.4;
  double peak = 0, rest = 0;
  for (const FigureSeries& series : panel.series) {
    for (const FigureRow& row : series.rows) {
      double& greatest = row.x < peak_end ? peak : rest;
      greatest = std::max(greatest, row.y);
    }
  }
  if (!(rest > 0) || !(peak > ratio * rest)) return;
  panel.y.high = std::ceil(room * rest * 10) / 10;
  panel.caption += finite_text(" The peak at contact is clipped: it reaches {:.3g}.", peak);
}

}  // namespace

const std::vector<DrawnPart>& drawn_parts() {
  static const std::vector<DrawnPart> all{
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
         .pooled = true,
         .x_low = 0.9,
         .clipped_before = 1.2}},
       {}},
      {"order",
       {{"q6_at_height", "height", "Bond order by height", "height z (diameters)", "mean q_6"},
        {"fcc_at_height", "height", "Spheres with fcc order, by height", "height z (diameters)",
         "share of spheres", linear, true},
        {"hcp_at_height", "height", "Spheres with hcp order, by height", "height z (diameters)",
         "share of spheres", linear, true}},
       {{{"fcc", "hcp"}}, {{"q6"}}}},
      {"voronoi",
       {{"free_volume_density", "free_volume", "Free volumes", "free volume (sphere volumes)",
         "probability density", logarithmic, false, Drawn::points},
        {.y = "local_fraction_density",
         .x = "local_fraction",
         .title = "Local packing fractions",
         .x_label = "sphere volume / cell volume",
         .y_label = "probability density",
         .from_zero = true,
         .trimmed = true},
        {.y = "face_share",
         .x = "faces",
         .title = "Faces of the cells",
         .x_label = "faces",
         .y_label = "share of cells",
         .from_zero = true,
         .drawn = Drawn::joined_points,
         .trimmed = true}},
       {{{"mean_faces"}},
        {{"mean_free_volume"}},
        {{"mean_local_fraction"}},
        {{"k"}},
        {{"k_gamma_k"}}}},
      {"pores",
       {{"rho_v", "xi", "Pores by volume", "pore volume v = ξ³ (sphere volumes)", "ρ_v",
         logarithmic, false, Drawn::points, linear, Over::its_cube},
        {.y = "rho_xi",
         .x = "xi",
         .title = "Pores by radius",
         .x_label = "pore radius ξ = r/R",
         .y_label = "ρ(ξ)",
         .from_zero = true,
         .trimmed = true},
        {.y = "v_rho_v",
         .x = "xi",
         .title = "Pores by logarithm of volume",
         .x_label = "pore volume v = ξ³ (sphere volumes)",
         .y_label = "v ρ_v",
         .from_zero = true,
         .x_kind = logarithmic,
         .abscissa = Over::its_cube,
         .trimmed = true}},
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
         .companion = "p0_gotoh",
         .beside_name = "Gotoh, Percus-Yevick fluid"}},
       {{{"phi"}}}},
      {"holes", {}, {{{"unclassified"}}}},
      {"gaps",
       {{"z_of_gap", "gap", "Contacts by gap", "gap that counts as a contact (diameters)",
         "mean number of contacts", linear, false, Drawn::joined_points, logarithmic},
        {"rattlers_of_gap", "gap", "Rattlers by gap", "gap that counts as a contact (diameters)",
         "share of rattlers in packings with a backbone", linear, true, Drawn::joined_points,
         logarithmic}},
       {{{"contacts", "backbone_contacts"}}, {{"rattlers"}}}},
      {"structure_factor",
       {{"s", "k", "Structure factor S(k)", "wave number k (1/diameters)", "S(k)", logarithmic,
         false, Drawn::joined_points}},
       {{{"s_0_of_line", "s_0_of_squares"}}}},
      {"clusters",
       {{"relative_variance", "cells", "Volume variance of clusters of cells, per cell",
         "cells of a cluster", "variance per cell / variance of single cells", logarithmic, false,
         Drawn::joined_points, logarithmic},
        {"chi", "cells", "Compactivity of clusters of cells", "cells of a cluster",
         "χ (sphere volumes)", linear, false, Drawn::joined_points, logarithmic}},
       {{{"mean_volume"}}}}};
  return all;
}

std::vector<FigureRow> rows_at(const TableView& table, const PartPlot& plot,
                               const std::string& quantity, bool with_errors, std::size_t place) {
  std::vector<double> xs = table.axis(plot.x);
  if (plot.abscissa == Over::its_cube) {
    for (double& x : xs) x = x * x * x;
  }
  std::vector<FigureRow> rows =
      rows_of(xs, table.row(quantity, place),
              with_errors ? table.half_width_row(quantity, place) : std::vector<double>{});
  std::erase_if(rows, [&](const FigureRow& row) {
    return !std::isfinite(row.y) || (plot.y_kind == logarithmic && row.y <= 0) ||
           (plot.x_low && row.x < *plot.x_low);
  });
  return rows;
}

namespace {

/// The label of the axis; of a mixture, whose distances are relative to the sum of two radii, with
/// that unit.
std::string x_label_of(const TableView& table, const PartPlot& plot) {
  constexpr std::string_view diameters = "(diameters)", sum_of_radii = "sum of radii";
  std::string label = plot.x_label;
  const std::size_t unit = label.find(diameters);
  if (unit != std::string::npos && table.units(plot.x) == sum_of_radii)
    label.replace(unit, diameters.size(), "(sum of the two radii)");
  return label;
}

}  // namespace

FigurePanel panel_of(const TableView& table, const PartPlot& plot) {
  FigurePanel panel{.title = plot.title,
                    .source = table.source(plot.y),
                    .x = {x_label_of(table, plot), plot.x_kind},
                    .y = {plot.y_label, plot.y_kind, plot.from_zero}};
  panel.x.low = plot.x_low;
  if (plot.rule) panel.rules.push_back({.y = plot.rule});
  return panel;
}

void finish_panel(const PartPlot& plot, FigurePanel& panel) {
  if (plot.trimmed) trim(panel);
  if (plot.clipped_before) clip_peak(*plot.clipped_before, panel);
}

}  // namespace jostle::inline study
