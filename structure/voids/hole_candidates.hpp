#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "structure/voids/bernal_holes.hpp"

// Sets of spheres that are bonded as the corners of Bernal's holes are.
namespace jostle::inline structure {

struct Edge {
  std::uint32_t i, j;  // i < j
  double length;       // diameters
};

/// Pairs of centres closer than a length, ascending. Requires periodic widths of at least twice the
/// length.
std::vector<Edge> edges_below(const Packing& packing, double length);

/// Pairs of bonded spheres: closer than a length.
class BondGraph {
 public:
  BondGraph(std::size_t n_spheres, const std::vector<Edge>& edges, double bond);

  std::uint32_t size() const { return static_cast<std::uint32_t>(first_.size() - 1); }
  /// Spheres, ascending.
  std::span<const std::uint32_t> bonded_to(std::uint32_t i) const {
    return {bonded_.data() + first_[i], bonded_.data() + first_[i + 1]};
  }
  bool bonded(std::uint32_t i, std::uint32_t j) const {
    const auto near = bonded_to(i);
    return std::ranges::find(near, j) != near.end();
  }
  bool all_bonded(const std::array<std::uint32_t, 4>& spheres) const;
  /// Spheres bonded to both, ascending, in place of what `common` holds.
  void bonded_to_both(std::uint32_t i, std::uint32_t j, std::vector<std::uint32_t>& common) const;

 private:
  std::vector<std::uint32_t> first_;   // first entries in `bonded_`, [n_spheres + 1]
  std::vector<std::uint32_t> bonded_;  // to each sphere, ascending
};

struct HoleCandidate {
  HoleKind kind = HoleKind::unclassified;
  std::vector<std::uint32_t> spheres;  // ascending
  double gap = 0;  // longest bond less shortest other distance between them, diameters, < 0
};

/// All candidates but single tetrahedra, each once, in the order in which holes are taken.
std::vector<HoleCandidate> hole_candidates(const Packing& packing, const BondGraph& bonds);

}  // namespace jostle::inline structure
