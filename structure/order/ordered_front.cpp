#include "structure/order/ordered_front.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "structure/density/layers.hpp"

namespace jostle::inline structure {

double crystalline_fraction(const Packing& packing, std::span<const CrystalOrder> orders,
                            const Region& region) {
  std::size_t crystalline = 0, all = 0;
  for (std::size_t i = 0; i < orders.size(); ++i) {
    if (!region.contains(packing.container, packing.centres[i])) continue;
    ++all;
    crystalline += orders[i] != CrystalOrder::disordered ? 1 : 0;
  }
  if (all == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(crystalline) / static_cast<double>(all);
}

double ordered_height(const Packing& packing, std::span<const CrystalOrder> orders,
                      double least_share) {
  const double first = hcp_layer_height(0), thickness = hcp_layer_height(1) - first;
  struct Slice {
    double crystalline = 0, all = 0;
  };
  // A bed of n spheres that touch is at most n high: spheres above have no contiguous slices.
  std::vector<Slice> slices(packing.centres.size() + 2);
  const Region away_from_walls{-std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::infinity(), 2 * sphere_radius};
  for (std::size_t i = 0; i < orders.size(); ++i) {
    if (!away_from_walls.contains(packing.container, packing.centres[i])) continue;
    const double place = (packing.centres[i].z - first) / thickness + 0.5;
    if (!(place >= 0 && place < static_cast<double>(slices.size()))) continue;
    Slice& slice = slices[static_cast<std::size_t>(place)];
    slice.all += 1;
    slice.crystalline += orders[i] != CrystalOrder::disordered ? 1 : 0;
  }
  std::size_t front = 1;
  while (front < slices.size() && slices[front].all > 0 &&
         slices[front].crystalline >= least_share * slices[front].all) {
    ++front;
  }
  return front == 1 ? 0 : first + (static_cast<double>(front) - 0.5) * thickness;
}

}  // namespace jostle::inline structure
