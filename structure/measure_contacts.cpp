#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "engine/numbers.hpp"
#include "structure/measure_parts.hpp"
#include "structure/order/accessible.hpp"
#include "structure/order/gaps.hpp"
#include "structure/order/structure_factor.hpp"

namespace jostle::inline structure {

namespace {

constexpr const char* donev = "Donev et al. 2005, doi:10.1103/PhysRevE.71.011105";

/// 0, and from 1e-6 on five per decade.
std::vector<double> gap_grid(double largest) {
  std::vector<double> grid{0};
  for (int k = 0;; ++k) {
    const double gap = std::pow(10.0, -6 + k / 5.0);
    if (gap > largest * (1 + 1e-9)) return grid;
    grid.push_back(gap);
  }
}

/// Over the region's spheres.
struct Contacts {
  double all = 0, rattlers = 0, without_rattlers = 0;
};
Contacts contacts_within(const MeasuredPacking& measured, const NeighbourTable& near,
                         double tolerance, unsigned least) {
  const Backbone every = backbone(measured.packing, near, tolerance, 0);
  const Backbone held = backbone(measured.packing, near, tolerance, least);
  double spheres = 0, all = 0, rattlers = 0, contacts = 0;
  bool has_backbone = false;
  for (std::size_t i = 0; i < near.size(); ++i) {
    has_backbone = has_backbone || !held.rattler[i];
    if (!measured.in_region(i)) continue;
    spheres += 1;
    all += every.contacts[i];
    rattlers += held.rattler[i] ? 1 : 0;
    contacts += held.contacts[i];
  }
  return {all / spheres, has_backbone ? rattlers / spheres : not_a_number,
          contacts / (spheres - rattlers)};
}

/// Gaps between the region's spheres and their neighbours, in sums of radii. Each counts as if
/// sides cut no shell.
struct Gaps {
  std::vector<double> sizes, weights;

