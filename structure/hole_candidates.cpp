#include "structure/hole_candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <tuple>

#include "engine/geometry.hpp"

namespace jostle {
namespace {

using Square = std::array<std::uint32_t, 4>;  // around it

double distance_squared(const Packing& packing, std::uint32_t i, std::uint32_t j) {
  return std::visit(
      [&](const auto& box) {
        return norm_squared(separation(box, packing.centres[i], packing.centres[j]));
      },
      packing.container);
}

// The same square from whichever corner and whichever way round.
Square canonical(Square square) {
  std::ranges::rotate(square, std::ranges::min_element(square));
  if (square[3] < square[1]) std::swap(square[1], square[3]);
  return square;
}

// Rings of four bonds around Delaunay edges longer than a bond, their other diagonal longer too.
std::set<Square> squares(const std::vector<DelaunayTetrahedron>& tetrahedra,
                         const BondGraph& bonds) {
  struct Third {
    std::uint32_t a, c, x;  // x is a corner of a tetrahedron with the edge ac
    auto operator<=>(const Third&) const = default;
  };
  std::vector<Third> thirds;
  for (const auto& [spheres, centroid, volume] : tetrahedra) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t l = k + 1; l < 4; ++l) {
        const std::uint32_t a = spheres[k], c = spheres[l];
        if (bonds.bonded(a, c)) continue;
        for (const std::uint32_t x : spheres)
          if (bonds.bonded(x, a) && bonds.bonded(x, c)) thirds.push_back({a, c, x});
      }
    }
  }
  std::ranges::sort(thirds);
  const auto repeated = std::ranges::unique(thirds);
  thirds.erase(repeated.begin(), repeated.end());
  std::set<Square> found;
  for (std::size_t i = 0; i < thirds.size(); ++i) {
    const auto& [a, c, x] = thirds[i];
    for (std::size_t j = i + 1; j < thirds.size() && thirds[j].a == a && thirds[j].c == c; ++j)
      if (!bonds.bonded(x, thirds[j].x)) found.insert(canonical({a, x, c, thirds[j].x}));
  }
  return found;
}

class Candidates {
 public:
  Candidates(const Packing& packing, const BondGraph& bonds) : packing_(packing), bonds_(bonds) {}

  // A square, and a sphere bonded to all four.
  void add_half_octahedra(const Square& q) {
    for (const std::uint32_t p : bonds_.bonded_to_both(q[0], q[2]))
      if (bonds_.bonded(p, q[1]) && bonds_.bonded(p, q[3]))
        add(HoleKind::half_octahedron, {q[0], q[1], q[2], q[3], p}, 8);
  }

  // Triangles on opposite edges of a square, their tips bonded.
  void add_prisms(const Square& q) {
    for (const auto& [a, b, c, d] : {q, Square{q[1], q[2], q[3], q[0]}}) {
      for (const std::uint32_t tip : bonds_.bonded_to_both(a, b)) {
        for (const std::uint32_t other : bonds_.bonded_to_both(c, d))
          if (bonds_.bonded(tip, other)) add(HoleKind::trigonal_prism, {a, b, c, d, tip, other}, 9);
      }
    }
  }

  // A second square, each corner of it bonded to the ends of an edge of the first.
  void add_antiprisms(const Square& q) {
    std::array<std::vector<std::uint32_t>, 4> over;
    for (std::size_t k = 0; k < 4; ++k) over[k] = bonds_.bonded_to_both(q[k], q[(k + 1) % 4]);
    for (const std::uint32_t a : over[0]) {
      for (const std::uint32_t b : over[1]) {
        if (!bonds_.bonded(a, b)) continue;
        for (const std::uint32_t c : over[2]) {
          if (!bonds_.bonded(b, c)) continue;
          for (const std::uint32_t d : over[3])
            if (bonds_.bonded(c, d) && bonds_.bonded(d, a))
              add(HoleKind::archimedean_antiprism, {q[0], q[1], q[2], q[3], a, b, c, d}, 16);
        }
      }
    }
  }

  // A tetrahedron with two opposite long edges, whose ends are the middle of the dodecahedron: two
  // tips over each long edge, bonded to one another.
  void add_dodecahedra(const DelaunayTetrahedron& middle) {
    const auto& s = middle.spheres;
    for (const auto& [a, b, c, d] :
         {s, Square{s[0], s[2], s[1], s[3]}, Square{s[0], s[3], s[1], s[2]}}) {
      if (bonds_.bonded(a, b) || bonds_.bonded(c, d) || bonds_.count_within(s) != 4) continue;
      const auto over_ab = tips(a, b, c, d), over_cd = tips(c, d, a, b);
      for (const auto& [e, f] : over_ab)
        for (const auto& [g, h] : over_cd)
          add(HoleKind::tetragonal_dodecahedron, {a, b, c, d, e, f, g, h}, 18);
    }
  }

