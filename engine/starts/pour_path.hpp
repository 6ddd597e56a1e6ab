#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "engine/starts/pour_bed.hpp"

// The curves along which a poured sphere rolls, always downwards. Points of a circle are kept as
// (sine, cosine) pairs of algebraic numbers: no trigonometric function is ever evaluated, so that
// every machine finds the same bits.
namespace jostle::inline engine {

/// Rolling on one sphere, on two, or on a sphere and a flat wall: the quarter
/// centre + radius (s sideways + h up), s = sqrt(1 - h^2), from h = start down to h = end >= 0,
/// where a support is lost.
struct RollingArc {
  Vec3 centre, sideways, upward;  // sideways is horizontal, up has z > 0; unit vectors
  double radius = 1;
  double start = 1, end = 0;

  Vec3 point_at(double s, double h) const { return centre + radius * (s * sideways + h * upward); }
};

/// The arc on one sphere from p, which touches it from above and not exactly on its top.
RollingArc arc_on(const Obstacle& sphere, Vec3 p);
/// The arc on two spheres, of the same size or not.
RollingArc arc_on(const Obstacle& sphere, const Obstacle& second, Vec3 p);
/// The arc on a sphere along a flat wall.
RollingArc arc_along_wall(const Obstacle& sphere, const Obstacle& wall, Vec3 p);

/// Where the arc from p ends: at the first of the obstacles it runs into, or where a support is
/// lost. Obstacles in `supports` are ignored. Tolerances are multiples of the length `unit`.
Vec3 follow(const RollingArc& arc, Vec3 p, std::span<const Obstacle> obstacles,
            std::span<const Obstacle> supports, double unit);

/// The end of a path along a curved side.
struct TubePathEnd {
  Vec3 p;
  bool at_bottom = false;  // the lowest point of the curve, where the sphere rests
};

/// Like the path on two spheres, while touching a sphere and the tube: a curve that is no circle.
TubePathEnd follow_tube(const Obstacle& sphere, const Obstacle& tube, Vec3 p,
                        std::span<const Obstacle> obstacles, double unit);

/// First parameter in [from, to] beyond which `gap` is negative; nothing if it never is. `advance`
/// gives a later parameter (at most `end`) reached by at most the given length of path, so that no
/// contact is stepped over but for grazes a billionth of a `unit` deep.
template <class Gap, class Advance>
std::optional<double> first_contact(double begin, double end, double unit, Gap&& gap,
                                    Advance&& advance) {
  const double least_step = 1e-4 * unit;
  constexpr int bisections = 60;
  double position = begin;
  while (position < end) {
    double next = advance(position, std::max(gap(position), least_step));
    if (gap(next) < 0) {
      for (int i = 0; i < bisections; ++i) {
        const double middle = 0.5 * (position + next);
        (gap(middle) < 0 ? next : position) = middle;
      }
      return position;
    }
    position = next;
  }
  return std::nullopt;
}

}  // namespace jostle::inline engine
