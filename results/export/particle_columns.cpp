#include "results/export/particle_columns.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "results/export/packing_file.hpp"
#include "structure/order/bond_order.hpp"
#include "structure/order/crystal_order.hpp"
#include "structure/snapshot_statistics.hpp"
#include "structure/voids/voronoi.hpp"

namespace jostle::inline results {
namespace {

std::uint32_t type_number(CrystalOrder order) {
  switch (order) {
    case CrystalOrder::disordered:
      return 0;
    case CrystalOrder::fcc:
      return 1;
    case CrystalOrder::hcp:
      return 2;
  }
  return 0;
}

}  // namespace

std::vector<double> components_of(const std::vector<Vec3>& vectors) {
  std::vector<double> components;
  components.reserve(3 * vectors.size());
  for (const Vec3& vector : vectors)
    components.insert(components.end(), {vector.x, vector.y, vector.z});
  return components;
}

std::vector<ParticleColumn> particle_columns(const Packing& packing) {
  const Packing moved = wrapped_inside(packing);
  if (packing.sizes)
    return {{"radius", packing.sizes->radii()},
            {"kind", packing.sizes->kind_of()},
            {"mass", packing.sizes->masses()},
            {"coordination", coordination_numbers(moved)},
            {"voronoi_volume", voronoi_cells(moved).volumes}};
  const NeighbourTable nearest = nearest_neighbours(moved, 12);
  std::vector<double> q6;
  for (const BondOrder& order : bond_order(nearest)) q6.push_back(order.q6);
  std::vector<std::uint32_t> types;
  for (const CrystalOrder order : crystal_order(nearest)) types.push_back(type_number(order));
  return {{"radius", std::vector<double>(packing.centres.size(), sphere_radius)},
          {"coordination", coordination_numbers(moved)},
          {"voronoi_volume", voronoi_cells(moved).volumes},
          {"q6", std::move(q6)},
          {"structure_type", std::move(types)}};
}

std::string cell_text(const ParticleColumn& column, std::size_t i) {
  return std::visit([&](const auto& values) { return fmt::format("{}", values[i]); },
                    column.values);
}

std::string cell_text(const VectorColumn& column, std::size_t i) {
  const Vec3& value = column.values[i];
  return fmt::format(" {} {} {}", value.x, value.y, value.z);
}

}  // namespace jostle::inline results
