#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "structure/density/profiles.hpp"

// How a packing thins out upwards: the slope of its smoothed vertical profile. Works on the profile
// of one packing and on the mean over realizations alike.
namespace jostle::inline structure {

/// The boxcar mean of a profile: in every bin the mean over half of `width` on both sides of its
/// middle, bins being filled evenly. It is cut short at the floor, and empty above the profile.
/// Requires width > 0. The default is 2 R.
Profile smoothed(const Profile& profile, double width = 2 * sphere_radius);

/// Where alpha is measured. Philippe & Bideau 2001, sec. IV: 5 <= z/R <= 22 between walls, 26 with
/// periodic sides.
struct GradientRange {
  double low = 5 * sphere_radius, high = 22 * sphere_radius;  // diameters
  double smoothing = 2 * sphere_radius;                       // diameters; 0 for none
  /// Nothing above `depth` x 2<Z> is used, so that the surface of a lower packing is not taken for
  /// a gradient. Ours: the paper's ranges end below 0.9 x 2<Z> of its own packings.
  double depth = 0.9;
  bool operator==(const GradientRange&) const = default;
};

/// The range of the paper for a container's sides.
GradientRange gradient_range(const Container& container);

/// alpha, minus the slope of the fraction in z/R: positive where it falls upwards, as in eq. 7 of
/// Philippe & Bideau 2001.
struct Gradient {
  double alpha = std::numeric_limits<double>::quiet_NaN();
  /// Standard error of the straight line's slope, from the scatter around it as if the points were
  /// independent. Smoothed ones are not, if closer than the smoothing: between realizations the
  /// spread of alpha is the honest error.
  double error = std::numeric_limits<double>::quiet_NaN();
  std::size_t points = 0;
  std::string reason;  // why there is no alpha; empty where there is
};

/// Fits a straight line to the middles of a vertical profile's bins. Not a number, with the reason,
/// where fewer than three of them lie in the range.
Gradient gradient(const Profile& vertical, const GradientRange& range);

}  // namespace jostle::inline structure
