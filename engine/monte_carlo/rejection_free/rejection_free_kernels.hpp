#pragma once

#include <cstdint>

// The vectorised parts of rejection-free sampling: how far a sphere may go in every direction, and
// the random numbers of candidates. Every instruction set makes the same bits.
namespace jostle::inline engine {

/// Directions are sorted into rings of the angle from the downward vertical, each cut into sectors
/// of the azimuth. z counts downward throughout. Metropolis steps want finer bins: there it is the
/// cube of a length that a bin too wide overestimates.
inline constexpr int n_rings = 8;
inline constexpr int polar_sectors = 16, cubic_sectors = 32;

/// The share of the probability that a ring's directions have is parts / n_ring_parts; rings
/// go from the horizontal down.
inline constexpr int n_ring_parts = 128;

/// The shapes of the bins (engine/monte_carlo/rejection_free/direction_bins.hpp). Over the bin (k,
/// p) with centre u and half-angle alpha, u.r cos(alpha) - |r| sin(alpha) bounds the component of r
/// from below.
template <int n_sectors>
struct DirectionBins {
  static constexpr int sectors = n_sectors;
  alignas(64) float cosine[n_sectors], sine[n_sectors];  // of the azimuth of a sector's middle
  float across[n_rings];                                 // sin(theta) cos(alpha) of a ring's middle
  float down[n_rings];                                   // cos(theta) cos(alpha)
  float spread[n_rings];                                 // sin(alpha), rounded up
  alignas(64) std::int32_t cap[n_rings][n_sectors];      // of what no step exceeds
  int parts[n_rings];
  double longest;  // step, diameters
};

/// A bound is kept as the weight it gives its bin: the length beyond which a step is certainly
/// rejected over the longest, or the cube of this ratio, in units of 1 / whole_weight, rounded up.
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
template <int n_sectors>
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

/// Fills the row and returns the sum of its weights.
template <int n_sectors>
using BoundsKernel = std::uint32_t (*)(const DirectionBins<n_sectors>& bins,
                                       const Obstacles& obstacles, BoundRow<n_sectors>& row);

struct RejectionFreeKernels {
  BoundsKernel<polar_sectors> linear_bounds;  // weights are lengths
  BoundsKernel<cubic_sectors> cubic_bounds;   // and their cubes
  /// Candidates first .. first + CandidateBatch::size - 1 of a stream, where azimuths are cut into
  /// n_sectors; first is a multiple of size.
  void (*candidates)(std::uint64_t key, std::uint64_t first, int n_sectors, CandidateBatch& batch);
};

namespace baseline {
RejectionFreeKernels rejection_free_kernels();
}
namespace avx2 {
RejectionFreeKernels rejection_free_kernels();
}
namespace avx512 {
RejectionFreeKernels rejection_free_kernels();
}

}  // namespace jostle::inline engine
