#include "structure/voids/hole_candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <tuple>

#include "engine/bed/boundary.hpp"
#include "structure/order/neighbours.hpp"

namespace jostle::inline structure {
namespace {

using Square = std::array<std::uint32_t, 4>;  // around it

double distance_squared(const Packing& packing, std::uint32_t i, std::uint32_t j) {
  return norm_squared(
      separation(Boundary(packing.container), packing.centres[i], packing.centres[j]));
}

// Rings of four bonds whose diagonals are no bonds.
class Squares {
 public:
  explicit Squares(const BondGraph& bonds) : bonds_(bonds), n_paths_(bonds.size(), 0) {}

  // Calls visit(square) for every square once, its least sphere first.
  template <class Visit>
  void visit_all(Visit&& visit) {
    for (std::uint32_t a = 0; a < bonds_.size(); ++a) {
      find_paths(a);
      for (std::size_t i = 0; i < paths_.size(); ++i) {
        const auto& [c, b] = paths_[i];
        for (std::size_t j = i + 1; j < paths_.size() && paths_[j].end == c; ++j)
          if (!bonds_.bonded(b, paths_[j].middle)) visit(Square{a, b, c, paths_[j].middle});
      }
    }
  }

 private:
  struct Path {
    std::uint32_t end, middle;
    auto operator<=>(const Path&) const = default;
  };

  // Paths of two bonds from a to greater spheres that are not bonded to it, by their ends. Leaves
  // out ends that one path alone reaches.
  void find_paths(std::uint32_t a) {
    const auto visit_paths = [&](auto&& visit) {
      for (const std::uint32_t middle : bonds_.bonded_to(a)) {
        if (middle < a) continue;
        for (const std::uint32_t end : bonds_.bonded_to(middle))
          if (end > a) visit(end, middle);
      }
    };
    paths_.clear();
    visit_paths([&](std::uint32_t end, std::uint32_t) { ++n_paths_[end]; });
    for (const std::uint32_t near : bonds_.bonded_to(a)) n_paths_[near] = 0;
    visit_paths([&](std::uint32_t end, std::uint32_t middle) {
      if (n_paths_[end] > 1) paths_.push_back({end, middle});
    });
    visit_paths([&](std::uint32_t end, std::uint32_t) { n_paths_[end] = 0; });
    std::ranges::sort(paths_);
  }

  const BondGraph& bonds_;
  std::vector<Path> paths_;
  std::vector<std::uint32_t> n_paths_;  // to each sphere
};

class Candidates {
 public:
  Candidates(const Packing& packing, const BondGraph& bonds) : packing_(packing), bonds_(bonds) {}

  // All holes but tetrahedra have a square: in a dodecahedron it is bent, the ring of the corners
  // that have five bonds.
  void add_around(const Square& square) {
    sort_neighbours(square);
    add_half_octahedra(square);
    add_prisms(square);
    add_antiprisms(square);
    add_dodecahedra(square);
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
  // Neighbours of two corners or more, by the corners to which they are bonded.
  void sort_neighbours(const Square& q) {
    of_all_.clear();
    for (std::size_t k = 0; k < 4; ++k) {
      of_edge_[k].clear();
      of_three_[k].clear();
    }
    for (std::size_t k = 0; k < 4; ++k) {
      bonds_.bonded_to_both(q[k], q[(k + 1) % 4], common_);
      for (const std::uint32_t sphere : common_) {
        const bool next = bonds_.bonded(sphere, q[(k + 2) % 4]);
        const bool previous = bonds_.bonded(sphere, q[(k + 3) % 4]);
        if (!next && !previous) of_edge_[k].push_back(sphere);
        if (next && !previous) of_three_[(k + 1) % 4].push_back(sphere);
        if (next && previous && k == 0) of_all_.push_back(sphere);
      }
    }
  }

  // A square, and a sphere bonded to all four.
  void add_half_octahedra(const Square& q) {
    for (const std::uint32_t tip : of_all_)
      add(HoleKind::half_octahedron, std::array{q[0], q[1], q[2], q[3], tip});
  }

  // Triangles on opposite edges of a square, their tips bonded.
  void add_prisms(const Square& q) {
    for (const std::size_t k : {0, 1}) {
      for (const std::uint32_t a : of_edge_[k])
        for (const std::uint32_t b : of_edge_[k + 2])
          if (bonds_.bonded(a, b))
            add(HoleKind::trigonal_prism, std::array{q[0], q[1], q[2], q[3], a, b});
    }
  }

  // A second square, each corner of it bonded to the ends of an edge of the first.
  void add_antiprisms(const Square& q) {
    for (const std::uint32_t a : of_edge_[0]) {
      for (const std::uint32_t b : of_edge_[1]) {
        if (!bonds_.bonded(a, b)) continue;
        for (const std::uint32_t c : of_edge_[2]) {
          if (!bonds_.bonded(b, c) || bonds_.bonded(a, c)) continue;
          for (const std::uint32_t d : of_edge_[3])
            if (bonds_.bonded(c, d) && bonds_.bonded(d, a) && !bonds_.bonded(b, d))
              add(HoleKind::archimedean_antiprism, std::array{q[0], q[1], q[2], q[3], a, b, c, d});
        }
      }
    }
  }

  // Over each three corners of the square a sphere, those over opposite corners bonded.
  void add_dodecahedra(const Square& q) {
    for (const std::uint32_t a : of_three_[0]) {
      for (const std::uint32_t c : of_three_[2]) {
        if (!bonds_.bonded(a, c)) continue;
        for (const std::uint32_t b : of_three_[1]) {
          if (bonds_.bonded(a, b) || bonds_.bonded(b, c)) continue;
          for (const std::uint32_t d : of_three_[3])
            if (bonds_.bonded(b, d) && !bonds_.bonded(a, d) && !bonds_.bonded(c, d))
              add(HoleKind::tetragonal_dodecahedron,
                  std::array{q[0], q[1], q[2], q[3], a, b, c, d});
        }
      }
    }
  }

  template <std::size_t n>
  void add(HoleKind kind, std::array<std::uint32_t, n> spheres) {
    std::ranges::sort(spheres);
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
  std::vector<std::uint32_t> common_;  // neighbours of two corners
  // Neighbours of corners k and k + 1 alone; of corners k - 1, k and k + 1 alone; of all four.
  std::array<std::vector<std::uint32_t>, 4> of_edge_, of_three_;
  std::vector<std::uint32_t> of_all_;
};

}  // namespace

std::vector<Edge> edges_below(const Packing& packing, double length) {
  const NeighbourFinder finder(packing, length * (1 + 1e-9));  // lengths are rounded
  std::vector<Edge> edges;
  for (std::uint32_t i = 0; i < finder.size(); ++i) {
    const auto first = static_cast<std::ptrdiff_t>(edges.size());
    finder.visit_neighbours(i, [&](std::uint32_t j, Vec3, double) {
      if (i < j) edges.push_back({i, j, std::sqrt(distance_squared(packing, i, j))});
    });
    std::ranges::sort(edges.begin() + first, edges.end(), {}, &Edge::j);
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

void BondGraph::bonded_to_both(std::uint32_t i, std::uint32_t j,
                               std::vector<std::uint32_t>& common) const {
  common.clear();
  std::ranges::set_intersection(bonded_to(i), bonded_to(j), std::back_inserter(common));
}

std::vector<HoleCandidate> hole_candidates(const Packing& packing, const BondGraph& bonds) {
  Candidates candidates(packing, bonds);
  Squares(bonds).visit_all([&](const Square& square) { candidates.add_around(square); });
  return std::move(candidates).sorted();
}

}  // namespace jostle::inline structure
