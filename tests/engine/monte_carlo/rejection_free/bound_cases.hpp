#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "engine/bed/geometry.hpp"
#include "engine/monte_carlo/rejection_free/bound_tables.hpp"
#include "engine/monte_carlo/rejection_free/directions.hpp"
#include "engine/monte_carlo/trial_loop.hpp"

// Steps to either side of the bounds of rejection-free sampling, against a plain test of all
// spheres in double precision.
namespace jostle {

/// Centres of a packing, let down from where they are, and still creeping.
template <class Spheres>
std::vector<PackedCentre> let_down(Packing packing, std::uint64_t sweeps) {
  const auto n = static_cast<std::uint32_t>(packing.centres.size());
  const auto loop = make_trial_loop(
      packing.container, PolarMove{0.1 * 2 * packing.smallest_radius()},
      stream_key(47, 0, 0, Purpose::trials), best_instruction_set(), Sampler::exhaustive,
      Spheres::several ? SphereSizes::several : SphereSizes::equal);
  loop->load(packing);
  loop->run(sweeps * n);
  loop->store(packing);
  std::vector<PackedCentre> centres;
  for (std::uint32_t i = 0; i < n; ++i) {
    centres.push_back(Spheres::several ? packed_sphere(packing.centres[i], packing.radius(i))
                                       : packed(packing.centres[i]));
  }
  return centres;
}

/// The two moves, and the length that a bound is, over the longest, by the C library.
template <class Directions>
struct Kind;
template <>
struct Kind<PolarDirections> {
  PolarMove move;
  PolarDirections directions{Polar(move)};
  auto bins() const { return directions.bins(move.max_step); }
  static double ratio(std::uint16_t bound) {
    return 1.0 / std::bit_cast<float>(std::uint32_t{bound} << 16);
  }
};
template <>
struct Kind<CubicDirections> {
  MetropolisMove move;
  CubicDirections directions{ZeroTemperature(move)};
  auto bins() const { return directions.bins(move.max_step); }
  static double ratio(std::uint16_t bound) { return std::cbrt(bound / double{whole_weight}); }
};

template <class Box, class Directions, class Spheres = EqualSpheres>
BoundTables<Box, Directions, Spheres> tables_for(const Box& box) {
  return {box, baseline::rejection_free_kernels()};
}

/// Tests a step against all spheres.
template <class Spheres, class Box>
bool possible(const Box& box, const std::vector<PackedCentre>& centres, std::uint32_t i,
              Vec3 step) {
  const double radius = Spheres::radius(centres[i]);
  const Vec3 target = wrapped(box, unpacked(centres[i]) + step);
  if (!clear_of_boundaries(box, target, radius)) return false;
  for (std::uint32_t j = 0; j < centres.size(); ++j) {
    const double touching = radius + Spheres::radius(centres[j]);
    if (j != i && overlaps(box, target, unpacked(centres[j]), touching)) return false;
  }
  return true;
}

struct Tried {
  int beyond = 0, wrong = 0, possible_within = 0, n_within = 0;

  void operator+=(const Tried& rhs) {
    beyond += rhs.beyond, wrong += rhs.wrong;
    possible_within += rhs.possible_within, n_within += rhs.n_within;
  }
};

/// Random steps of every bin of the first n spheres, to either side of its bound; some along the
/// corners of a bin.
template <class Box, class Directions, class Spheres>
Tried try_steps(const Box& box, const Kind<Directions>& kind,
                const BoundTables<Box, Directions, Spheres>& tables, std::uint32_t n,
                RandomStream& random) {
  constexpr int n_sectors = Directions::n_sectors;
  const double longest = tables.bins().longest;
  Tried tried;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (int bin = 0; bin < n_rings * n_sectors; ++bin) {
      const int ring = bin / n_sectors, sector = bin % n_sectors;
      const double bound = longest * kind.ratio(tables.row(i).bound(ring, sector));
      const bool corner = random.uniform() < 0.3;
      const auto within_bin = [&] {
        const double u = random.uniform();
        return corner ? (u < 0.5 ? 1e-9 : 1 - 1e-9) : u;
      };
      const SineCosine theta = kind.directions.angle(ring, within_bin());
      const double azimuth = 2 * std::numbers::pi * (sector + within_bin()) / n_sectors;
      const bool beyond = random.uniform() < 0.5;
      double length =
          beyond ? bound + (longest - bound) * random.uniform() : bound * random.uniform();
      if (beyond && random.uniform() < 0.3) length = bound * (1 + 1e-9);
      if (length > longest || (beyond && !(length > bound))) continue;
      // Azimuths of sectors begin at -pi.
      const Vec3 step{-length * theta.sine * std::cos(azimuth),
                      -length * theta.sine * std::sin(azimuth), -length * theta.cosine};
      const double side = std::max({std::abs(step.x), std::abs(step.y), std::abs(step.z)});
      if (side > kind.move.max_step) continue;
      const bool free = possible<Spheres>(box, tables.centres(), i, step);
      (beyond ? tried.beyond : tried.n_within) += 1;
      (beyond ? tried.wrong : tried.possible_within) += free;
    }
  }
  return tried;
}

}  // namespace jostle
