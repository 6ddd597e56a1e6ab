#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "structure/voids/bernal_holes.hpp"
#include "structure/voids/delaunay.hpp"

// Sets of spheres that are bonded as the corners of Bernal's holes are.
namespace jostle::inline structure {

struct Edge {
  std::uint32_t i, j;  // i < j
  double length;       // diameters
};

/// The edges of Delaunay tetrahedra, each once, ascending. Hard spheres closer than 2^(1/2) always
/// share one: no third comes into the sphere over their distance.
std::vector<Edge> edges_of(const Packing& packing,
                           const std::vector<DelaunayTetrahedron>& tetrahedra);

/// Pairs of bonded spheres: closer than a length.
class BondGraph {
 public:
  BondGraph(std::size_t n_spheres, const std::vector<Edge>& edges, double bond);

  bool bonded(std::uint32_t i, std::uint32_t j) const {
    const auto near = bonded_to(i);
    return std::ranges::find(near, j) != near.end();
  }
  bool all_bonded(const std::array<std::uint32_t, 4>& spheres) const;
  /// Number of bonded pairs of some spheres.
  std::size_t count_within(std::span<const std::uint32_t> spheres) const;
  /// Spheres bonded to both, ascending, in place of what `common` holds.
  void bonded_to_both(std::uint32_t i, std::uint32_t j, std::vector<std::uint32_t>& common) const;

 private:
  std::span<const std::uint32_t> bonded_to(std::uint32_t i) const {
    return {bonded_.data() + first_[i], bonded_.data() + first_[i + 1]};
  }

  std::vector<std::uint32_t> first_;   // first entries in `bonded_`, [n_spheres + 1]
  std::vector<std::uint32_t> bonded_;  // to each sphere, ascending
};

struct HoleCandidate {
  HoleKind kind = HoleKind::unclassified;
  std::vector<std::uint32_t> spheres;  // ascending
  double gap = 0;  // longest bond less shortest other distance between them, diameters, < 0
};

/// All candidates but single tetrahedra that have a diagonal among the edges of `tetrahedra`, each
/// once, in the order in which holes are taken.
std::vector<HoleCandidate> hole_candidates(const Packing& packing,
                                           const std::vector<DelaunayTetrahedron>& tetrahedra,
                                           const BondGraph& bonds);

}  // namespace jostle::inline structure
