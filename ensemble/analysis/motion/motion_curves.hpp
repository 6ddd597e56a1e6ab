#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "ensemble/motion/motion_records.hpp"
#include "ensemble/statistics/log_estimate.hpp"

// Motion of spheres averaged over realizations. A row holds one value per realization; NaN values
// are left out.
namespace jostle::inline ensemble {

/// Mean of a row, with its standard error (NaN below two realizations).
struct MeanEstimate {
  double value, error, dof;
};
MeanEstimate mean_estimate(std::span<const double> row);

/// <dx^2 + dy^2> of each realization, diameters^2.
std::vector<double> lateral_squares(const MotionRecords& records, std::size_t origin,
                                    std::size_t lag);
/// <(dz - <dz>)^2> of each: what is left of <dz^2> once the bed has settled as a whole.
std::vector<double> vertical_squares(const MotionRecords& records, std::size_t origin,
                                     std::size_t lag);
/// The parameter of a layer, about its own mean.
std::vector<double> layer_lateral_squares(const MotionRecords& records, std::size_t origin,
                                          std::size_t lag, std::size_t layer);
std::vector<double> layer_vertical_squares(const MotionRecords& records, std::size_t origin,
                                           std::size_t lag, std::size_t layer);

/// <dx^2 + dy^2> of the spheres of a kind, of each realization.
std::vector<double> kind_lateral_squares(const MotionRecords& records, std::size_t origin,
                                         std::size_t lag, std::size_t kind);
/// The mean vertical displacement of a kind less that of all spheres, diameters: positive where the
/// kind rises in the bed.
std::vector<double> kind_rise(const MotionRecords& records, std::size_t origin, std::size_t lag,
                              std::size_t kind);
/// <(dz - <dz>)^2> of a kind, <dz> being the mean of all spheres: a kind may have one sphere.
std::vector<double> kind_vertical_squares(const MotionRecords& records, std::size_t origin,
                                          std::size_t lag, std::size_t kind);

/// <r^4> / (2 <r^2>^2) - 1 of lateral displacements r in two dimensions: 0 for Gaussian ones.
/// < > is the mean over spheres and realizations, the error a jackknife's over realizations.
/// Rahman 1964, doi:10.1103/PhysRev.136.A405, whose form is for three dimensions.
MeanEstimate lateral_non_gaussian(const MotionRecords& records, std::size_t origin,
                                  std::size_t lag);
/// <z^4> / (3 <z^2>^2) - 1 of vertical displacements z about the mean of each realization.
MeanEstimate vertical_non_gaussian(const MotionRecords& records, std::size_t origin,
                                   std::size_t lag);
/// Like those of the bed, for the spheres of a layer about its own mean. Few Gaussian displacements
/// read 0 in the mean: for n spheres of each of M realizations the ratios are multiplied by
/// (n M + 1)/(n M) and by ((n - 1) M + 2)/((n - 1) M).
MeanEstimate layer_lateral_non_gaussian(const MotionRecords& records, std::size_t origin,
                                        std::size_t lag, std::size_t layer);
MeanEstimate layer_vertical_non_gaussian(const MotionRecords& records, std::size_t origin,
                                         std::size_t lag, std::size_t layer);

/// chi_4 of spheres that move independently of each other, and alike within layers: the mean over
/// spheres of Q_l (1 - Q_l) n_l/(n_l - 1), Q_l the fraction of the n_l spheres of their layer that
/// have moved less than a (the last factor undoes what the few spheres of a layer take off). No
/// more than Q (1 - Q) of the whole bed, which takes differences of layers for a wider scatter.
/// `overlap`: layer_lateral_overlap or layer_overlap. No number with a sphere alone in its layer.
std::vector<double> independent_susceptibility(const MotionRecords& records,
                                               std::string_view overlap, std::size_t origin,
                                               std::size_t lag, std::size_t length);

/// chi_4 = N Var(Q), the variance over realizations (of M - 1) of the fraction Q of N spheres that
/// have moved less than a; independent_susceptibility() for spheres that move independently of each
/// other. Intervals of chi2, exact where Q is normal over realizations: so none where fewer spheres
/// than `fewest_spheres` have moved, or stayed, in the mean, or fewer than one group in two
/// realizations; a group has chi_4 / (Q (1 - Q)) spheres. After Dauchot et al. 2005,
/// doi:10.1103/PhysRevLett.95.265701; Keys et al. 2007, doi:10.1038/nphys572.
inline constexpr double fewest_spheres = 30;
LogEstimate four_point_susceptibility(std::span<const double> overlaps, std::uint32_t n_spheres);

/// d ln <r^2> / d ln t between the nearest lags that are at most half and at least twice this one,
/// over the mean of realizations, with the jackknife's error over them; NaN without such lags.
MeanEstimate lateral_exponent(const MotionRecords& records, std::size_t origin, std::size_t lag);
MeanEstimate kind_lateral_exponent(const MotionRecords& records, std::size_t origin,
                                   std::size_t lag, std::size_t kind);

/// <r^2>(t_W, t) over that of the first waiting time at the same lag: the geometric mean over
/// realizations of the ratio of each, with the interval by Student's t of its logarithm. None of
/// the first.
LogEstimate lateral_ratio(const MotionRecords& records, std::size_t origin, std::size_t lag);

}  // namespace jostle::inline ensemble