  double exponent(double low, double high) const { return gap_exponent(sizes, low, high, weights); }
};

/// Calls add(i, j, gap, weight) for every neighbour j of a sphere i of the region.
template <class Add>
void for_each_gap(const MeasuredPacking& measured, const NeighbourTable& near, Add&& add) {
  const ShellPart part(measured.packing.container);
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (!measured.in_region(i)) continue;
    for (const Neighbour& neighbour : near.neighbours_of(i)) {
      const double scaled = std::sqrt(neighbour.distance_squared);
      const double partner = measured.packing.radius(neighbour.sphere);
      const double distance = scaled * (measured.packing.radius(i) + partner);
      add(i, neighbour.sphere, scaled - 1,
          1 / part(measured.packing.centres[i], distance, partner));
    }
  }
}

Gaps all_gaps(const MeasuredPacking& measured, const NeighbourTable& near) {
  Gaps gaps;
  for_each_gap(measured, near, [&](std::size_t, std::size_t, double gap, double weight) {
    gaps.sizes.push_back(gap);
    gaps.weights.push_back(weight);
  });
  return gaps;
}

/// Exponents of the gaps of each two kinds, in the order of KindPairs.
void add_exponents_of_pairs(const MeasuredPacking& measured, const NeighbourTable& near,
                            HeightWindow window, Measurement& measurement) {
  const Sizes& sizes = *measured.packing.sizes;
  const std::size_t n_kinds = sizes.kinds().size();
  std::vector<Gaps> of_pair(n_kinds * n_kinds);
  for_each_gap(measured, near, [&](std::size_t i, std::size_t j, double gap, double weight) {
    Gaps& gaps = of_pair[sizes.kind(i) * n_kinds + sizes.kind(j)];
    gaps.sizes.push_back(gap);
    gaps.weights.push_back(weight);
  });
  std::vector<double> exponents, counts;
  for (const Gaps& gaps : of_pair) {
    exponents.push_back(gaps.exponent(window.low, window.high));
    counts.push_back(static_cast<double>(std::ranges::count_if(
        gaps.sizes, [&](double gap) { return gap >= window.low && gap <= window.high; })));
  }
  measurement.quantities.push_back(
      {.name = "gap_exponent_of_pair",
       .places = "pair",
       .values = std::move(exponents),
       .long_name = "gamma of g_ij(1 + h) as h^-gamma, gaps in the window from spheres of the "
                    "first kind to those of the second",
       .with_packings = true});
  measurement.quantities.push_back({.name = "gaps_of_pair",
                                    .places = "pair",
                                    .values = std::move(counts),
                                    .long_name = "gaps in the window, of all packings",
                                    .pooling = Pooling::sum});
}

/// Contacts with spheres within the tolerance by kinds, and rattlers by kind.
void add_kinds(const MeasuredPacking& measured, const NeighbourTable& near, double tolerance,
               unsigned least, Measurement& measurement) {
  const Backbone held = backbone(measured.packing, near, tolerance, least);
  KindPairs pairs(measured);
  std::vector<double> loose(measured.packing.sizes->kinds().size(), 0.0), spheres(loose);
  double all_loose = 0, all = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    for (const Neighbour& neighbour : near.neighbours_of(i)) {
      if (neighbour.distance_squared <= (1 + tolerance) * (1 + tolerance))
        pairs.add(i, neighbour.sphere);
    }
    if (!measured.in_region(i)) continue;
    spheres[measured.packing.sizes->kind(i)] += 1;
    all += 1;
    loose[measured.packing.sizes->kind(i)] += held.rattler[i] ? 1 : 0;
    all_loose += held.rattler[i] ? 1 : 0;
  }
  for (std::size_t k = 0; k < loose.size(); ++k)
    loose[k] = all_loose < all ? loose[k] / spheres[k] : std::nan("");
  pairs.write("contacts_of_pair", "contacts_of_pair_all",
              "mean number of spheres of the second kind that touch one of the first, over the "
              "region",
              "mean number of spheres of the second kind that touch one of the first, over all "
              "spheres",
              measurement);
  measurement.quantities.push_back({.name = "rattlers_of_kind",
                                    .places = "kind",
                                    .values = std::move(loose),
                                    .long_name =
                                        "fraction of rattlers of a kind, of packings with a "
                                        "backbone",
                                    .with_packings = true});
}

std::string tolerance_note(double tolerance, const char* unit) {
  char gap[32];
  std::snprintf(gap, sizeof gap, "%g", tolerance);
  return std::string("surfaces up to ") + gap + unit +
         " apart touch. A packing in which such contacts hold no sphere, as of hard spheres that "
         "Monte Carlo stops at a distance, has no backbone: it counts neither in rattlers nor in "
         "backbone_contacts, and at each gap neither in rattlers_of_gap nor in backbone_z_of_gap";
}

}  // namespace

