#include "structure/order/crystal_order.hpp"

#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>

namespace jostle::inline structure {
namespace {

constexpr unsigned shell = 12;

// Bit b of word a: neighbours a and b of a sphere are bonded.
using Bonds = std::array<unsigned, shell>;

Bonds bonds_among(std::span<const Neighbour> neighbours) {
  double sum = 0;
  for (const Neighbour& neighbour : neighbours) sum += std::sqrt(neighbour.distance_squared);
  const double cut = 0.5 * (1 + std::numbers::sqrt2) * sum / shell, cut_squared = cut * cut;
  Bonds bonds{};
  for (unsigned a = 0; a < shell; ++a) {
    for (unsigned b = 0; b < a; ++b) {
      if (norm_squared(neighbours[a].way - neighbours[b].way) > cut_squared) continue;
      bonds[a] |= 1U << b;
      bonds[b] |= 1U << a;
    }
  }
  return bonds;
}

enum class Signature { unclassified, s421, s422 };

// Four common neighbours with two bonds: apart, the longest chain is 1, sharing a sphere, 2.
Signature signature(const Bonds& bonds, unsigned neighbour) {
  const unsigned common = bonds[neighbour];
  if (std::popcount(common) != 4) return Signature::unclassified;
  int ends = 0;
  bool shared = false;
  for (unsigned rest = common; rest != 0; rest &= rest - 1) {
    const int bonded = std::popcount(bonds[std::countr_zero(rest)] & common);
    ends += bonded;
    shared = shared || bonded > 1;
  }
  if (ends != 4) return Signature::unclassified;
  return shared ? Signature::s422 : Signature::s421;
}

CrystalOrder order_of(std::span<const Neighbour> neighbours) {
  if (neighbours.size() < shell) return CrystalOrder::disordered;
  const Bonds bonds = bonds_among(neighbours.first(shell));
  unsigned n421 = 0, n422 = 0;
  for (unsigned a = 0; a < shell; ++a) {
    const Signature found = signature(bonds, a);
    if (found == Signature::unclassified) return CrystalOrder::disordered;
    ++(found == Signature::s421 ? n421 : n422);
  }
  if (n421 == 12) return CrystalOrder::fcc;
  return n421 == 6 && n422 == 6 ? CrystalOrder::hcp : CrystalOrder::disordered;
}

}  // namespace

std::vector<CrystalOrder> crystal_order(const Packing& packing) {
  return crystal_order(nearest_neighbours(packing, shell));
}

std::vector<CrystalOrder> crystal_order(const NeighbourTable& nearest) {
  std::vector<CrystalOrder> orders;
  orders.reserve(nearest.size());
  for (std::size_t i = 0; i < nearest.size(); ++i)
    orders.push_back(order_of(nearest.neighbours_of(i)));
  return orders;
}

}  // namespace jostle::inline structure
