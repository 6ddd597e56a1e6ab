#pragma once

#include <vector>

#include "structure/order/neighbours.hpp"

// How the neighbours of a sphere are oriented around it, whatever way the packing is turned.
// Steinhardt, Nelson & Ronchetti 1983, doi:10.1103/PhysRevB.28.784.
//
// Whose neighbours: by the table. The values of a sphere depend on that choice more than on
// anything else (Mickel et al. 2013, doi:10.1063/1.4774084): a cut is crossed by spheres that
// hardly move, and dense packings have 12 neighbours in close packing but 6 to 9 touching ones in a
// pour. nearest_neighbours(packing, 12) is what we recommend: always as many, so spheres are
// comparable, exact in fcc and hcp, and equal to any cut between the first two shells there. It
// means little for spheres at the floor, at walls and at the surface, which have fewer than 12
// around them.
namespace jostle::inline structure {

/// Rotational invariants of the bonds of a sphere. NaN without neighbours.
/// q_l = sqrt(4 pi / (2l + 1) sum_m |q_lm|^2), in [0, 1]; q_lm is the mean of Y_lm over the bonds.
/// w_l = sum_{m1 + m2 + m3 = 0} (l l l; m1 m2 m3) q_lm1 q_lm2 q_lm3 / (sum_m |q_lm|^2)^(3/2), with
/// Wigner's 3j symbol; 0 where all q_lm vanish to rounding, where it is not defined.
///              neighbours  q4          q6          w4           w6
/// fcc          12          0.19094065  0.57452426  -0.15931737  -0.01316060
/// hcp          12          0.09722222  0.48476169   0.13409705  -0.01244196
/// bcc          14          0.03636965  0.51068823   0.15931737   0.01316060
/// icosahedron  12          0           0.66332496  undefined    -0.16975389
struct BondOrder {
  double q4 = 0, q6 = 0, w4 = 0, w6 = 0;
};

/// For every sphere, [n], each bond weighing the same.
std::vector<BondOrder> bond_order(const NeighbourTable& neighbours);

}  // namespace jostle::inline structure
