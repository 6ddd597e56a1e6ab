#pragma once

#include <array>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/vec3.hpp"

// How far apart across a container with walls two spheres are that do not see each other. Lengths
// in diameters.
namespace jostle::inline structure {

/// Half the widths of the region that centres of spheres of one radius may reach: along x and along
/// y between planes, the radius of the disc in a tube. Nowhere less than 1e-6.
struct OpenWidths {
  double x = 0, y = 0, tube = 0;

  OpenWidths(const Boundary& boundary, double radius);
};

/// The places of spheres across a container, each relative to the region that is open to its own
/// centre: from -1 to 1 between planes, from 0 to 1 from the axis of a tube to its side. Spheres of
/// several radii that are evenly spread, each in its own region, have evenly spread places.
class RelativePlaces {
 public:
  void add(const Boundary& boundary, Vec3 centre, double radius);
  /// Sorts the places. Called once, after the last add().
  void finish();

  struct Ring {
    double place = 0, count = 0;
  };
  /// Number of places in [low, high] along x or y, ends included.
  static double count_within(const std::vector<double>& places, double low, double high);
  const std::vector<double>& x() const { return x_; }
  const std::vector<double>& y() const { return y_; }
  /// Spheres of a tube by their place; more than 256 are gathered in rings of equal area.
  const std::vector<Ring>& rings() const { return rings_; }
  double size() const { return n_; }

 private:
  double n_ = 0;
  std::vector<double> x_, y_, radial_;  // ascending
  std::vector<Ring> rings_;
};

/// Probability that two uncorrelated spheres of given radii are at most so far apart across the
/// container. Each has the places of its kind, in its own region.
///
/// A displacement d takes the fraction p of the first kind's places into the region of the second
/// sphere, and -d takes the fraction q of the second kind's places into that of the first. Both
/// regions, d apart, share the area A(d). The density of displacements is p q / A: for evenly
/// spread places p = A / A_first and q = A / A_second, which gives A / (A_first A_second). For
/// two spheres of one kind p q is the mean over different spheres, so that the density is unbiased
/// for few spheres too. Where A is less than a twentieth of the smaller region, (p / A_second + q /
/// A_first) / 2 is taken, which is also unbiased and has no denominator that vanishes. The
/// fractions along x and y count as independent; in a tube they are means over all azimuths.
class FootprintPairs {
 public:
  struct Spheres {
    const RelativePlaces& places;
    OpenWidths widths;
  };
  /// Distances up to `farthest`. Two spheres of one kind have the same object of places.
  FootprintPairs(const Boundary& boundary, const Spheres& first, const Spheres& second,
                 double farthest);

  /// Probability that the square of the distance across is at most `square`; 0 for negative ones.
  double probability(double square) const {
    if (square <= 0) return 0;
    const double place = square * inverse_step_;
    const auto k = static_cast<std::size_t>(place);
    if (k + 1 >= cumulative_.size()) return cumulative_.back();
    return cumulative_[k] +
           (place - static_cast<double>(k)) * (cumulative_[k + 1] - cumulative_[k]);
  }

 private:
  double inverse_step_;
  std::vector<double> cumulative_;  // at even steps of the square
};

}  // namespace jostle::inline structure