Measurement measure_part(MeasuredPacking& measured, const GapsSettings& settings) {
  const std::vector<double> grid = gap_grid(settings.largest);
  const double reach = std::max({settings.largest, settings.tolerance, settings.window.high});
  const NeighbourTable near = neighbours_within_contacts(measured.packing, 1 + reach);
  const auto least = static_cast<unsigned>(
      settings.least_contacts.value_or(least_contacts_of(measured.packing.container)));
  const Gaps gaps = all_gaps(measured, near);
  std::vector<double> all, rattlers, without_rattlers, exponents;
  for (const double gap : grid) {
    const Contacts found = contacts_within(measured, near, gap, least);
    all.push_back(found.all);
    rattlers.push_back(found.rattlers);
    without_rattlers.push_back(found.without_rattlers);
    exponents.push_back(gap > 0 && gap < 0.7 * settings.window.high
                            ? gaps.exponent(gap, settings.window.high)
                            : std::nan(""));
  }
  const Contacts found = contacts_within(measured, near, settings.tolerance, least);
  Measurement measurement;
  measurement.places = {{"gap", grid, measured.packing.sizes ? "sum of radii" : "diameter",
                         "distance of surfaces up to which spheres touch"}};
  measurement.quantities = {
      {.name = "z_of_gap",
       .places = "gap",
       .values = all,
       .long_name = "mean number of contacts within the gap, over the region",
       .source = donev},
      {.name = "rattlers_of_gap",
       .places = "gap",
       .values = rattlers,
       .long_name =
           "fraction of rattlers if what is within the gap touches, of packings with a backbone",
       .source = donev,
       .with_packings = true},
      {.name = "backbone_z_of_gap",
       .places = "gap",
       .values = without_rattlers,
       .long_name = "mean number of contacts without rattlers, of packings with a backbone",
       .source = donev,
       .with_packings = true},
      {.name = "exponent_from_gap",
       .places = "gap",
       .values = exponents,
       .long_name = "gamma of g(1 + h) as h^-gamma, from this gap to the window's end"},
      {.name = "gap_exponent",
       .values = {gaps.exponent(settings.window.low, settings.window.high)},
       .long_name =
           "gamma of g(1 + h) as h^-gamma, gaps in the window; no value for fewer than ten, or "
           "if all have one size"},
      {.name = "contacts",
       .values = {found.all},
       .long_name = "mean number of contacts within the tolerance"},
      {.name = "rattlers",
       .values = {found.rattlers},
       .long_name = "fraction of rattlers, removed one after another, of packings with a backbone",
       .source = donev,
       .with_packings = true},
      {.name = "backbone_contacts",
       .values = {found.without_rattlers},
       .long_name = "mean number of contacts without rattlers, of packings with a backbone; 6 if "
                    "isostatic without friction",
       .source = donev,
       .with_packings = true}};
  measurement.notes = {
      {"least_contacts", std::to_string(least) + " of a sphere that is no rattler"},
      {"tolerance",
       tolerance_note(settings.tolerance, measured.packing.sizes ? " of the sum of radii" : " d")}};
  if (measured.packing.sizes) {
    add_kinds(measured, near, settings.tolerance, least, measurement);
    add_exponents_of_pairs(measured, near, settings.window, measurement);
  }
  return measurement;
}

Measurement measure_part(MeasuredPacking& measured, const StructureFactorSettings& settings) {
  const StructureFactor found = structure_factor(measured.packing, settings, measured.region);
  std::vector<double> modes(found.modes.begin(), found.modes.end());
  Measurement measurement;
  measurement.places = {{"k", found.k, "1/diameter", "wave number, middle of a bin"}};
  measurement.quantities = {{.name = "s",
                             .places = "k",
                             .values = found.s,
                             .long_name = "structure factor S(k)",
                             .source = "Hansen & McDonald, Theory of Simple Liquids, sec. 4.1"},
                            {.name = "modes",
                             .places = "k",
                             .values = modes,
                             .long_name = "wave vectors averaged",
                             .with_error = false},
                            {.name = "s_0_of_squares",
                             .values = {found.s_0_of_squares},
                             .long_name = "S at k = 0 by a straight line in k^2"},
                            {.name = "s_0_of_line",
                             .values = {found.s_0_of_line},
                             .long_name = "S at k = 0 by a straight line in k",
                             .source = "Donev, Stillinger & Torquato 2005, "
                                       "doi:10.1103/PhysRevLett.95.090604"},
                            {.name = "fitted_from",
                             .values = {found.fitted_from},
                             .units = "1/diameter",
                             .long_name = "least k of the wave vectors that these lines go through",
                             .with_error = false},
                            {.name = "fitted_modes",
                             .values = {static_cast<double>(found.fitted_modes)},
                             .long_name = "how many wave vectors they are",
                             .with_error = false}};
  return measurement;
}

}  // namespace jostle::inline structure
