#include <algorithm>
#include <cmath>

#include "engine/bed/boundary.hpp"
#include "engine/bed/slab.hpp"
#include "engine/numbers.hpp"
#include "structure/density/gradient.hpp"
#include "structure/density/profile_parts.hpp"
#include "structure/density/profiles.hpp"
#include "structure/measure_parts.hpp"
#include "structure/snapshot_statistics.hpp"

namespace jostle::inline structure {

namespace {

std::vector<double> middles(const Profile& profile) {
  std::vector<double> places;
  for (std::size_t k = 0; k < profile.size(); ++k) places.push_back(profile.middle(k));
  return places;
}

Places heights(std::vector<double> values) {
  return {"height", std::move(values), "diameter", "height above the floor, middle of a bin"};
}

/// A quantity at the middles of a profile's bins.
void add_profile(const char* places, const Profile& profile, const char* name,
                 const char* long_name, const char* source, Measurement& measurement) {
  measurement.quantities.push_back({.name = name,
                                    .places = places,
                                    .values = profile.values,
                                    .long_name = long_name,
                                    .source = source});
}

void add_along(Axis axis, const Packing& packing, HeightWindow window, double bin_width,
               Measurement& measurement) {
  const bool x = axis == Axis::x;
  const char* const places = x ? "x" : "y";
  const double width = x ? width_x(packing.container) : width_y(packing.container);
  const Profile profile =
      transverse_profile(packing, axis, even_edges(0, width, bin_width), window);
  measurement.places.push_back({places, middles(profile), "diameter", "middle of a bin"});
  add_profile(places, profile, x ? "phi_x" : "phi_y",
              "packing fraction of slabs parallel to a side", "Philippe & Bideau 2001, fig. 7",
              measurement);
  measurement.quantities.push_back(
      {.name = x ? "phi_x_cut" : "phi_y_cut",
       .places = places,
       .values = transverse_cuts(packing, axis, middles(profile), window),
       .long_name = "area fraction of plane cuts parallel to a side"});
}

/// Where x and y are alike.
void add_mean_of_axes(const Packing& packing, Measurement& measurement) {
  const Boundary boundary(packing.container);
  if (boundary.width_x != boundary.width_y || boundary.periodic_x != boundary.periodic_y) return;
  std::vector<double> mean = measurement.find("phi_x")->values;
  const std::vector<double>& second_profile = measurement.find("phi_y")->values;
  for (std::size_t k = 0; k < mean.size(); ++k) mean[k] = 0.5 * (mean[k] + second_profile[k]);
  measurement.quantities.push_back(
      {.name = "phi_xy",
       .places = "x",
       .values = std::move(mean),
       .long_name = "mean of the packing fractions of slabs parallel to both sides",
       .source = "Philippe & Bideau 2001, fig. 7"});
}

void add_from_walls(const Packing& packing, HeightWindow window, const SidesSettings& settings,
                    Measurement& measurement) {
  const Boundary boundary(packing.container);
  if (!boundary.has_walls()) return;
  constexpr double endless = std::numeric_limits<double>::infinity();
  const double wall_distance = std::min(boundary.periodic_x ? endless : boundary.width_x,
                                        boundary.periodic_y ? endless : boundary.width_y);
  if (!boundary.tube) {
    const double half = 0.5 * wall_distance;
    const Profile walls = wall_profile(packing, even_edges(0, half, settings.bin_width), window);
    measurement.places.push_back(
        {"wall_distance", middles(walls), "diameter", "distance to the nearest wall"});
    add_profile("wall_distance", walls, "phi_wall", "packing fraction against the nearest wall",
                "Philippe & Bideau 2001, fig. 7", measurement);
  } else {
    const Profile rings =
        radial_profile(packing, even_edges(0, boundary.axis(), settings.bin_width), window);
    measurement.places.push_back({"radius", middles(rings), "diameter", "distance from the axis"});
    add_profile("radius", rings, "phi_radial", "packing fraction of rings around the axis", "",
                measurement);
  }
  if (wall_distance <= 2 * settings.reach) {
    measurement.notes.emplace_back("lateral", "the walls are less than twice the reach apart");
    return;
  }
  const LateralCentral fractions = lateral_and_central(packing, window, settings.reach);
  measurement.quantities.push_back({.name = "lateral",
                                    .values = {fractions.lateral},
                                    .long_name = "packing fraction of the profile near its walls",
                                    .source = "Philippe & Bideau 2001, fig. 8",
                                    .with_change = true});
  measurement.quantities.push_back({.name = "central",
                                    .values = {fractions.central},
                                    .long_name = "packing fraction of the middle of the profile",
                                    .source = "Philippe & Bideau 2001, fig. 8",
                                    .with_change = true});
}

}  // namespace

Measurement measure_part(MeasuredPacking& measured, const ProfileSettings& settings) {
  require_floor(measured.packing);
  require_height_bins(measured.packing, settings.bin_width);
  // Smoothing carries matter up to half its length above the surface.
  std::vector<double> edges = height_edges(measured.packing, settings.bin_width);
  const double top = edges.back() + 0.5 * settings.smoothing;
  while (edges.back() < top - 1e-9)
    edges.push_back(static_cast<double>(edges.size()) * settings.bin_width);
  const Profile vertical = vertical_profile(measured.packing, edges);
  GradientRange range = gradient_range(measured.packing.container);
  if (settings.gradient) {
    range.low = settings.gradient->low;
    range.high = settings.gradient->high;
  }
  range.smoothing = settings.smoothing;
  Measurement measurement;
  measurement.places = {heights(middles(vertical))};
  add_profile("height", vertical, "phi", "packing fraction of slabs",
              "Philippe & Bideau 2001, sec. IV", measurement);
  add_profile("height", settings.smoothing > 0 ? smoothed(vertical, settings.smoothing) : vertical,
              "phi_smoothed", "packing fraction of slabs, after a boxcar mean",
              "Philippe & Bideau 2001, fig. 6", measurement);
  measurement.quantities.push_back(
      {.name = "phi_cut",
       .places = "height",
       .values = vertical_cuts(measured.packing, middles(vertical)),
       .long_name = "area fraction of plane cuts at the middles of bins",
       .source = "Philippe & Bideau 2001, sec. IV"});
  const Gradient found = gradient(vertical, range);
  measurement.quantities.push_back({.name = "alpha",
                                    .values = {found.alpha},
                                    .units = "1/R",
                                    .long_name = "minus the slope of the smoothed profile",
                                    .source = "Philippe & Bideau 2001, fig. 8"});
  measurement.quantities.push_back(
      {.name = "alpha_line_error",
       .values = {found.error},
       .units = "1/R",
       .long_name = "standard error of alpha of one packing, from the scatter about the line",
       .with_error = false});
  if (!found.reason.empty()) measurement.notes.emplace_back("alpha", found.reason);
  if (measured.region.high > measured.region.low) {
    measurement.quantities.push_back(
        {.name = "phi_region",
         .values = {fraction_of(measured.packing, measured.region)},
         .long_name = "packing fraction between the heights of the region"});
  }
  return measurement;
}

Measurement measure_part(MeasuredPacking& measured, const SidesSettings& settings) {
  require_floor(measured.packing);
  const HeightWindow window = settings.heights.value_or(transverse_window(measured.packing));
  Measurement measurement;
  if (!Boundary(measured.packing.container).tube) {
    add_along(Axis::x, measured.packing, window, settings.bin_width, measurement);
    add_along(Axis::y, measured.packing, window, settings.bin_width, measurement);
    add_mean_of_axes(measured.packing, measurement);
  }
  add_from_walls(measured.packing, window, settings, measurement);
  return measurement;
}

Measurement measure_part(MeasuredPacking& measured, const LayersSettings& settings) {
  require_floor(measured.packing);
  require_height_bins(measured.packing, settings.bin_width);
  const std::vector<Layer> found = layers(measured.packing, settings.rule.tolerance);
  const std::vector<double> n = height_histogram(measured.packing, settings.bin_width);
  std::vector<double> tops, layer_heights, filling, share;
  for (const Layer& layer : found) {
    tops.push_back(layer.height);
    layer_heights.push_back(layer.found);
    filling.push_back(layer.filling);
    share.push_back(layer.filling > 0 ? layer.share : not_a_number);
  }
  Measurement measurement;
  measurement.places = {heights(middles_of_bins(n.size(), settings.bin_width)),
                        {"layer_height", tops, "diameter", "hcp layers, 1/2 + k sqrt(2/3)"}};
  measurement.quantities = {
      {.name = "n",
       .places = "height",
       .values = n,
       .long_name = "fraction of all centres per bin",
       .source = "Rosato et al. 2010, fig. 6"},
      {.name = "found_height",
       .places = "layer_height",
       .values = layer_heights,
       .units = "diameter",
       .long_name =
           "mean height of the centres within 0.3 of the place that the layer below points to",
       .beyond = not_a_number},
      {.name = "filling",
       .places = "layer_height",
       .values = filling,
       .long_name = "centres between the mid-planes of found heights over those of a full layer"},
      {.name = "share",
       .places = "layer_height",
       .values = share,
       .long_name = "part of them within the tolerance of the found height",
       .beyond = not_a_number},
      {.name = "grown_layers",
       .values = {static_cast<double>(grown_layers(measured.packing, settings.rule))},
       .long_name = "ordered layers from the floor up to the first that is not"}};
  return measurement;
}

}  // namespace jostle::inline structure
