#pragma once

#include <span>

#include "engine/bed/packing.hpp"
#include "structure/order/crystal_order.hpp"
#include "structure/region.hpp"

// How much of a packing is crystalline, and how high the crystal that grows from the floor reaches.
namespace jostle::inline structure {

/// Share of fcc and hcp spheres among those of the region, in [0, 1]; NaN without any. orders: [n],
/// as crystal_order() has them.
double crystalline_fraction(const Packing& packing, std::span<const CrystalOrder> orders,
                            const Region& region);

/// Height of the ordered front, diameters. Ours. The bed is cut into slices as thick as hcp layers,
/// sqrt(2/3), each about the height of one, 1/2 + k sqrt(2/3). The slice of the floor's layer,
/// k = 0, whose spheres have too few neighbours and never count as crystalline, is left out; of
/// those above it, one after another, at least `least_share` of the spheres are crystalline up to
/// the front, which is the upper edge of the last; 0 where already k = 1 has fewer. The top layer
/// of a crystal also has too few neighbours: the front of a perfect one of n layers is 1/2 + (n -
/// 3/2) times sqrt(2/3). Spheres less than 1 from a wall also have too few and are left out; in a
/// container so narrow that all are, the front is 0.
double ordered_height(const Packing& packing, std::span<const CrystalOrder> orders,
                      double least_share = 0.5);

}  // namespace jostle::inline structure
