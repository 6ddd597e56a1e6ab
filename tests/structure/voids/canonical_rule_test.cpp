// Bernal's holes against a search of all sets of spheres for the rule of structure.md.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "engine/bed/boundary.hpp"
#include "engine/starts/starts.hpp"
#include "structure/voids/bernal_holes.hpp"
#include "structure/voids/delaunay.hpp"
#include "tests/structure/voids/regular_holes.hpp"

using namespace jostle;

namespace {

using Corners = std::vector<std::uint32_t>;               // ascending
using Found = std::vector<std::pair<HoleKind, Corners>>;  // ascending
using Relation = std::vector<std::vector<bool>>;          // [i][j]

// A kind of hole as its bonds, the edges of the regular one.
struct Pattern {
  HoleKind kind;
  Relation bonded;
  Pattern(HoleKind of_kind, const std::vector<Vec3>& regular)
      : kind(of_kind), bonded(regular.size(), std::vector<bool>(regular.size())) {
    for (std::size_t i = 0; i < regular.size(); ++i)
      for (std::size_t j = 0; j < regular.size(); ++j)
        bonded[i][j] = i != j && norm_squared(regular[i] - regular[j]) < 1.1;
  }
};

// Takes holes by the rule, from distances and Delaunay tetrahedra alone.
class Search {
 public:
  Search(const Packing& packing, const BondLengths& lengths)
      : n_(packing.centres.size()), tetrahedra_(delaunay_tetrahedra(packing)) {
    const Boundary boundary(packing.container);
    distance_.assign(n_, std::vector<double>(n_));
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j)
        distance_[i][j] =
            std::sqrt(norm_squared(separation(boundary, packing.centres[i], packing.centres[j])));
    free_.assign(tetrahedra_.size(), true);
    all_.resize(n_);
    std::iota(all_.begin(), all_.end(), 0U);
    const Pattern patterns[] = {{HoleKind::archimedean_antiprism, antiprism()},
                                {HoleKind::tetragonal_dodecahedron, dodecahedron()},
                                {HoleKind::trigonal_prism, prism()},
                                {HoleKind::half_octahedron, half_octahedron()}};
    const Pattern single(HoleKind::tetrahedron, tetrahedron());
    const int steps = static_cast<int>((lengths.last - lengths.first) / lengths.step + 1e-9);
    for (int step = 0; step <= steps; ++step) {
      bond_ = lengths.first + step * lengths.step;
      near_.assign(n_, {});
      for (std::uint32_t i = 0; i < n_; ++i)
        std::ranges::copy_if(all_, std::back_inserter(near_[i]),
                             [&](std::uint32_t j) { return bonded(i, j); });
      for (const Pattern& pattern : patterns) take_all(pattern);
      take_tetrahedra(HoleKind::tetrahedron, bond_);
    }
    take_tetrahedra(HoleKind::unclassified, std::numeric_limits<double>::infinity());
    std::ranges::sort(found_);
  }

  Found found() && { return std::move(found_); }

 private:
  bool bonded(std::uint32_t i, std::uint32_t j) const { return i != j && distance_[i][j] < bond_; }

  void take_all(const Pattern& pattern) {
    std::set<Corners> candidates;
    Corners placed;
    for (std::uint32_t sphere = 0; sphere < n_; ++sphere) {
      placed = {sphere};
      place_next(pattern, placed, candidates);
    }
    std::vector<std::pair<double, Corners>> in_order;
    for (const Corners& corners : candidates) in_order.emplace_back(gap(corners), corners);
    std::ranges::sort(in_order);
    for (const auto& [length, corners] : in_order) {
      const auto interior = free_among(corners);
      if (filled(interior, corners.size())) take(pattern.kind, corners, interior);
    }
  }

  void place_next(const Pattern& pattern, Corners& placed, std::set<Corners>& candidates) const {
    if (placed.size() == pattern.bonded.size()) {
      Corners corners = placed;
      std::ranges::sort(corners);
      candidates.insert(corners);
      return;
    }
    const std::vector<bool>& wanted = pattern.bonded[placed.size()];
    const auto bond = std::ranges::find(wanted.begin(), wanted.begin() + placed.size(), true);
    const std::size_t anchor = bond - wanted.begin();
    for (const std::uint32_t sphere : anchor < placed.size() ? near_[placed[anchor]] : all_) {
      bool fits = true;
      for (std::size_t k = 0; k < placed.size() && fits; ++k)
        fits = sphere != placed[k] && bonded(sphere, placed[k]) == wanted[k];
      if (!fits) continue;
      placed.push_back(sphere);
      place_next(pattern, placed, candidates);
      placed.pop_back();
    }
  }

