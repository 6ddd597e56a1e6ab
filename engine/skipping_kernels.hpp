#pragma once

#include <cstdint>

// The vectorised parts of the skipping sampler: how far a sphere may go in every direction, and the
// random numbers of candidates. Every instruction set makes the same bits.
namespace jostle {

/// Directions are sorted into rings of the angle from the downward vertical, each cut into sectors
/// of the azimuth. z counts downward throughout.
inline constexpr int n_rings = 8;
inline constexpr int n_sectors = 16;

/// The share of the probability that a ring's directions have, in parts of n_ring_parts; rings go
/// from the horizontal down.
inline constexpr int ring_parts[n_rings] = {1, 1, 2, 2, 2, 2, 3, 3};
inline constexpr int n_ring_parts = 16;

/// The shapes of the bins (engine/direction_bins.hpp). Over the bin (k, p) with centre u and
/// half-angle alpha, u.r cos(alpha) - |r| sin(alpha) bounds the component of r from below.
struct DirectionBins {
  alignas(64) float cosine[n_sectors], sine[n_sectors];  // of the azimuth of a sector's middle
  float across[n_rings];                                 // sin(theta) cos(alpha) of a ring's middle
  float down[n_rings];                                   // cos(theta) cos(alpha)
  float spread[n_rings];                                 // sin(alpha), rounded up
  alignas(64) std::int32_t cap[n_rings][n_sectors];      // of what no step exceeds
  double longest;                                        // step, diameters
};

/// A bound is kept as the weight it gives its bin: the length beyond which a step is certainly
/// refused over the longest, or the cube of this ratio, in units of 1 / whole_weight, rounded up.
inline constexpr int whole_weight = 65535;

/// What stands in a sphere's way, as seen from its centre.
struct Obstacles {
  static constexpr std::uint32_t most_spheres = 64, most_planes = 5;
  std::uint32_t n_spheres = 0, n_planes = 0;
  alignas(64) float x[most_spheres] = {}, y[most_spheres] = {}, z[most_spheres] = {};  // r
  alignas(64) float tangent_squared[most_spheres] = {};  // |r|^2 - 1, rounded up; > 0
  float plane_x[most_planes] = {}, plane_y[most_planes] = {}, plane_z[most_planes] = {};  // normals
  float gap[most_planes] = {};                                                            // > 0
};

/// The weights of all bins of a sphere; and their sums over a sector, each times the parts of its
/// ring.
struct alignas(64) BoundRow {
  std::uint16_t weight[n_rings][n_sectors];
  std::int32_t sector_weight[n_sectors];
};

/// The random words of consecutive candidates.
struct CandidateBatch {
  static constexpr std::uint32_t size = 128;
  alignas(64) double waiting[size];             // exponential law of mean 1
  alignas(64) std::uint64_t choice[size];       // of sphere and bin
  alignas(64) double sine[size], cosine[size];  // of the azimuth from the beginning of its sector
  alignas(64) std::uint32_t theta[size], length[3][size];
};

struct SkippingKernels {
  /// Fill the row and return the sum of its weights: of lengths, or of their cubes.
  std::uint32_t (*linear_bounds)(const DirectionBins& bins, const Obstacles& obstacles,
                                 BoundRow& row);
  std::uint32_t (*cubic_bounds)(const DirectionBins& bins, const Obstacles& obstacles,
                                BoundRow& row);
  /// Candidates first .. first + CandidateBatch::size - 1 of a stream; first is a multiple of size.
  void (*candidates)(std::uint64_t key, std::uint64_t first, CandidateBatch& batch);
};

namespace baseline {
SkippingKernels skipping_kernels();
}
namespace avx2 {
SkippingKernels skipping_kernels();
}
namespace avx512 {
SkippingKernels skipping_kernels();
}

}  // namespace jostle
