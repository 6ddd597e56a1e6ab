#include "engine/starts/pour_path.hpp"

#include <limits>

namespace jostle::inline engine {

namespace {

constexpr Vec3 vertical = {0, 0, 1};

Vec3 unit(Vec3 v) {
  return (1 / std::sqrt(norm_squared(v))) * v;
}

RollingArc directed(RollingArc arc, Vec3 p) {
  const Vec3 outward = (1 / arc.radius) * (p - arc.centre);
  if (dot(outward, arc.sideways) < 0) arc.sideways = -1.0 * arc.sideways;
  arc.start = std::min(1.0, dot(outward, arc.upward));
  return arc;
}

double sine(double cosine) {
  return std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
}

// Along the arc the (squared) gap to a sphere, flat wall or floor is constant - (sideways s + up
// h).
struct GapOnArc {
  double constant, sideways, upward;
};

GapOnArc gap_on(const RollingArc& arc, const Obstacle& obstacle) {
  if (obstacle.kind != Obstacle::Kind::sphere) {
    return {gap(obstacle, arc.centre), -arc.radius * dot(obstacle.anchor, arc.sideways),
            -arc.radius * dot(obstacle.anchor, arc.upward)};
  }
  const Vec3 offset = obstacle.anchor - arc.centre;
  return {arc.radius * arc.radius + norm_squared(offset) - obstacle.reach * obstacle.reach,
          2 * arc.radius * dot(offset, arc.sideways), 2 * arc.radius * dot(offset, arc.upward)};
}

struct OnCircle {
  double s, h;
};

// The points (s, h) of the whole circle where it enters the obstacle, and where it leaves it.
struct Chord {
  OnCircle entry, exit;
  bool most;  // more than half of the circle is inside
};

// Nothing if the circle never enters the obstacle.
std::optional<Chord> chord(const RollingArc& arc, const Obstacle& obstacle) {
  const auto [k, a, b] = gap_on(arc, obstacle);
  const double squared = a * a + b * b;
  if (!(squared > k * k)) return std::nullopt;
  const double half_chord = std::sqrt(squared - k * k);
  return Chord{{(k * a - b * half_chord) / squared, (k * b + a * half_chord) / squared},
               {(k * a + b * half_chord) / squared, (k * b - a * half_chord) / squared},
               k < 0};
}

bool at_most(double length, Vec3 v) {
  return norm_squared(v) < length * length;
}

bool contains(std::span<const Obstacle> set, const Obstacle& obstacle) {
  return std::find(set.begin(), set.end(), obstacle) != set.end();
}

// Half-angle parameter of a quarter circle: (sine, cosine) = (2 t, 1 - t^2) / (1 + t^2).
double half_angle(double s, double h) {
  return s / (1 + h);
}
OnCircle on_quarter(double t) {
  return {2 * t / (1 + t * t), (1 - t * t) / (1 + t * t)};
}

// Where the arc leaves the tube before it reaches the height `end` (a cosine).
std::optional<OnCircle> entry_into_tube(const RollingArc& arc, const Obstacle& tube, double end,
                                        double unit) {
  if (gap(tube, arc.centre) > arc.radius) return std::nullopt;
  const auto found = first_contact(
      half_angle(sine(arc.start), arc.start), half_angle(sine(end), end), unit,
      [&](double t) {
        const OnCircle crossing = on_quarter(t);
        return gap(tube, arc.point_at(crossing.s, crossing.h));
      },
      [&](double t, double length) {
        return std::min(t + length / (2 * arc.radius), half_angle(sine(end), end));
      });
  if (!found) return std::nullopt;
  return on_quarter(*found);
}

}  // namespace

RollingArc arc_on(const Obstacle& sphere, Vec3 p) {
  const Vec3 across = {p.x - sphere.anchor.x, p.y - sphere.anchor.y, 0};
  return directed({sphere.anchor, unit(across), vertical, sphere.reach, 1, 0}, p);
}

RollingArc arc_on(const Obstacle& sphere, const Obstacle& second, Vec3 p) {
  const double a = sphere.reach, b = second.reach;
  const Vec3 offset = second.anchor - sphere.anchor;
  const double squared = norm_squared(offset), length = std::sqrt(squared);
  const Vec3 axis = (1 / length) * offset;
  const Vec3 upward = unit(vertical - axis.z * axis);
  // The circle's centre is so far from the sphere's, towards the other; beyond either where the
  // sizes differ much.
  const double axial = 0.5 * (length + (a - b) * (a + b) / length);
  const bool alike = a == b;
  const Vec3 centre = alike ? 0.5 * (sphere.anchor + second.anchor) : sphere.anchor + axial * axis;
  const double radius = std::sqrt(alike ? a * a - 0.25 * squared : (a - axial) * (a + axial));
  // The share of the weight on the upper sphere vanishes where h up.z / radius = |axis.z| / lever,
  // the lever being the distance of the circle's centre from the lower one's.
  const double lever = axis.z > 0 ? axial : length - axial;
  const double end = lever > 0 ? std::min(1.0, radius * std::abs(axis.z) / (lever * upward.z)) : 0;
  return directed({centre, unit(cross(axis, vertical)), upward, radius, 1, end}, p);
}

RollingArc arc_along_wall(const Obstacle& sphere, const Obstacle& wall, Vec3 p) {
  const double distance = gap(wall, sphere.anchor);
  const Vec3 centre = sphere.anchor - distance * wall.anchor;
  const double radius = std::sqrt((sphere.reach - distance) * (sphere.reach + distance));
  return directed({centre, cross(wall.anchor, vertical), vertical, radius, 1, 0}, p);
}

Vec3 follow(const RollingArc& arc, Vec3 p, std::span<const Obstacle> obstacles,
            std::span<const Obstacle> supports, double unit) {
  constexpr double rounding = 1e-12;
  const double touching = 1e-10 * unit, grazing = 1e-6 * unit;
  OnCircle first = {sine(arc.end), arc.end};
  bool met = false;
  for (const Obstacle& obstacle : obstacles) {
    if (obstacle.kind == Obstacle::Kind::tube || contains(supports, obstacle)) continue;
    const auto cut = chord(arc, obstacle);
    if (!cut) continue;
    const OnCircle crossing = cut->entry;
    if (crossing.s < 0 || crossing.h <= first.h) continue;
    const bool is_behind = crossing.h > arc.start + rounding;
    const bool touched = obstacle.kind != Obstacle::Kind::floor && gap(obstacle, p) < touching;
    // The arc leaves a touched obstacle that is not in the way, but never the floor. Where the arc
    // bends into what it touches, rounding may put the entry behind p.
    const bool grazed =
        touched && !cut->most && at_most(grazing, arc.point_at(crossing.s, crossing.h) - p);
    if (grazed ? at_most(grazing, arc.point_at(cut->exit.s, cut->exit.h) - p)
               : is_behind && !(touched && cut->most))
      continue;
    first = is_behind ? OnCircle{sine(arc.start), arc.start} : crossing;
    met = true;
  }
  for (const Obstacle& obstacle : obstacles) {
    if (obstacle.kind != Obstacle::Kind::tube || contains(supports, obstacle)) continue;
    if (const auto crossing = entry_into_tube(arc, obstacle, first.h, unit)) {
      first = *crossing;
      met = true;
    }
  }
  Vec3 end = arc.point_at(first.s, first.h);
  if (!met && arc.end == 0) end.z = arc.centre.z;
  return end;
}

namespace {

// On the tube's surface around its axis: the direction is turned away from the sphere's own by the
// parameter x in [0, 2], a quarter turn for each unit, at most 2 radians a unit.
class TubePath {
 public:
  TubePath(const Obstacle& sphere, const Obstacle& tube, Vec3 p) : sphere_(sphere), tube_(tube) {
    const double ox = sphere.anchor.x - tube.anchor.x, oy = sphere.anchor.y - tube.anchor.y;
    offset_ = std::sqrt(ox * ox + oy * oy);
    toward_ = {ox / offset_, oy / offset_, 0};
    sideways_ = {-toward_.y, toward_.x, 0};
    const Vec3 outward = (1 / tube.reach) * (p - tube.anchor);
    if (dot(outward, sideways_) < 0) sideways_ = -1.0 * sideways_;
    start_ = parameter(std::clamp(dot(outward, toward_), -1.0, 1.0));
    const double level =
        (tube.reach * tube.reach + offset_ * offset_ - sphere.reach * sphere.reach) /
        (2 * tube.reach * offset_);
    reaches_bottom_ = !(level > -1);
    end_ = reaches_bottom_ ? 2 : parameter(std::min(level, 1.0));
  }

