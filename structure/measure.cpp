#include "structure/measure.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "engine/bed/boundary.hpp"
#include "engine/bed/slab.hpp"
#include "structure/measure_parts.hpp"
#include "structure/order/neighbours.hpp"

namespace jostle::inline structure {

namespace {

std::string in_words(const Region& region, const Container& container) {
  std::string words = "heights " + std::to_string(region.low);
  words.append(" to ").append(std::to_string(region.high)).append(" d");
  if (Boundary(container).has_walls()) {
    words.append(", ").append(std::to_string(region.from_sides)).append(" d from the walls");
  }
  return words;
}

/// Throws where nothing can be counted in the region.
void require_region(const MeasuredPacking& measured) {
  const Container& container = measured.packing.container;
  const Boundary boundary(container);
  if (boundary.periodic_z && (measured.region.low < 0 || measured.region.high > boundary.height)) {
    throw std::invalid_argument("the region, " + in_words(measured.region, container) +
                                ", must lie within the periodic box: heights 0 to " +
                                std::to_string(boundary.height));
  }
  const bool empty =
      !(measured.region.high > measured.region.low) || !(measured.region.volume(container) > 0);
  const auto inside = [&](const Vec3& r) { return measured.region.contains(container, r); };
  if (empty || std::ranges::none_of(measured.packing.centres, inside)) {
    throw std::invalid_argument("no sphere lies in the region, " +
                                in_words(measured.region, container) +
                                ": the bed may be too low for it; choose another \"region\"");
  }
}

template <class Settings>
void add_part(const char* name, MeasuredPacking& measured, const std::optional<Settings>& settings,
              bool needs_region, std::vector<Measurement>& all) {
  if (!settings) return;
  Measurement measurement{.part = name};
  try {
    if (!takes_sizes<Settings>)
      require_equal_spheres(measured.packing, ("measures of " + std::string(name)).c_str());
    if (needs_region) require_region(measured);
    measurement = measure_part(measured, *settings);
    measurement.part = name;
  } catch (const std::invalid_argument& refusal) {
    measurement.refused = refusal.what();
  }
  all.push_back(std::move(measurement));
}

}  // namespace

std::vector<Measurement> measure(const Packing& packing, const StructureSettings& settings,
                                 StreamKey points) {
  require_diameters(packing);
  MeasuredPacking measured{
      .packing = packing, .region = settings.region.value_or(bulk_of(packing)), .points = points};
  std::vector<Measurement> all;
  add_part("profile", measured, settings.profile, false, all);
  add_part("sides", measured, settings.sides, false, all);
  add_part("layers", measured, settings.layers, false, all);
  add_part("coordination", measured, settings.coordination, true, all);
  add_part("pair_correlation", measured, settings.pair_correlation, false, all);
  add_part("order", measured, settings.order, true, all);
  add_part("gaps", measured, settings.gaps, true, all);
  add_part("structure_factor", measured, settings.structure_factor, true, all);
  add_part("voronoi", measured, settings.voronoi, true, all);
  add_part("clusters", measured, settings.clusters, true, all);
  add_part("pores", measured, settings.pores, true, all);
  add_part("void_probability", measured, settings.void_probability, true, all);
  add_part("holes", measured, settings.holes, true, all);
  return all;
}

KindPairs::KindPairs(const MeasuredPacking& measured) : measured_(measured) {
  const Sizes& sizes = *measured.packing.sizes;
  const std::size_t n = sizes.kinds().size();
  in_region_.assign(n * n, 0.0);
  all_ = in_region_;
  spheres_.assign(n, 0.0);
  region_spheres_ = spheres_;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    spheres_[sizes.kind(i)] += 1;
    if (measured.in_region(i)) region_spheres_[sizes.kind(i)] += 1;
  }
}

void KindPairs::add(std::size_t i, std::size_t j) {
  const Sizes& sizes = *measured_.packing.sizes;
  const std::size_t pair = sizes.kind(i) * spheres_.size() + sizes.kind(j);
  all_[pair] += 1;
  if (measured_.in_region(i)) in_region_[pair] += 1;
}

void KindPairs::write(std::string_view of_region, std::string_view of_all,
                      std::string_view region_meaning, std::string_view all_meaning,
                      Measurement& measurement) const {
  std::vector<std::string> kinds, pairs;
  for (const SphereKind& kind : measured_.packing.sizes->kinds()) kinds.push_back(kind.name);
  std::vector<double> region, all;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    for (std::size_t j = 0; j < kinds.size(); ++j) {
      const std::size_t pair = i * kinds.size() + j;
      pairs.push_back(kinds[i] + "-" + kinds[j]);
      region.push_back(in_region_[pair] / region_spheres_[i]);  // NaN where the kind has none
      all.push_back(all_[pair] / spheres_[i]);
    }
  }
  measurement.places.push_back(
      {"pair", std::move(pairs), "1", "kind of the sphere, kind of its partners"});
  measurement.places.push_back({"kind", std::move(kinds), "1", "kind of spheres"});
  measurement.quantities.push_back({.name = std::string(of_region),
                                    .places = "pair",
                                    .values = std::move(region),
                                    .long_name = region_meaning});
  measurement.quantities.push_back({.name = std::string(of_all),
                                    .places = "pair",
                                    .values = std::move(all),
                                    .long_name = all_meaning});
  measurement.quantities.push_back({.name = "spheres_of_kind",
                                    .places = "kind",
                                    .values = spheres_,
                                    .long_name = "spheres of a kind, of the whole packing"});
}

double fraction_of(const Packing& packing, const Region& region) {
  const Boundary boundary(packing.container);
  if (boundary.has_floor()) return solids_fraction(packing, {region.low, region.high});
  const double solid = packing.sizes ? solid_volume(packing)
                                     : static_cast<double>(packing.centres.size()) * sphere_volume;
  return solid / (footprint_area(packing.container) * boundary.height);
}

std::vector<double> middles_of_bins(std::size_t n, double width) {
  std::vector<double> middles(n);
  for (std::size_t k = 0; k < n; ++k) middles[k] = (static_cast<double>(k) + 0.5) * width;
  return middles;
}

std::vector<double> whole_numbers(std::size_t n) {
  std::vector<double> numbers(n);
  for (std::size_t k = 0; k < n; ++k) numbers[k] = static_cast<double>(k);
  return numbers;
}

std::vector<double> shares(std::span<const std::uint64_t> counts) {
  std::uint64_t total = 0;
  for (const std::uint64_t count : counts) total += count;
  std::vector<double> parts;
  for (const std::uint64_t count : counts) {
    parts.push_back(static_cast<double>(count) / static_cast<double>(total));
  }
  return parts;
}

}  // namespace jostle::inline structure
