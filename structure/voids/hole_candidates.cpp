#include "structure/voids/hole_candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <tuple>

#include "engine/bed/boundary.hpp"

namespace jostle::inline structure {
namespace {

using Square = std::array<std::uint32_t, 4>;  // around it

double distance_squared(const Packing& packing, std::uint32_t i, std::uint32_t j) {
  return norm_squared(
      separation(Boundary(packing.container), packing.centres[i], packing.centres[j]));
}

// Equal for a square from all corners and in both directions.
Square canonical(Square square) {
  std::ranges::rotate(square, std::ranges::min_element(square));
  if (square[3] < square[1]) std::swap(square[1], square[3]);
  return square;
}

// Its edges that are bonds: [0][1] joins its first two spheres.
using BondsOf = std::array<std::array<bool, 4>, 4>;

BondsOf bonds_of(const DelaunayTetrahedron& tetrahedron, const BondGraph& bonds) {
  BondsOf bonded{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t l = k + 1; l < 4; ++l)
      bonded[k][l] = bonded[l][k] = bonds.bonded(tetrahedron.spheres[k], tetrahedron.spheres[l]);
  return bonded;
}

// Rings of four bonds around Delaunay edges longer than a bond, their other diagonal longer too.
class Squares {
 public:
  explicit Squares(const BondGraph& bonds) : bonds_(bonds) {}

  void add_edges(const std::array<std::uint32_t, 4>& spheres, const BondsOf& bonded) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t l = k + 1; l < 4; ++l) {
        if (bonded[k][l]) continue;
        for (std::size_t x = 0; x < 4; ++x)
          if (bonded[x][k] && bonded[x][l]) thirds_.push_back({spheres[k], spheres[l], spheres[x]});
      }
    }
  }

  // Each once.
  std::vector<Square> found() && {
    keep_one_of_each(thirds_);
    std::vector<Square> all;
    for (std::size_t i = 0; i < thirds_.size(); ++i) {
      const auto& [a, c, x] = thirds_[i];
      for (std::size_t j = i + 1; j < thirds_.size() && thirds_[j].a == a && thirds_[j].c == c; ++j)
        if (!bonds_.bonded(x, thirds_[j].x)) all.push_back(canonical({a, x, c, thirds_[j].x}));
    }
    keep_one_of_each(all);
    return all;
  }

 private:
  struct Third {
    std::uint32_t a, c, x;  // x is a corner of a tetrahedron with the edge ac
    auto operator<=>(const Third&) const = default;
  };
  template <class T>
  static void keep_one_of_each(std::vector<T>& all) {
    std::ranges::sort(all);
    const auto repeated = std::ranges::unique(all);
    all.erase(repeated.begin(), repeated.end());
  }

  const BondGraph& bonds_;
  std::vector<Third> thirds_;
};

class Candidates {
 public:
  Candidates(const Packing& packing, const BondGraph& bonds) : packing_(packing), bonds_(bonds) {}

  // Holes with a square.
  void add_around(const Square& square) {
    for (std::size_t k = 0; k < 4; ++k)
      bonds_.bonded_to_both(square[k], square[(k + 1) % 4], common_[k]);
    add_half_octahedra(square);
    add_prisms(square);
    add_antiprisms(square);
  }

