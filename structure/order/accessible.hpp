#pragma once

#include <optional>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/packing.hpp"
#include "engine/bed/window.hpp"

// Where centres may lie, and how much of it two centres a given displacement apart can use. Lengths
// in diameters.
namespace jostle::inline structure {

/// The heights between which centres of a bed may lie: from 1/2 above the floor, or lower where
/// soft spheres press into it, to 2<Z> - 1/2, or the highest centre below that. None of them where
/// the box is periodic upwards.
HeightWindow accessible_heights(const Packing& packing);

/// The part of the footprint where centres may lie: at least 1/2 from walls (less where soft
/// spheres press into them), all of it where sides are periodic.
class AccessibleFootprint {
 public:
  explicit AccessibleFootprint(const Packing& packing);

  double area() const { return area_; }
  /// Distance of a point from the nearest place beside it where no centre may be, negative outside;
  /// infinite where sides are periodic.
  double depth(double x, double y) const;
  /// Area of the points from which the displacement leads to a point of the footprint, over the
  /// whole area: in [0, 1]. A periodic direction admits displacements of up to half a period.
  double overlap(double dx, double dy) const;

 private:
  friend class FootprintShares;

  Boundary boundary_;
  double low_x_ = 0, high_x_ = 0, low_y_ = 0, high_y_ = 0;
  double radius_ = 0;  // radius of a cylinder
  double area_ = 0;
};

/// Values at even steps from -reach to reach, looked up in the step that a place falls in.
class StepTable {
 public:
  static constexpr double step = 1e-3;

  StepTable() = default;
  explicit StepTable(double reach);
  double& value(std::size_t k) { return values_[k]; }
  double middle(std::size_t k) const { return (static_cast<double>(k) + 0.5) * step - reach_; }
  std::size_t size() const { return values_.size(); }
  double operator()(double place) const {
    return values_[static_cast<std::size_t>((place + reach_) * (1 / step))];
  }

 private:
  double reach_ = 0;
  std::vector<double> values_;
};

/// Share of the ascending coordinates that a displacement takes to a place in [low, high].
StepTable shares_inside(const std::vector<double>& coordinates, double low, double high,
                        double reach);

/// The overlap that centres have: the share of them that a displacement leaves in the accessible
/// footprint. It differs from that of evenly spread points where centres crowd at the sides.
class FootprintShares {
 public:
  /// Displacements whose parts along x and y are at most `reach`.
  FootprintShares(const AccessibleFootprint& footprint, const std::vector<Vec3>& centres,
                  double reach);
  /// `overlap`: the footprint's of that displacement, which is that of centres where sides are
  /// periodic. Between walls the shares along x and y are taken for independent.
  double operator()(double dx, double dy, double overlap) const;
  /// The share of all centres but two: those that are the displacement apart, of which the latter
  /// is at (x, y). A pair at a displacement has it inside by itself.
  double without_pair(double dx, double dy, double overlap, double x, double y) const;
  std::size_t n_centres() const { return n_centres_; }

 private:
  void fill_disc(const AccessibleFootprint& footprint, const std::vector<Vec3>& centres);

  AccessibleFootprint footprint_;
  ContainerShape shape_;
  std::size_t n_centres_;
  StepTable x_, y_;  // along a direction between planes
  // In a cylinder, at even steps along x and y from -reach_ on.
  double reach_ = 0, step_ = 0;
  std::size_t n_steps_ = 0;
  std::vector<double> disc_;
};

/// Unit vectors that are evenly spread over all directions, on a Fibonacci spiral.
std::vector<Vec3> even_directions(int n);

/// The part of spheres around a centre in the region of possible centres of partners: at least the
/// radius of a partner from floor and walls.
class ShellPart {
 public:
  explicit ShellPart(const Container& container);
  /// In (0, 1], by 500 directions; 1 of a sphere that no side cuts.
  double operator()(Vec3 centre, double radius, double partner_radius = sphere_radius) const;

 private:
  Boundary boundary_;
  std::vector<Vec3> directions_;
};

}  // namespace jostle::inline structure