  double gap(const Corners& corners) const {
    double longest = 0, shortest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : corners)
      for (const std::uint32_t j : corners) {
        if (bonded(i, j)) longest = std::max(longest, distance_[i][j]);
        if (i != j && !bonded(i, j)) shortest = std::min(shortest, distance_[i][j]);
      }
    return longest - shortest;
  }

  std::vector<std::size_t> free_among(const Corners& corners) const {
    std::vector<std::size_t> interior;
    for (std::size_t t = 0; t < tetrahedra_.size(); ++t)
      if (free_[t] && std::ranges::includes(corners, tetrahedra_[t].spheres)) interior.push_back(t);
    return interior;
  }

  // Joined by faces, 2n - 4 faces outside.
  bool filled(const std::vector<std::size_t>& interior, std::size_t n_corners) const {
    std::map<std::array<std::uint32_t, 3>, std::vector<std::size_t>> sides;
    for (const std::size_t t : interior)
      for (std::size_t left_out = 0; left_out < 4; ++left_out) {
        std::array<std::uint32_t, 3> face{};
        std::size_t n = 0;
        for (std::size_t k = 0; k < 4; ++k)
          if (k != left_out) face[n++] = tetrahedra_[t].spheres[k];
        sides[face].push_back(t);
      }
    if (interior.empty()) return false;
    std::set<std::size_t> reached = {interior.front()};
    for (std::size_t n_reached = 0; n_reached != reached.size();) {
      n_reached = reached.size();
      for (const auto& [face, owners] : sides)
        if (std::ranges::any_of(owners, [&](std::size_t t) { return reached.contains(t); }))
          reached.insert(owners.begin(), owners.end());
    }
    const auto outside =
        std::ranges::count_if(sides, [](const auto& side) { return side.second.size() == 1; });
    return reached.size() == interior.size() &&
           outside == static_cast<std::ptrdiff_t>(2 * n_corners - 4);
  }

  void take_tetrahedra(HoleKind kind, double longest) {
    for (std::size_t t = 0; t < tetrahedra_.size(); ++t) {
      const Corners corners(tetrahedra_[t].spheres.begin(), tetrahedra_[t].spheres.end());
      const bool is_short = std::ranges::all_of(corners, [&](std::uint32_t i) {
        return std::ranges::all_of(corners,
                                   [&](std::uint32_t j) { return distance_[i][j] < longest; });
      });
      if (free_[t] && is_short) take(kind, corners, {t});
    }
  }

  void take(HoleKind kind, const Corners& corners, const std::vector<std::size_t>& interior) {
    for (const std::size_t t : interior) free_[t] = false;
    found_.emplace_back(kind, corners);
  }

  std::size_t n_;
  std::vector<DelaunayTetrahedron> tetrahedra_;
  std::vector<std::vector<double>> distance_;
  std::vector<bool> free_;
  double bond_ = 0;
  std::vector<std::uint32_t> all_;                // spheres
  std::vector<std::vector<std::uint32_t>> near_;  // bonded to each
  Found found_;
};

Found holes_of(const Packing& packing, const BondLengths& lengths = {}) {
  Found found;
  for (const BernalHole& hole : bernal_holes(packing, lengths))
    found.emplace_back(hole.kind, hole.spheres);
  std::ranges::sort(found);
  return found;
}

std::size_t count_of(const Found& found, HoleKind kind) {
  return static_cast<std::size_t>(std::ranges::count(found, kind, &Found::value_type::first));
}

std::vector<Vec3> times(double factor, std::vector<Vec3> corners) {
  for (Vec3& r : corners) r = factor * r;
  return corners;
}

// A snub disphenoid whose eight corners lie on one sphere. Bonds are shorter than 1.29, diagonals
// longer than 1.52.
std::vector<Vec3> cospherical_dodecahedron() {
  const double t = 0.75, r = 0.3, w = 0.5, s = std::sqrt(t * t + r * r - w * w);
  return times(1.05, {{t, r, 0},
                      {-t, r, 0},
                      {0, -r, t},
                      {0, -r, -t},
                      {w, -s, 0},
                      {-w, -s, 0},
                      {0, s, w},
                      {0, s, -w}});
}

// The tetrahedron of the four corners that have five bonds: the middle of the regular dodecahedron.
bool has_middle(const Packing& packing) {
  constexpr std::array<std::uint32_t, 4> middle = {0, 1, 2, 3};
  return std::ranges::any_of(delaunay_tetrahedra(packing), [&](const DelaunayTetrahedron& found) {
    return found.spheres == middle;
  });
}

}  // namespace

