#include "structure/voids/bernal_holes.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/bed/boundary.hpp"
#include "engine/bed/geometry.hpp"
#include "structure/voids/delaunay.hpp"
#include "structure/voids/hole_candidates.hpp"

namespace jostle::inline structure {
namespace {

// Gives tetrahedra to holes, one candidate after another.
class HoleFiller {
 public:
  HoleFiller(const Packing& packing, const std::vector<DelaunayTetrahedron>& tetrahedra)
      : packing_(packing),
        tetrahedra_(tetrahedra),
        first_(packing.centres.size() + 1, 0),
        taken_(tetrahedra.size(), false) {
    for (const DelaunayTetrahedron& tetrahedron : tetrahedra)
      ++first_[tetrahedron.spheres.front() + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
  }

  void take_if_filled(const HoleCandidate& candidate) {
    const auto interior = free_within(candidate.spheres);
    if (fills(interior, candidate.spheres.size()))
      take(candidate.kind, candidate.spheres, interior);
  }

  void take_tetrahedra(const BondGraph& bonds) {
    for (std::uint32_t t = 0; t < tetrahedra_.size(); ++t)
      if (!taken_[t] && bonds.all_bonded(tetrahedra_[t].spheres))
        take(HoleKind::tetrahedron, corners_of(t), {t});
  }

  void take_rest() {
    for (std::uint32_t t = 0; t < tetrahedra_.size(); ++t)
      if (!taken_[t]) take(HoleKind::unclassified, corners_of(t), {t});
  }

  std::vector<BernalHole> holes() && { return std::move(holes_); }

 private:
  using Face = std::array<std::uint32_t, 3>;

  std::vector<std::uint32_t> corners_of(std::uint32_t t) const {
    return {tetrahedra_[t].spheres.begin(), tetrahedra_[t].spheres.end()};
  }

  // Tetrahedra, not yet of a hole, with all four corners among the spheres.
  std::vector<std::uint32_t> free_within(const std::vector<std::uint32_t>& spheres) const {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t sphere : spheres) {
      for (std::uint32_t t = first_[sphere]; t < first_[sphere + 1]; ++t) {
        if (!taken_[t] && std::ranges::all_of(tetrahedra_[t].spheres, [&](std::uint32_t corner) {
              return std::ranges::find(spheres, corner) != spheres.end();
            }))
          found.push_back(t);
      }
    }
    return found;
  }

  // Tetrahedra fill a polyhedron whose corners all lie on its surface if they are joined by
  // their faces and leave 2 n_corners - 4 triangles outside, as Euler's formula has it.
  bool fills(const std::vector<std::uint32_t>& interior, std::size_t n_corners) const {
    std::vector<std::pair<Face, std::uint32_t>> faces;
    for (std::uint32_t k = 0; k < interior.size(); ++k) {
      const auto& c = tetrahedra_[interior[k]].spheres;
      for (const Face& face : {Face{c[0], c[1], c[2]}, Face{c[0], c[1], c[3]},
                               Face{c[0], c[2], c[3]}, Face{c[1], c[2], c[3]}})
        faces.emplace_back(face, k);
    }
    std::ranges::sort(faces);
    std::vector<std::uint32_t> group(interior.size());
    std::iota(group.begin(), group.end(), 0U);
    std::size_t inner = 0;
    for (std::size_t f = 1; f < faces.size(); ++f) {
      if (faces[f].first != faces[f - 1].first) continue;
      ++inner;
      const std::uint32_t first_group = group[faces[f].second],
                          second_group = group[faces[f - 1].second];
      std::ranges::replace(group, first_group, second_group);
    }
    const bool is_one_group =
        std::ranges::all_of(group, [&](auto g) { return g == group.front(); });
    return !interior.empty() && is_one_group && faces.size() - 2 * inner == 2 * n_corners - 4;
  }

  void take(HoleKind kind, const std::vector<std::uint32_t>& spheres,
            const std::vector<std::uint32_t>& interior) {
    const Boundary boundary(packing_.container);
    BernalHole hole{kind, spheres, 0, {}};
    const Vec3 origin = tetrahedra_[interior.front()].centroid;
    Vec3 moment;
    for (const std::uint32_t t : interior) {
      taken_[t] = true;
      const DelaunayTetrahedron& tetrahedron = tetrahedra_[t];
      moment = moment + tetrahedron.volume * separation(boundary, tetrahedron.centroid, origin);
      hole.volume += tetrahedron.volume;
    }
    const Vec3 centroid = origin + (hole.volume > 0 ? 1 / hole.volume : 0) * moment;
    hole.centroid = wrapped(boundary, centroid);
    holes_.push_back(std::move(hole));
  }

  const Packing& packing_;
  const std::vector<DelaunayTetrahedron>& tetrahedra_;
  std::vector<std::uint32_t> first_;  // tetrahedron whose first corner is a sphere, [n + 1]
  std::vector<bool> taken_;
  std::vector<BernalHole> holes_;
};

double part(double count, double all) {
  return all > 0 ? count / all : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<BernalHole> bernal_holes(const Packing& packing, const BondLengths& lengths) {
  return bernal_holes(packing, voronoi_cells(packing), lengths);
}

std::vector<BernalHole> bernal_holes(const Packing& packing, const VoronoiCells& cells,
                                     const BondLengths& lengths) {
  assert(1 < lengths.first && lengths.first <= lengths.last && lengths.step > 0);
  const auto tetrahedra = delaunay_tetrahedra(packing, cells);
  HoleFiller filler(packing, tetrahedra);
  const int steps = static_cast<int>((lengths.last - lengths.first) / lengths.step + 1e-9);
  const double longest = lengths.first + steps * lengths.step;
  const auto edges = edges_below(packing, longest);
  for (int step = 0; step <= steps; ++step) {
    const BondGraph bonds(packing.centres.size(), edges, lengths.first + step * lengths.step);
    for (const HoleCandidate& candidate : hole_candidates(packing, bonds))
      filler.take_if_filled(candidate);
    filler.take_tetrahedra(bonds);
  }
  filler.take_rest();
  return std::move(filler).holes();
}

HoleTable hole_table(std::span<const BernalHole> holes, const Container& container,
                     const Region& region) {
  HoleTable table;
  for (const BernalHole& hole : holes) {
    if (!region.contains(container, hole.centroid)) continue;
    if (hole.kind == HoleKind::unclassified) {
      ++table.unclassified;
      table.unclassified_volume += hole.volume;
    } else {
      ++table.counts[static_cast<std::size_t>(hole.kind)];
      table.volumes[static_cast<std::size_t>(hole.kind)] += hole.volume;
    }
  }
  return table;
}

double HoleTable::number_fraction(HoleKind kind) const {
  assert(kind != HoleKind::unclassified);
  const auto all = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  return part(static_cast<double>(counts[static_cast<std::size_t>(kind)]),
              static_cast<double>(all));
}

double HoleTable::volume_fraction(HoleKind kind) const {
  assert(kind != HoleKind::unclassified);
  return part(volumes[static_cast<std::size_t>(kind)], volume() - unclassified_volume);
}

double HoleTable::unclassified_fraction() const {
  return part(unclassified_volume, volume());
}

double HoleTable::volume() const {
  return std::accumulate(volumes.begin(), volumes.end(), unclassified_volume);
}

}  // namespace jostle::inline structure
