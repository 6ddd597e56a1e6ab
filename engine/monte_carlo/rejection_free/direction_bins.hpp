#pragma once

#include <vector>

#include "engine/bed/elementary.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_kernels.hpp"

// The directions of trial steps, cut into bins of equal probability.
namespace jostle::inline engine {

/// Bins of the polar move. Rings are stretches of the probability of a larger angle; `theta_table`
/// is that of the move (engine/monte_carlo/theta_table.hpp).
DirectionBins<polar_sectors> polar_bins(const std::vector<double>& theta_table, double max_step);

/// Bins of the Metropolis move at zero temperature. Rings are stretches of the cosine, so that
/// probability is solid angle on the lower hemisphere. A bin's cap covers the cube |x|, |y|, |z| <=
/// step; directions beyond the cube are no trials.
DirectionBins<cubic_sectors> cubic_bins(double step);

/// The angle from the downward vertical at coordinate u in (0, 1) of a ring, uniform in
/// probability.
SineCosine polar_angle(const std::vector<double>& theta_table, int ring, double u);
SineCosine cubic_angle(int ring, double u);

/// Sine and cosine of the azimuth where a sector of n_sectors begins.
SineCosine sector_begin(int sector, int n_sectors);

}  // namespace jostle::inline engine
