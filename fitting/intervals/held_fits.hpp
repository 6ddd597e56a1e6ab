#pragma once

#include <cmath>
#include <optional>

#include "fitting/intervals/profile.hpp"
#include "fitting/solver/curve_residuals.hpp"

namespace jostle::inline fitting {

/// The variable that a profile runs along: that of the fit; but for a value far from all that was
/// measured its logarithm, or else nothing between there and the data would be resolved. `plain`:
/// the parameter itself, whatever its bounds.
class Coordinate {
 public:
  Coordinate(const ProfileProblem& problem, std::size_t index, bool plain = false);

  double to_variable(double p) const {
    return far_ ? std::asinh(p / scale_) : transform_.to_variable(p);
  }
  double to_parameter(double u) const {
    return far_ ? scale_ * std::sinh(u) : transform_.to_parameter(u);
  }
  double slope(double u) const { return far_ ? scale_ * std::cosh(u) : transform_.slope(u); }
  bool is_logarithmic() const { return far_ || !transform_.is_identity(); }
  bool is_far() const { return far_; }

 private:
  Transform transform_;
  bool far_ = false;
  double scale_ = 1;
};

/// A fit with one parameter held, `distance` from the minimum in its coordinate. z = sqrt((its cost
/// - least cost) / variance) is never too low; it is known to be right only where the fit settled.
struct HeldFit {
  double distance, z;
  bool settled;
  ParameterValues p;
};

/// Fits with one parameter held, on one side of a minimum. Keeps a reference to the problem.
class HeldFits {
 public:
  /// direction: 1 or -1, that of the coordinate.
  HeldFits(const ProfileProblem& problem, std::size_t index, double direction,
           const Coordinate& coordinate);

  /// The fit at `distance`, sought from its neighbour nearer to the minimum (and from one `beyond`)
  /// and, where it does not settle or z jumps, from elsewhere.
  HeldFit fit_at(double distance, const HeldFit& start_fit, const HeldFit* beyond = nullptr);
  /// From the nonlinear parameters of a neighbour.
  HeldFit fit_beside(double distance, const HeldFit& neighbour) {
    return descend(distance, solved(distance, neighbour.p));
  }
  /// Improves a fit from the model's own starts with this parameter held.
  void search(HeldFit& fit);
  /// Takes over what is lower, or as low and settled; true where it is lower by what matters.
  bool improve(HeldFit& fit, const HeldFit& candidate) const;

  double parameter(double distance) const {
    return coordinate_.to_parameter(centre_ + direction_ * distance);
  }
  const Coordinate& coordinate() const { return coordinate_; }
  double centre() const { return centre_; }
  double direction() const { return direction_; }
  /// The largest value that rounding leaves a meaning.
  double largest() const { return largest_; }
  /// A change of z that is more than the solver's tolerance.
  double noticeable() const { return noticeable_; }
  /// Parameters of a lower cost than the minimum's, where one was met.
  const std::optional<ParameterValues>& better() const { return better_; }

 private:
  HeldFit descend(double distance, ParameterValues guess);
  HeldFit held(double distance, const ParameterValues& guess, const std::vector<bool>& free) const;
  HeldFit in_order(HeldFit fit) const;
  bool has_digits(const ParameterValues& p) const;
  ParameterValues line(double distance, const HeldFit& start_fit) const;
  ParameterValues interpolated(double distance, const HeldFit& low, const HeldFit& high) const;
  ParameterValues solved(double distance, ParameterValues p) const;

  const ProfileProblem& problem_;
  std::size_t index_;
  double direction_;
  Coordinate coordinate_;
  double centre_;
  std::vector<bool> free_;  // with this parameter held
  double largest_;
  bool ordered_;  // true if the minimum is in the law's order
  double noticeable_;
  std::optional<ParameterValues> better_;
};

}  // namespace jostle::inline fitting
