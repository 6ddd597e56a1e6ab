#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "structure/order/neighbours.hpp"

// Finds the spheres of a close-packed crystal, and their heights.
namespace jostle::inline structure {

enum class CrystalOrder : std::uint8_t { disordered, fcc, hcp };

/// By common-neighbour analysis (Honeycutt & Andersen 1987, doi:10.1021/j100303a014; Faken &
/// Jonsson 1994, doi:10.1016/0927-0256(94)90109-0) with the adaptive cut of Stukowski 2012,
/// doi:10.1088/0965-0393/20/4/045021, sec. 3.1: of the 12 nearest neighbours of a sphere, two are
/// bonded if they are at most (1 + sqrt 2) / 2 of the 12's mean distance apart, halfway between the
/// first two shells of a close packing. Each neighbour has a signature: how many of the others are
/// bonded to it, how many bonds join those, and the longest chain of these bonds. fcc: twelve 421;
/// hcp: six 421 and six 422; everything else is disordered. It is a strict rule: one bond out of
/// place disorders a sphere. Spheres at the floor, at a wall or at the surface have too few
/// neighbours and are always disordered, also in a perfect crystal.
std::vector<CrystalOrder> crystal_order(const Packing& packing);

/// Like the function of a packing, for a table of at least the 12 nearest neighbours of each, [n];
/// spheres with fewer are disordered.
std::vector<CrystalOrder> crystal_order(const NeighbourTable& nearest);

}  // namespace jostle::inline structure
