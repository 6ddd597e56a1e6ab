#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "engine/bed/elementary.hpp"
#include "engine/bed/vec3.hpp"
#include "engine/monte_carlo/kernel/move_policies.hpp"
#include "engine/monte_carlo/rejection_free/direction_bins.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_kernels.hpp"

// The moves as rejection-free sampling is compiled for them, one type each: the bins of directions,
// how probability grows with length, and when candidates alone are worth drawing.
namespace jostle::inline engine {

/// For the polar move: along a direction the length is uniform.
class PolarDirections {
 public:
  using Policy = Polar;
  static constexpr int n_sectors = polar_sectors;
  using Bins = DirectionBins<n_sectors>;

  /// Rejection-free sampling begins below this acceptance ratio. Measured where both samplers cost
  /// the same (docs/developers/performance.md).
  static constexpr double least_acceptance = 0.015;
  /// Obstacles higher than highest_obstacle sums of both radii above a centre hardly ever bound a
  /// step that does not rise, and are left out; so are those farther from contact than
  /// obstacle_reach of the longest step.
  static constexpr double highest_obstacle = 0.3, obstacle_reach = 0.5;

  explicit PolarDirections(const Polar& move) : theta_table_(move.theta_table()) {}

  static BoundsKernel<n_sectors> bounds(const BoundKernels& kernels) {
    return kernels.polar_bounds;
  }
  Bins bins(double step) const { return polar_bins(theta_table_, step); }
  /// The probability of a trial within bounds that take up `share` of the bins' weight.
  static double probability(double share, const Bins&, double /*step*/) { return share; }
  /// Weight of a bin by its bound, in (0, 1], and the corresponding length over the longest.
  static double size(std::uint16_t bound) {
    return 1.0 / std::bit_cast<float>(std::uint32_t{bound} << 16);
  }
  static double length_ratio(double size) { return size; }
  /// The word of candidate t that chooses the length within the bound.
  static std::uint32_t length_word(const CandidateBatch& batch, std::uint32_t t) {
    return batch.length[0][t];
  }
  SineCosine angle(int ring, double u) const { return polar_angle(theta_table_, ring, u); }
  /// True if trials of a step reach a displacement within the bounds.
  static bool proposes(Vec3, double /*step*/) { return true; }

 private:
  std::vector<double> theta_table_;
};

/// For the Metropolis move at zero temperature: uniform in the lower half of a cube, so that along
/// a direction the cube of the length is uniform.
class CubicDirections {
 public:
  using Policy = ZeroTemperature;
  static constexpr int n_sectors = cubic_sectors;
  using Bins = DirectionBins<n_sectors>;

  /// See PolarDirections. A trial at zero temperature is cheap to test; many of its steps
  /// are nearly horizontal. The chord of the kernels has no width for an obstacle at the very end
  /// of the longest step, which is left out.
  static constexpr double least_acceptance = 0.004;
  static constexpr double highest_obstacle = 0.75, obstacle_reach = 1 - 1e-5;

  explicit CubicDirections(const ZeroTemperature&) {}

  static BoundsKernel<n_sectors> bounds(const BoundKernels& kernels) {
    return kernels.cubic_bounds;
  }
  static Bins bins(double step) { return cubic_bins(step); }
  static double probability(double share, const Bins& bins, double step) {
    constexpr double solid_angle = 2 * std::numbers::pi;
    const double ratio = bins.longest / (2 * step);
    return share * (ratio * ratio * ratio) * (solid_angle / 3);
  }
  static double size(std::uint16_t bound) { return bound * (1.0 / whole_weight); }
  static double length_ratio(double size) { return cube_root(size); }
  static std::uint32_t length_word(const CandidateBatch& batch, std::uint32_t t) {
    return std::max({batch.length[0][t], batch.length[1][t], batch.length[2][t]});
  }
  static SineCosine angle(int ring, double u) { return cubic_angle(ring, u); }
  /// The bounds may reach beyond the cube of the trials.
  static bool proposes(Vec3 d, double step) {
    return std::max({std::abs(d.x), std::abs(d.y), -d.z}) <= step;
  }
};

}  // namespace jostle::inline engine
