// Settings of structure without measuring: all parts, those that need equal spheres, the default
// region.
#include <algorithm>
#include <tuple>

#include "engine/bed/boundary.hpp"
#include "engine/bed/slab.hpp"
#include "structure/measure.hpp"
#include "structure/measure_parts.hpp"
#include "structure/voids/pores.hpp"

namespace jostle::inline structure {

StructureSettings all_structure() {
  StructureSettings all;
  all.profile.emplace();
  all.sides.emplace();
  all.layers.emplace();
  all.coordination.emplace();
  all.pair_correlation.emplace();
  all.order.emplace();
  all.gaps.emplace();
  all.structure_factor.emplace();
  all.voronoi.emplace();
  all.clusters.emplace();
  all.pores.emplace();
  all.void_probability.emplace();
  all.holes.emplace();
  return all;
}

std::vector<std::string> parts_of_equal_spheres(const StructureSettings& settings) {
  std::vector<std::string> names;
  const auto look_at = [&]<class Settings>(const std::optional<Settings>& part) {
    if (part && !takes_sizes<Settings>) names.emplace_back(Settings::description.name);
  };
  std::apply(
      [&](const auto& /*region*/, const auto&... part) { (look_at(settings.*part.member), ...); },
      StructureSettings::fields());
  return names;
}

Region bulk_of(const Packing& packing) {
  if (const Boundary boundary(packing.container); boundary.periodic_z) {
    return {0, boundary.height, 0};
  }
  Region region = pore_region;
  region.high = std::min(region.high, 2 * mean_height(packing) - 2 * sphere_radius);
  return region;
}

}  // namespace jostle::inline structure