  // In the order in which holes are taken.
  std::vector<HoleCandidate> sorted() && {
    const auto key = [](const HoleCandidate& one) {
      return std::tuple(-static_cast<int>(one.kind), one.gap, one.spheres);  // largest first
    };
    std::ranges::sort(found_, {}, key);
    const auto repeated = std::ranges::unique(found_, {}, key);
    found_.erase(repeated.begin(), repeated.end());
    return std::move(found_);
  }

 private:
  // Bonded pairs, one bonded to a, b and c, the other to a, b and d.
  std::vector<std::array<std::uint32_t, 2>> tips(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                                                 std::uint32_t d) const {
    std::vector<std::array<std::uint32_t, 2>> pairs;
    const auto over = bonds_.bonded_to_both(a, b);
    for (const std::uint32_t e : over)
      for (const std::uint32_t f : over)
        if (bonds_.bonded(e, c) && bonds_.bonded(f, d) && bonds_.bonded(e, f))
          pairs.push_back({e, f});
    return pairs;
  }

  // If the spheres are all different and bonded in n_bonds pairs.
  void add(HoleKind kind, std::vector<std::uint32_t> spheres, std::size_t n_bonds) {
    std::ranges::sort(spheres);
    if (std::ranges::adjacent_find(spheres) != spheres.end()) return;
    if (bonds_.count_within(spheres) != n_bonds) return;
    double longest = 0, shortest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      for (std::size_t j = i + 1; j < spheres.size(); ++j) {
        const double length = std::sqrt(distance_squared(packing_, spheres[i], spheres[j]));
        if (bonds_.bonded(spheres[i], spheres[j])) {
          longest = std::max(longest, length);
        } else {
          shortest = std::min(shortest, length);
        }
      }
    }
    found_.push_back({kind, std::move(spheres), longest - shortest});
  }

  const Packing& packing_;
  const BondGraph& bonds_;
  std::vector<HoleCandidate> found_;
};

}  // namespace

std::vector<Edge> edges_of(const Packing& packing,
                           const std::vector<DelaunayTetrahedron>& tetrahedra) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  pairs.reserve(6 * tetrahedra.size());
  for (const DelaunayTetrahedron& one : tetrahedra)
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t l = k + 1; l < 4; ++l) pairs.emplace_back(one.spheres[k], one.spheres[l]);
  std::ranges::sort(pairs);
  const auto repeated = std::ranges::unique(pairs);
  pairs.erase(repeated.begin(), repeated.end());
  std::vector<Edge> edges;
  edges.reserve(pairs.size());
  for (const auto& [i, j] : pairs)
    edges.push_back({i, j, std::sqrt(distance_squared(packing, i, j))});
  return edges;
}

BondGraph::BondGraph(std::size_t n_spheres, const std::vector<Edge>& edges, double bond)
    : bonded_(n_spheres) {
  for (const auto& [i, j, length] : edges) {
    if (length >= bond) continue;
    bonded_[i].push_back(j);
    bonded_[j].push_back(i);
  }
  for (auto& neighbours : bonded_) std::ranges::sort(neighbours);
}

bool BondGraph::bonded(std::uint32_t i, std::uint32_t j) const {
  return std::ranges::binary_search(bonded_[i], j);
}

std::size_t BondGraph::count_within(std::span<const std::uint32_t> spheres) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (std::size_t j = i + 1; j < spheres.size(); ++j) count += bonded(spheres[i], spheres[j]);
  return count;
}

std::vector<std::uint32_t> BondGraph::bonded_to_both(std::uint32_t i, std::uint32_t j) const {
  std::vector<std::uint32_t> both;
  std::ranges::set_intersection(bonded_[i], bonded_[j], std::back_inserter(both));
  return both;
}

std::vector<HoleCandidate> hole_candidates(const Packing& packing,
                                           const std::vector<DelaunayTetrahedron>& tetrahedra,
                                           const BondGraph& bonds) {
  Candidates candidates(packing, bonds);
  for (const Square& square : squares(tetrahedra, bonds)) {
    candidates.add_half_octahedra(square);
    candidates.add_prisms(square);
    candidates.add_antiprisms(square);
  }
  for (const DelaunayTetrahedron& one : tetrahedra) candidates.add_dodecahedra(one);
  return std::move(candidates).sorted();
}

}  // namespace jostle