  // A tetrahedron with two opposite long edges, whose ends are the middle of the dodecahedron: two
  // tips over each long edge, bonded to one another.
  void add_dodecahedra(const std::array<std::uint32_t, 4>& s, const BondsOf& bonded) {
    constexpr std::size_t opposite_edges[3][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}};
    for (const auto& [k, l, m, n] : opposite_edges) {
      if (bonded[k][l] || bonded[m][n]) continue;
      if (!bonded[k][m] || !bonded[k][n] || !bonded[l][m] || !bonded[l][n]) continue;
      const std::uint32_t a = s[k], b = s[l], c = s[m], d = s[n];
      const auto over_ab = tips(a, b, c, d), over_cd = tips(c, d, a, b);
      for (const auto& [e, f] : over_ab)
        for (const auto& [g, h] : over_cd)
          add(HoleKind::tetragonal_dodecahedron, std::array{a, b, c, d, e, f, g, h}, 18);
    }
  }

  // In the order in which holes are taken.
  std::vector<HoleCandidate> sorted() && {
    const auto key = [](const HoleCandidate& candidate) {
      using Key = std::tuple<int, double, const std::vector<std::uint32_t>&>;
      return Key(-static_cast<int>(candidate.kind), candidate.gap,
                 candidate.spheres);  // largest first
    };
    std::ranges::sort(found_, {}, key);
    const auto repeated = std::ranges::unique(found_, {}, key);
    found_.erase(repeated.begin(), repeated.end());
    return std::move(found_);
  }

 private:
  // A square, and a sphere bonded to all four.
  void add_half_octahedra(const Square& q) {
    for (const std::uint32_t p : common_[0])
      if (bonds_.bonded(p, q[2]) && bonds_.bonded(p, q[3]))
        add(HoleKind::half_octahedron, std::array{q[0], q[1], q[2], q[3], p}, 8);
  }

  // Triangles on opposite edges of a square, their tips bonded.
  void add_prisms(const Square& q) {
    for (const std::size_t k : {0, 1}) {
      for (const std::uint32_t tip : common_[k])
        for (const std::uint32_t sphere : common_[k + 2])
          if (bonds_.bonded(tip, sphere))
            add(HoleKind::trigonal_prism, std::array{q[0], q[1], q[2], q[3], tip, sphere}, 9);
    }
  }

  // A second square, each corner of it bonded to the ends of an edge of the first.
  void add_antiprisms(const Square& q) {
    for (const std::uint32_t a : common_[0]) {
      for (const std::uint32_t b : common_[1]) {
        if (!bonds_.bonded(a, b)) continue;
        for (const std::uint32_t c : common_[2]) {
          if (!bonds_.bonded(b, c)) continue;
          for (const std::uint32_t d : common_[3])
            if (bonds_.bonded(c, d) && bonds_.bonded(d, a))
              add(HoleKind::archimedean_antiprism, std::array{q[0], q[1], q[2], q[3], a, b, c, d},
                  16);
        }
      }
    }
  }

  // Bonded pairs, one bonded to a, b and c, the other to a, b and d.
  std::vector<std::array<std::uint32_t, 2>> tips(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                                                 std::uint32_t d) {
    std::vector<std::array<std::uint32_t, 2>> pairs;
    std::vector<std::uint32_t>& remaining = common_[0];
    bonds_.bonded_to_both(a, b, remaining);
    for (const std::uint32_t e : remaining)
      for (const std::uint32_t f : remaining)
        if (bonds_.bonded(e, c) && bonds_.bonded(f, d) && bonds_.bonded(e, f))
          pairs.push_back({e, f});
    return pairs;
  }

  // If the spheres are all different and bonded in n_bonds pairs.
  template <std::size_t n>
  void add(HoleKind kind, std::array<std::uint32_t, n> spheres, std::size_t n_bonds) {
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
    found_.push_back({kind, {spheres.begin(), spheres.end()}, longest - shortest});
  }

  const Packing& packing_;
  const BondGraph& bonds_;
  std::vector<HoleCandidate> found_;
  std::array<std::vector<std::uint32_t>, 4> common_;  // spheres bonded to both ends of an edge
};

}  // namespace

std::vector<Edge> edges_of(const Packing& packing,
                           const std::vector<DelaunayTetrahedron>& tetrahedra) {
  std::vector<std::vector<std::uint32_t>> bond_ends(packing.centres.size());  // ends, by beginning
  for (const DelaunayTetrahedron& tetrahedron : tetrahedra) {
    for (std::size_t k = 0; k < 4; ++k) {
      auto& ends = bond_ends[tetrahedron.spheres[k]];
      for (std::size_t l = k + 1; l < 4; ++l)
        if (std::ranges::find(ends, tetrahedron.spheres[l]) == ends.end())
          ends.push_back(tetrahedron.spheres[l]);
    }
  }
  std::vector<Edge> edges;
  for (std::uint32_t i = 0; i < bond_ends.size(); ++i) {
    std::ranges::sort(bond_ends[i]);
    for (const std::uint32_t j : bond_ends[i])
      edges.push_back({i, j, std::sqrt(distance_squared(packing, i, j))});
  }
  return edges;
}

BondGraph::BondGraph(std::size_t n_spheres, const std::vector<Edge>& edges, double bond)
    : first_(n_spheres + 1, 0) {
  for (const auto& [i, j, length] : edges) {
    if (length >= bond) continue;
    ++first_[i + 1];
    ++first_[j + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  bonded_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const auto& [i, j, length] : edges) {  // in ascending order for each sphere
    if (length >= bond) continue;
    bonded_[next[i]++] = j;
    bonded_[next[j]++] = i;
  }
}

bool BondGraph::all_bonded(const std::array<std::uint32_t, 4>& spheres) const {
  const auto& [a, b, c, d] = spheres;
  return bonded(a, b) && bonded(a, c) && bonded(a, d) && bonded(b, c) && bonded(b, d) &&
         bonded(c, d);
}

std::size_t BondGraph::count_within(std::span<const std::uint32_t> spheres) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (std::size_t j = i + 1; j < spheres.size(); ++j) count += bonded(spheres[i], spheres[j]);
  return count;
}

void BondGraph::bonded_to_both(std::uint32_t i, std::uint32_t j,
                               std::vector<std::uint32_t>& common) const {
  common.clear();
  std::ranges::set_intersection(bonded_to(i), bonded_to(j), std::back_inserter(common));
}

std::vector<HoleCandidate> hole_candidates(const Packing& packing,
                                           const std::vector<DelaunayTetrahedron>& tetrahedra,
                                           const BondGraph& bonds) {
  Candidates candidates(packing, bonds);
  Squares squares(bonds);
  for (const DelaunayTetrahedron& tetrahedron : tetrahedra) {
    const BondsOf bonded = bonds_of(tetrahedron, bonds);
    squares.add_edges(tetrahedron.spheres, bonded);
    candidates.add_dodecahedra(tetrahedron.spheres, bonded);
  }
  for (const Square& square : std::move(squares).found()) candidates.add_around(square);
  return std::move(candidates).sorted();
}

}  // namespace jostle::inline structure