  double start() const { return start_; }
  double end() const { return end_; }
  bool reaches_bottom() const { return reaches_bottom_; }

  Vec3 point_at(double x) const {
    const OnCircle crossing = x <= 1 ? on_quarter(x) : turned(on_quarter(x - 1));
    Vec3 p = tube_.anchor + tube_.reach * (crossing.h * toward_ + crossing.s * sideways_);
    const double dx = p.x - sphere_.anchor.x, dy = p.y - sphere_.anchor.y;
    p.z = sphere_.anchor.z +
          std::sqrt(std::max(0.0, sphere_.reach * sphere_.reach - dx * dx - dy * dy));
    return p;
  }

  // A parameter after x within the given length of path.
  double advance(double x, double length) const {
    const double height = point_at(x).z;
    for (double step = length / (4 * tube_.reach);; step *= 0.5) {
      const double next = std::min(end_, x + step);
      if (height - point_at(next).z <= 0.5 * length || step < 1e-13) return next;
    }
  }

 private:
  static OnCircle turned(OnCircle crossing) { return {crossing.h, -crossing.s}; }
  static double parameter(double cosine) {
    return cosine >= 0 ? half_angle(sine(cosine), cosine) : 1 + half_angle(-cosine, sine(cosine));
  }

  Obstacle sphere_, tube_;
  Vec3 toward_, sideways_;
  double offset_ = 0, start_ = 0, end_ = 2;
  bool reaches_bottom_ = false;
};

}  // namespace

TubePathEnd follow_tube(const Obstacle& sphere, const Obstacle& tube, Vec3 p,
                        std::span<const Obstacle> obstacles, double unit) {
  const double touching = 1e-10 * unit;
  const TubePath path(sphere, tube, p);
  const auto free_distance = [&](double x) {
    const Vec3 position = path.point_at(x);
    double least = std::numeric_limits<double>::infinity();
    for (const Obstacle& obstacle : obstacles) {
      if (obstacle.kind == Obstacle::Kind::tube || obstacle == sphere) continue;
      least = std::min(least, gap(obstacle, position));
    }
    // A body that is touched at the start is being left: rounding may show a slightly closer
    // contact.
    return x == path.start() && least > -touching ? std::max(least, 0.0) : least;
  };
  const auto met = first_contact(path.start(), path.end(), unit, free_distance,
                                 [&](double x, double length) { return path.advance(x, length); });
  if (met) return {path.point_at(*met), false};
  TubePathEnd end = {path.point_at(path.end()), path.reaches_bottom()};
  if (!end.at_bottom) end.p.z = sphere.anchor.z;
  return end;
}

}  // namespace jostle::inline engine
