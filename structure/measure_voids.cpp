#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/bed/boundary.hpp"
#include "engine/numbers.hpp"
#include "structure/measure_parts.hpp"
#include "structure/voids/pores.hpp"

namespace jostle::inline structure {

namespace {

double mean_of(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double deviation_of(std::span<const double> values, double mean) {
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// A density over bins of a width that begin at 0; values beyond the last are left out.
std::vector<double> density(std::span<const double> values, double bin_width, std::size_t n_bins) {
  std::vector<double> bins(n_bins, 0.0);
  const double weight = 1 / (static_cast<double>(values.size()) * bin_width);
  for (const double value : values) {
    const auto k = static_cast<std::size_t>(value / bin_width);
    if (k < n_bins) bins[k] += weight;
  }
  return bins;
}

double volume_of(const Container& container, double height) {
  const Boundary boundary(container);
  return footprint_area(container) * (boundary.periodic_z ? boundary.height : height);
}

/// Measurements of the cells of a region.
struct InnerCells {
  std::vector<std::uint64_t> face_counts;
  std::vector<double> faces, volumes, free_volumes, fractions;
  std::vector<std::size_t> spheres;  // whose cells these are
};

InnerCells inner_cells(MeasuredPacking& measured, const VoronoiSettings& settings) {
  const VoronoiCells& cells = measured.voronoi();
  const std::vector<double> fractions = local_fractions(cells), free = free_volumes(cells);
  InnerCells inner;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    if ((cells.cut[i] != 0 && !settings.cut_cells) || !measured.in_region(i)) continue;
    const std::uint32_t faces = n_faces(cells, i, settings.least_area);
    if (inner.face_counts.size() <= faces) inner.face_counts.resize(faces + 1, 0);
    ++inner.face_counts[faces];
    inner.faces.push_back(faces);
    inner.volumes.push_back(cells.volumes[i]);
    inner.free_volumes.push_back(free[i]);
    inner.fractions.push_back(fractions[i]);
    inner.spheres.push_back(i);
  }
  return inner;
}

/// Means over the cells of every kind of a mixture.
void add_kinds(const MeasuredPacking& measured, const InnerCells& inner, Measurement& measurement) {
  const Sizes& sizes = *measured.packing.sizes;
  const std::size_t n = sizes.kinds().size();
  std::vector<std::string> names;
  for (const SphereKind& kind : sizes.kinds()) names.push_back(kind.name);
  std::vector<double> cells(n, 0.0), volumes(cells), fractions(cells), faces(cells);
  for (std::size_t k = 0; k < inner.spheres.size(); ++k) {
    const std::uint32_t kind = sizes.kind(inner.spheres[k]);
    cells[kind] += 1;
    volumes[kind] += inner.volumes[k];
    fractions[kind] += inner.fractions[k];
    faces[kind] += inner.faces[k];
  }
  for (std::size_t kind = 0; kind < n; ++kind) {  // NaN where the kind has none
    volumes[kind] /= cells[kind];
    fractions[kind] /= cells[kind];
    faces[kind] /= cells[kind];
  }
  measurement.places.push_back({"kind", std::move(names), "1", "kind of spheres"});
  const auto add = [&](const char* name, std::vector<double>& values, const char* units,
                       const char* long_name) {
    measurement.quantities.push_back({.name = name,
                                      .places = "kind",
                                      .values = std::move(values),
                                      .units = units,
                                      .long_name = long_name});
  };
  add("mean_volume_of_kind", volumes, "diameters^3", "volume of a cell of the kind");
  add("mean_local_fraction_of_kind", fractions, "1", "local packing fraction of the kind");
  add("mean_faces_of_kind", faces, "1", "faces per cell of the kind");
  add("cells_of_kind", cells, "1", "whole cells of the kind in the region");
}

void add_single(const char* name, double value, const char* long_name, Measurement& measurement,
                const char* source = "", const char* units = "1") {
  measurement.quantities.push_back(
      {.name = name, .values = {value}, .units = units, .long_name = long_name, .source = source});
}

/// Where bins of free volumes end: they hold all of a bed of equal spheres, and of loose packings
/// and small spheres among large ones up to 50 sphere volumes.
double end_of_free_volumes(const std::vector<double>& free_volumes) {
  constexpr double of_beds = 2, largest = 50;
  return std::clamp(std::floor(std::ranges::max(free_volumes)) + 1, of_beds, largest);
}

double share_beyond(const std::vector<double>& values, std::size_t n_bins, double bin_width) {
  const auto beyond = std::ranges::count_if(
      values, [&](double value) { return value / bin_width >= static_cast<double>(n_bins); });
  return static_cast<double>(beyond) / static_cast<double>(values.size());
}

}  // namespace

Measurement measure_part(MeasuredPacking& measured, const VoronoiSettings& settings) {
  constexpr double fraction_bin = 0.01;
  // A dodecahedron about an equal sphere has 0.755; small spheres fill more about large ones.
  const std::size_t n_fractions = measured.packing.sizes ? 100 : 76;
  const InnerCells inner = inner_cells(measured, settings);
  if (inner.volumes.empty()) throw std::invalid_argument("no whole cell lies in the region");
  const std::vector<double> faces = shares(inner.face_counts);
  const double end_of_free = end_of_free_volumes(inner.free_volumes);
  const auto n_free = static_cast<std::size_t>(std::ceil(end_of_free / settings.bin_width - 1e-9));
  Measurement measurement;
  measurement.places = {
      {"faces", whole_numbers(faces.size()), "1", "faces of a cell, without the tiniest"},
      {"free_volume", middles_of_bins(n_free, settings.bin_width), "sphere volumes",
       "volume of a cell without its sphere, middle of a bin"},
      {"local_fraction", middles_of_bins(n_fractions, fraction_bin), "1",
       "volume of a sphere over that of its cell, middle of a bin"}};
  measurement.quantities = {{.name = "face_share",
                             .places = "faces",
                             .values = faces,
                             .long_name = "fraction of cells with so many faces",
                             .source = "Rosato et al. 2010, fig. 8"},
                            {.name = "free_volume_density",
                             .places = "free_volume",
                             .values = density(inner.free_volumes, settings.bin_width, n_free),
                             .units = "1/sphere volume",
                             .long_name = "probability density of free volumes",
                             .source = "Rosato et al. 2010, fig. 9"},
                            {.name = "local_fraction_density",
                             .places = "local_fraction",
                             .values = density(inner.fractions, fraction_bin, n_fractions),
                             .long_name = "probability density of local packing fractions"}};
  const double free_mean = mean_of(inner.free_volumes);
  const double sigma = zero_within_rounding(deviation_of(inner.free_volumes, free_mean), free_mean);
  const double above_least = free_mean - least_free_volume;
  add_single("mean_faces", mean_of(inner.faces),
             "mean number of faces per cell, without the tiniest", measurement,
             "Rosato et al. 2010, fig. 8");
  add_single("mean_volume", mean_of(inner.volumes), "mean volume of a cell", measurement, "",
             "diameters^3");
  add_single("mean_free_volume", free_mean, "mean free volume of a cell", measurement,
             "Rosato et al. 2010, fig. 9", "sphere volumes");
  add_single("sigma_free_volume", sigma, "population deviation (1/n) of the free volumes of cells",
             measurement, "", "sphere volumes");
  add_single("free_volume_beyond", share_beyond(inner.free_volumes, n_free, settings.bin_width),
             "fraction of cells whose free volume is beyond the bins of the density", measurement);
  measurement.quantities.back().is_compared = false;
  add_single("mean_local_fraction", mean_of(inner.fractions), "mean local packing fraction",
             measurement);
  const bool varies = sigma > 1e-6 * free_mean;  // not so in a perfect crystal
  if (!measured.packing.sizes)
    add_single("k", varies ? above_least * above_least / (sigma * sigma) : not_a_number,
               "shape of the k-gamma distribution by its moments: (mean - least)^2 / variance, the "
               "least cell being a regular dodecahedron",
               measurement, "Aste & Di Matteo 2008, doi:10.1103/PhysRevE.77.021309");
  add_single("n_cells", static_cast<double>(inner.volumes.size()),
             "cells of the region: whole ones, with `cut_cells` all", measurement);
  measurement.quantities.back().is_compared = false;
  const VoronoiCells& cells = measured.voronoi();
  const double lid = surface_height(measured.packing);
  double all = 0;
  for (const double volume : cells.volumes) all += volume;
  add_single("volume_excess", all / volume_of(measured.packing.container, lid) - 1,
             "volume of all cells over that of the container up to the lid, less 1: above 0 "
             "beside the curved wall of a cylinder, whose cells end at planes",
             measurement);
  add_single(
      "inconsistent_cells", static_cast<double>(cells.inconsistent),
      "of all cells, those with a face that is not as large from the other side: beside the curved "
      "wall of a cylinder, or where voro++ could not make them out; volumes of the region's cells "
      "are right all the same",
      measurement);
  if (measured.packing.sizes) {
    measurement.notes.emplace_back("k", "k and the k-gamma law require equal spheres");
    add_kinds(measured, inner, measurement);
  }
  if (cells.inconsistent > 0 && std::holds_alternative<Cylinder>(measured.packing.container))
    measurement.notes.emplace_back(
        "inconsistent_cells",
        "as expected in a tube, whose wall cuts cells at planes; those of the "
        "region are right");
  return measurement;
}

Measurement measure_part(MeasuredPacking& measured, const PoresSettings& settings) {
  const std::vector<Pore> all = pores(measured.packing, measured.voronoi(), settings.merge);
  const std::vector<Pore> found = settings.spheres_inside
                                      ? pores_of_spheres_in(all, measured.packing, measured.region)
                                      : pores_in(all, measured.packing.container, measured.region);
  if (found.empty()) throw std::invalid_argument("no pore lies in the region");
  const PoreDistribution sizes = pore_distribution(found, settings.bin_width, settings.largest);
  double tetrahedral = 0, octahedral = 0, touched = 0;
  for (const Pore& pore : found) {
    touched += static_cast<double>(pore.owners.size());
    const Site site = site_of(pore, settings.tolerance);
    tetrahedral += site == Site::tetrahedral ? 1 : 0;
    octahedral += site == Site::octahedral ? 1 : 0;
  }
  const auto number = static_cast<double>(found.size());
  Measurement measurement;
  measurement.places = {{"xi", sizes.xi, "R", "radius of a pore, middle of a bin"}};
  measurement.quantities = {
      {.name = "rho_xi",
       .places = "xi",
       .values = sizes.rho_xi,
       .long_name = "number of pores per unit of xi; its integral is their number",
       .source = "Philippe & Bideau 2001, sec. V"},
      {.name = "rho_v",
       .places = "xi",
       .values = sizes.rho_v,
       .long_name = "number of pores per unit of v = xi^3",
       .source = "Philippe & Bideau 2001, fig. 10"},
      {.name = "v_rho_v",
       .places = "xi",
       .values = sizes.v_rho_v,
       .long_name = "number of pores per unit of ln v",
       .source = "Philippe & Bideau 2001, fig. 10"}};
  add_single("n_pores", number, "pores of the region", measurement,
             "Philippe & Bideau 2001, sec. V");
  measurement.quantities.back().is_compared = false;
  add_single("nu", mean_pore_volume(found), "mean of xi^3", measurement,
             "Philippe & Bideau 2001, sec. V", "sphere volumes");
  add_single("mean_touched", touched / number, "mean number of spheres that a pore touches",
             measurement);
  add_single("tetrahedral", tetrahedral / number,
             "fraction of pores at xi = (3/2)^(1/2) - 1, within the tolerance", measurement,
             "Philippe & Bideau 2001, sec. V");
  add_single("octahedral", octahedral / number,
             "fraction of pores at xi = 2^(1/2) - 1, within the tolerance", measurement,
             "Philippe & Bideau 2001, sec. V");
  return measurement;
}

Measurement measure_part(MeasuredPacking& measured, const VoidSettings& settings) {
  std::vector<double> sigma;
  const auto n = static_cast<std::size_t>(settings.largest / settings.step + 1e-9);
  for (std::size_t k = 0; k <= n; ++k) sigma.push_back(static_cast<double>(k) * settings.step);
  sigma.push_back(1);  // the spheres themselves: 1 - Phi
  VoidProbability found =
      void_probability(measured.packing, measured.region, sigma, settings.points, measured.points);
  const double phi = 1 - found.probability.back();
  found.probability.pop_back();
  found.error.pop_back();
  sigma.pop_back();
  std::vector<double> theory;
  for (const double s : sigma) theory.push_back(gotoh_void_probability(phi, s));
  Measurement measurement;
  measurement.places = {{"sigma", sigma, "R", "radius of the random sphere"}};
  measurement.quantities = {
      {.name = "p0",
       .places = "sigma",
       .values = found.probability,
       .long_name = "chance that a random sphere contains no centre; beyond sigma = 1 only "
                    "spheres that lie wholly where centres can be",
       .source = "Philippe & Bideau 2001, fig. 9",
       .beyond = not_a_number},
      {.name = "p0_points_error",
       .places = "sigma",
       .values = found.error,
       .long_name = "standard error of one packing's p0 from its random points; 0 up to sigma = 1",
       .beyond = not_a_number,
       .with_error = false},
      {.name = "p0_gotoh",
       .places = "sigma",
       .values = theory,
       .long_name = "the same of the Percus-Yevick fluid of this packing fraction",
       .source = "Philippe & Bideau 2001, eqs. 8, 9, the sign of 2 Phi corrected"}};
  add_single("phi", phi, "packing fraction of the region", measurement);
  return measurement;
}

Measurement measure_part(MeasuredPacking& input, const HolesSettings& settings) {
  const std::vector<BernalHole> holes =
      bernal_holes(input.packing, input.voronoi(), settings.bonds);
  const HoleTable table = hole_table(holes, input.packing.container, input.region);
  if (!(table.volume() > 0)) throw std::invalid_argument("no hole lies in the region");
  std::vector<std::string> names;
  std::vector<double> number, volume, published_number, published_volume;
  for (std::size_t k = 0; k < canonical_holes.size(); ++k) {
    const auto kind = static_cast<HoleKind>(k);
    names.emplace_back(canonical_holes[k].name);
    number.push_back(table.number_fraction(kind));
    volume.push_back(table.volume_fraction(kind));
    published_number.push_back(canonical_holes[k].number_fraction);
    published_volume.push_back(canonical_holes[k].volume_fraction);
  }
  const auto column = [](const char* name, std::vector<double> values, const char* long_name,
                         const char* source, bool measured) {
    return MeasuredQuantity{.name = name,
                            .places = "hole",
                            .values = std::move(values),
                            .long_name = long_name,
                            .source = source,
                            .beyond = not_a_number,
                            .with_error = measured};
  };
  constexpr const char* table_one = "Philippe & Bideau 2001, table I";
  Measurement measurement;
  measurement.places = {{"hole", names, "1", "Bernal's canonical holes"}};
  measurement.quantities = {
      column("number_fraction", number, "of the classified holes", "", true),
      column("volume_fraction", volume, "of the classified holes' volume", "", true),
      column("number_fraction_published", published_number, "in Bernal's models", table_one, false),
      column("volume_fraction_published", published_volume, "in Bernal's models", table_one,
             false)};
  add_single("unclassified", table.unclassified_fraction(),
             "part of the volume in no canonical hole", measurement);
  return measurement;
}

}  // namespace jostle::inline structure