TEST_CASE("A dodecahedron without the tetrahedron in its middle is one hole") {
  const Packing bed{Cylinder{9.3},
                    {{4.92, 0.511, 2.868},
                     {5.042, 1.702, 2.561},
                     {6.028, 0.742, 2.809},
                     {4.63, 1.314, 3.391},
                     {6.239, 1.313, 3.609},
                     {5.51, 0.63, 3.667},
                     {5.811, 2.072, 3.084},
                     {5.374, 1.733, 3.917}}};
  CHECK(holes_of(bed) == Found{{HoleKind::tetragonal_dodecahedron, {0, 1, 2, 3, 4, 5, 6, 7}}});
}

TEST_CASE("A dodecahedron with its corners on a sphere is one hole") {
  for (const double noise : {0.0, 1e-9, 1e-7, 1e-6, 1e-4, 3e-3}) {
    std::size_t without_middle = 0;
    for (std::uint64_t trial = 0; trial < 50; ++trial) {
      CAPTURE(noise, trial);
      const Packing bed = shaken(within_walls(cospherical_dodecahedron()), noise, trial);
      const Found found = holes_of(bed);
      REQUIRE(found == Search(bed, {}).found());
      REQUIRE(count_of(found, HoleKind::tetragonal_dodecahedron) == 1);
      REQUIRE(count_of(found, HoleKind::half_octahedron) == 0);
      without_middle += has_middle(bed) ? 0 : 1;
    }
    if (noise > 1e-6) CHECK(without_middle > 10);
  }
}

TEST_CASE("Single holes under large noise are taken by the rule") {
  const std::pair<HoleKind, std::vector<Vec3>> cases[] = {
      {HoleKind::tetrahedron, tetrahedron()},
      {HoleKind::half_octahedron, half_octahedron()},
      {HoleKind::half_octahedron, octahedron()},
      {HoleKind::trigonal_prism, prism()},
      {HoleKind::tetragonal_dodecahedron, dodecahedron()},
      {HoleKind::tetragonal_dodecahedron, cospherical_dodecahedron()},
      {HoleKind::archimedean_antiprism, antiprism()}};
  std::size_t without_middle = 0;
  for (const auto& [kind, corners] : cases) {
    std::size_t of_kind = 0;
    for (const double noise : {0.02, 0.05, 0.1, 0.15}) {
      for (std::uint64_t trial = 0; trial < 100; ++trial) {
        CAPTURE(static_cast<int>(kind), noise, trial);
        const Packing bed = shaken(within_walls(times(1.08, corners)), noise, trial);
        const Found found = holes_of(bed);
        REQUIRE(found == Search(bed, {}).found());
        of_kind += count_of(found, kind);
        if (kind == HoleKind::tetragonal_dodecahedron && count_of(found, kind) == 1)
          without_middle += has_middle(bed) ? 0 : 1;
      }
    }
    CHECK(of_kind > 50);
  }
  CHECK(without_middle > 50);
}

TEST_CASE("Holes of small beds are taken by the rule") {
  const std::tuple<Container, std::uint32_t, BondLengths> cases[] = {
      {PeriodicBox{5, 6}, 250, {}},
      {PeriodicBox{6, 5}, 250, {.first = 1.4}},
      {PeriodicBox{4, 4}, 150, {.first = 1.1, .last = 1.7, .step = 0.15}},
      {WalledBox{6, 6}, 250, {}},
      {Cylinder{6}, 200, {.first = 1.3, .last = 1.45}}};
  std::size_t dodecahedra = 0, antiprisms = 0, prisms = 0;
  for (const auto& [container, n, lengths] : cases) {
    for (std::uint64_t trial = 0; trial < 3; ++trial) {
      CAPTURE(container.index(), lengths.last, trial);
      RandomStream random(stream_key(72, 0, trial, Purpose::start));
      const Packing bed = make_start(SteepestDescentPour{}, container, n, random);
      const Found found = holes_of(bed, lengths);
      CHECK(found == Search(bed, lengths).found());
      dodecahedra += count_of(found, HoleKind::tetragonal_dodecahedron);
      antiprisms += count_of(found, HoleKind::archimedean_antiprism);
      prisms += count_of(found, HoleKind::trigonal_prism);
    }
  }
  CHECK(dodecahedra > 5);
  CHECK(antiprisms > 5);
  CHECK(prisms > 50);
}

TEST_CASE("Holes of points that overlap are taken by the rule") {
  const FullyPeriodicBox box{5, 5, 5};
  RandomStream random(stream_key(73, 0, 0, Purpose::start));
  Packing points{box, {}};
  for (int i = 0; i < 150; ++i) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    points.centres.push_back({5 * x, 5 * y, 5 * z});
  }
  const BondLengths lengths{.first = 1.1, .last = 1.3};
  CHECK(holes_of(points, lengths) == Search(points, lengths).found());
}
