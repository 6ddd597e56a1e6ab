#include "engine/starts/pour_bed.hpp"

#include <algorithm>
#include <cmath>

namespace jostle::inline engine {

namespace {

// A clearance this small leaves a centre no room to roll: it is held in the middle.
constexpr double least_room = 1e-6;

// Walls that keep a centre in [1/2, width - 1/2] along one direction, or, in a tube too narrow to
// roll in, on its axis.
void add_walls(std::vector<Obstacle>& walls, Vec3 along, double width, bool on_axis) {
  double low = sphere_radius, high = width - sphere_radius;
  if (on_axis || high - low < least_room) low = high = 0.5 * width;
  walls.push_back({Obstacle::Kind::wall, along, low});
  walls.push_back({Obstacle::Kind::wall, -1.0 * along, -high});
}

}  // namespace

double gap(const Obstacle& obstacle, Vec3 p) {
  switch (obstacle.kind) {
    case Obstacle::Kind::sphere:
      return std::sqrt(norm_squared(p - obstacle.at)) - 1;
    case Obstacle::Kind::wall:
      return dot(obstacle.at, p) - obstacle.reach;
    case Obstacle::Kind::tube:
      break;
  }
  const double dx = p.x - obstacle.at.x, dy = p.y - obstacle.at.y;
  return obstacle.reach - std::sqrt(dx * dx + dy * dy);
}

Vec3 outward(const Obstacle& obstacle, Vec3 p) {
  if (obstacle.kind == Obstacle::Kind::wall) return obstacle.at;
  Vec3 away = p - obstacle.at;
  if (obstacle.kind == Obstacle::Kind::tube) away = {-away.x, -away.y, 0};
  const double length = std::sqrt(norm_squared(away));
  return length > 0 ? (1 / length) * away : Vec3{};
}

PourBed::PourBed(const Container& container, std::uint32_t n_spheres)
    : boundary_(container), cells_(container, n_spheres, 0) {
  const double axis = boundary_.axis(), reach = axis - sphere_radius;
  if (boundary_.tube && reach >= least_room) {
    tube_ = Obstacle{Obstacle::Kind::tube, {axis, axis, 0}, reach};
    return;
  }
  if (!boundary_.periodic_x) add_walls(walls_, {1, 0, 0}, boundary_.width_x, boundary_.tube);
  if (!boundary_.periodic_y) add_walls(walls_, {0, 1, 0}, boundary_.width_y, boundary_.tube);
}

Vec3 PourBed::wrapped(Vec3 p) const {
  return jostle::wrapped(boundary_, p);
}

void PourBed::gather(Vec3 p, double distance, std::vector<Obstacle>& found) const {
  found = walls_;
  if (tube_) found.push_back(*tube_);
  const double squared = distance * distance;
  cells_.any_near(p, distance, [&](std::uint32_t, Vec3 image) {
    if (norm_squared(image - p) <= squared) found.push_back({Obstacle::Kind::sphere, image, 0});
    return false;
  });
}

std::optional<double> PourBed::fall(Vec3 p) const {
  constexpr double touching = 1e-10, window = 2;
  double best = 0;
  // Windows of centres' heights from p downwards; a centre lower than z is touched below z + 1.
  for (double high = std::min(p.z, top_ + touching); high > 0 && best < high + 1; high -= window) {
    const Vec3 low_corner = {p.x - 1, p.y - 1, high - window};
    cells_.any_in(low_corner, {p.x + 1, p.y + 1, high}, [&](std::uint32_t, Vec3 image) {
      const double dx = p.x - image.x, dy = p.y - image.y, across = dx * dx + dy * dy;
      if (across >= 1 || image.z >= p.z) return false;
      const bool left_behind = std::sqrt(norm_squared(p - image)) - 1 < touching;
      if (!left_behind) best = std::max(best, image.z + std::sqrt(1 - across));
      return false;
    });
  }
  if (best <= sphere_radius) return std::nullopt;
  return std::min(best, p.z);
}

void PourBed::keep_between_walls(Vec3& p) const {
  for (const Obstacle& side : walls_) {
    if (side.at.x != 0 && gap(side, p) < 0) p.x = side.reach / side.at.x;
    if (side.at.y != 0 && gap(side, p) < 0) p.y = side.reach / side.at.y;
  }
}

// One round of projections on the half-spaces that the overlapped spheres leave open.
bool PourBed::push_out(Vec3& p) const {
  p = wrapped(p);
  const double beyond_rounding = 2.3e-16 * (1 + p.x + p.y + p.z);
  const Vec3 probe = p;
  bool pushed = false;
  cells_.any_near(probe, 1 + 1e-9, [&](std::uint32_t sphere, Vec3) {
    const Vec3 apart = separation(boundary_, p, cells_.centres()[sphere]);
    const double squared = norm_squared(apart);
    if (squared >= 1) return false;
    p = p + (1 - std::sqrt(squared) + beyond_rounding) * apart;
    pushed = true;
    return false;
  });
  return pushed || !clear_of_boundaries(boundary_, p);
}

bool PourBed::clear(Vec3& p, double tolerance) const {
  constexpr int max_passes = 100;
  for (int pass = 0; pass < max_passes && push_out(p); ++pass) {
    p.z = std::max(p.z, sphere_radius);
    keep_between_walls(p);
    if (tube_ && gap(*tube_, p) <= 0) {
      const double shrink = 1 - 2e-16 + gap(*tube_, p) / tube_->reach;
      p.x = tube_->at.x + shrink * (p.x - tube_->at.x);
      p.y = tube_->at.y + shrink * (p.y - tube_->at.y);
    }
  }
  p = wrapped(p);
  std::vector<Obstacle> near;
  gather(p, 1, near);
  return std::all_of(near.begin(), near.end(),
                     [&](const Obstacle& obstacle) { return gap(obstacle, p) >= -tolerance; });
}

std::optional<Vec3> PourBed::above(double share_x, double share_y) const {
  const double margin_x = boundary_.margin_x(), margin_y = boundary_.margin_y();
  Vec3 p = {margin_x + share_x * (boundary_.width_x - 2 * margin_x),
            margin_y + share_y * (boundary_.width_y - 2 * margin_y), top_ + 2};
  keep_between_walls(p);
  if (tube_ && gap(*tube_, p) < 0) return std::nullopt;
  return wrapped(p);
}

void PourBed::add(Vec3 centre) {
  cells_.insert(centre);
  top_ = std::max(top_, centre.z);
}

}  // namespace jostle::inline engine
