#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/instruction_set.hpp"

// The vectorised parts of rejection-free sampling: how far a sphere may go in every direction, and
// the random numbers of candidates. Every instruction set makes the same bits.
namespace jostle::inline engine {

/// Directions are sorted into rings of the angle from the downward vertical, each cut into sectors
/// of the azimuth. z counts downward throughout. Metropolis steps require finer bins: there it is
/// the cube of a length that a bin too wide overestimates.
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
  alignas(64) float cosine[n_sectors], sine[n_sectors];  // sine of the azimuth of a sector's middle
  alignas(32) float across[n_rings];                     // sin(theta) cos(alpha) of a ring's middle
  alignas(32) float vertical[n_rings];                   // cos(theta) cos(alpha)
  alignas(32) float spread[n_rings];                     // sin(alpha), rounded up
  alignas(64) std::int32_t cap[n_rings][n_sectors];      // upper limit of steps
  int parts[n_rings];
  double longest;  // step, diameters
};

/// The weight of a bin that is open to the longest step, for each of its ring's parts.
inline constexpr int whole_weight = 65535;

/// A centre on a fine grid, modulo 2^32: differences of places near each other are right across
/// periodic sides too.
struct alignas(16) GridPlace {
  std::int32_t x, y, z;
  float radius;  // diameters; of several sizes only, else 0
};

/// Rules by which a sphere sees the others: the unit of differences of places, and the obstacles
/// that bounds take into account. r is the vector from a centre to an obstacle's, s the sum of both
/// radii, c = |r|^2 / s^2 - 1. Equal spheres have s = 1.
struct alignas(16) ObstacleLimits {
  float unit[4];   // diameters per step of the grid: x, y, -z (z counts downward), 0
  float margin;    // margin of c for the grid and for rounding in single precision, at s >= 1
  float doubt;     // the limit after a step; infinite where the grid is too small for steps
  float highest;   // an obstacle higher than highest s is left out
  float farthest;  // equal spheres: an obstacle of a greater c is left out
  // Several sizes: farthest is the least of farthest_per_s / s + farthest_per_s_squared / s^2,
  // their sum at s = 1, and most_c; none at an s that the longest step may pass by.
  float farthest_per_s, farthest_per_s_squared, most_c, least_s;
};

/// Spheres and their lists (engine/monte_carlo/kernel/list_rows.hpp).
struct SphereLists {
  const GridPlace* places;
  const std::uint32_t* lists;
  std::size_t stride;          // equal spheres: from the list of one sphere to that of the next
  const std::size_t* offsets;  // several sizes: [n], the places of the lists
};

/// Floor and sides near a sphere.
struct Planes {
  static constexpr std::uint32_t most = 5;
  std::uint32_t n = 0;
  float x[most], y[most], z[most];  // normals
  float gap[most];                  // > 0
};

/// More spheres than can obstruct one of their size. Around a larger sphere there are more: its
/// list is looked at in parts of this length.
inline constexpr std::uint32_t most_in_the_way = 64;

/// The bounds of all bins of a sphere: lengths beyond which a step is certainly rejected, over the
/// longest. For the polar move the upper half of an inverse ratio in single precision, rounded
/// down; for the Metropolis move the ratio cubed, in units of 1 / whole_weight, rounded up. A bin's
/// weight is its ring's parts times the ratio, or its cube, times whole_weight.
template <int n_sectors>
struct alignas(64) BoundRow {
  std::uint32_t bounds[n_rings / 2][n_sectors];  // two rings a word, the lower half first
  std::int32_t
      up_to[n_sectors];  // no less than the weights of all bins of a sector and those before

  std::uint16_t bound(int ring, int sector) const {
    return static_cast<std::uint16_t>(bounds[ring / 2][sector] >> (ring % 2 * 16));
  }
};

/// A sphere whose bounds are to be made, and their sum of weights.
struct BoundedSphere {
  std::uint32_t sphere, weight;
  Planes planes;
};

/// The random words of consecutive candidates.
struct CandidateBatch {
  static constexpr std::uint32_t size = 128;
  alignas(64) double waiting[size];        // exponential law of mean 1
  alignas(64) std::uint64_t choice[size];  // choice of sphere and bin
  alignas(64) double sine[size],
      cosine[size];  // cosine of the azimuth from the beginning of its sector
  alignas(64) std::uint32_t theta[size], length[3][size];
};

/// Makes the rows of n spheres, rows[sphere], and their weights. Their memory accesses overlap.
template <int n_sectors>
using BoundsKernel = void (*)(const DirectionBins<n_sectors>& bins, const ObstacleLimits& limits,
                              const SphereLists& sphere_lists, BoundedSphere* spheres,
                              std::size_t n, BoundRow<n_sectors>* rows);

/// Resolution of a step in single precision.
enum class StepOutcome { free, blocked, unsure };

/// The kernels that look at obstacles, for equal spheres or several sizes.
struct BoundKernels {
  BoundsKernel<polar_sectors> polar_bounds;
  BoundsKernel<cubic_sectors> cubic_bounds;
  /// Notes those in the list of sphere i whose bounds sphere i takes part in, at its place or at
  /// `former`. Returns how many; `seeing` has room for 3 more than are listed.
  std::uint32_t (*seen_by)(const ObstacleLimits& limits, const SphereLists& sphere_lists,
                           std::uint32_t i, const GridPlace& former, std::uint32_t* seeing);
  /// Resolves whether the spheres in its list leave sphere i where a step leads it; of the step z
  /// is up.
  StepOutcome (*try_step)(const ObstacleLimits& limits, const SphereLists& sphere_lists,
                          std::uint32_t i, double dx, double dy, double dz);
};

struct RejectionFreeKernels {
  BoundKernels equal, several;
  /// Candidates first .. first + CandidateBatch::size - 1 of a stream, where azimuths are cut into
  /// n_sectors; first is a multiple of size.
  void (*draw_candidates)(std::uint64_t key, std::uint64_t first, int n_sectors,
                          CandidateBatch& batch);
};

namespace baseline {
void draw_candidates(std::uint64_t key, std::uint64_t first, int n_sectors, CandidateBatch& batch);
RejectionFreeKernels rejection_free_kernels();
}
namespace avx2 {
void draw_candidates(std::uint64_t key, std::uint64_t first, int n_sectors, CandidateBatch& batch);
RejectionFreeKernels rejection_free_kernels();
}
namespace avx512 {
void draw_candidates(std::uint64_t key, std::uint64_t first, int n_sectors, CandidateBatch& batch);
RejectionFreeKernels rejection_free_kernels();
}

/// Throws std::invalid_argument where none are compiled for `set`.
RejectionFreeKernels rejection_free_kernels_for(InstructionSet set);

}  // namespace jostle::inline engine
