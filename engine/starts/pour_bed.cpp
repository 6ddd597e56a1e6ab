#include "engine/starts/pour_bed.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace jostle::inline engine {

namespace {

// A clearance this small, in smallest diameters, leaves a centre no room to roll: it is held in the
// middle.
constexpr double least_room = 1e-6;

// Walls that keep a centre in [radius, width - radius] along one direction, or, in a tube too
// narrow to roll in, on its axis.
void add_walls(std::vector<Obstacle>& walls, Vec3 direction, double width, double radius,
               double room, bool on_axis) {
  double low = radius, high = width - radius;
  if (on_axis || high - low < room) low = high = 0.5 * width;
  walls.push_back({Obstacle::Kind::wall, direction, low});
  walls.push_back({Obstacle::Kind::wall, -1.0 * direction, -high});
}

}  // namespace

double gap(const Obstacle& obstacle, Vec3 p) {
  switch (obstacle.kind) {
    case Obstacle::Kind::sphere:
      return std::sqrt(norm_squared(p - obstacle.anchor)) - obstacle.reach;
    case Obstacle::Kind::wall:
    case Obstacle::Kind::floor:
      return dot(obstacle.anchor, p) - obstacle.reach;
    case Obstacle::Kind::tube:
      break;
  }
  const double dx = p.x - obstacle.anchor.x, dy = p.y - obstacle.anchor.y;
  return obstacle.reach - std::sqrt(dx * dx + dy * dy);
}

Vec3 outward(const Obstacle& obstacle, Vec3 p) {
  if (obstacle.kind == Obstacle::Kind::wall || obstacle.kind == Obstacle::Kind::floor)
    return obstacle.anchor;
  Vec3 outward_vector = p - obstacle.anchor;
  if (obstacle.kind == Obstacle::Kind::tube)
    outward_vector = {-outward_vector.x, -outward_vector.y, 0};
  const double length = std::sqrt(norm_squared(outward_vector));
  return length > 0 ? (1 / length) * outward_vector : Vec3{};
}

PourBed::PourBed(const Container& container, std::uint32_t n_spheres) : boundary_(container) {
  levels_.push_back({SphereCells(container, n_spheres, 0), sphere_radius, {}});
  set_radius(sphere_radius);
}

PourBed::PourBed(const Container& container, std::shared_ptr<const Sizes> sizes)
    : boundary_(container), sizes_(std::move(sizes)), unit_(2 * sizes_->smallest_radius()) {
  std::vector<double> largest;
  std::vector<std::uint32_t> count;
  for (const double radius : sizes_->radii()) {
    std::uint32_t level = 0;
    for (double r = 0.5 * sizes_->largest_radius(); radius <= r; r *= 0.5) ++level;
    if (level >= largest.size()) {
      largest.resize(level + 1, 0);
      count.resize(level + 1, 0);
    }
    largest[level] = std::max(largest[level], radius);
    ++count[level];
    level_of_.push_back(level);
  }
  for (std::size_t level = 0; level < largest.size(); ++level) {
    // A level without spheres is never asked, its cells only have to exist.
    const double side = count[level] > 0 ? 2 * largest[level] : 2 * sizes_->largest_radius();
    levels_.push_back({SphereCells(container, count[level], 0, side), largest[level], {}});
  }
  set_radius(sizes_->smallest_radius());
}

void PourBed::set_radius(double radius) {
  radius_ = radius;
  walls_.clear();
  tube_.reset();
  const double axis = boundary_.axis(), reach = axis - radius, room = least_room * unit_;
  if (boundary_.tube && reach >= room) {
    tube_ = Obstacle{Obstacle::Kind::tube, {axis, axis, 0}, reach};
  } else {
    if (!boundary_.periodic_x)
      add_walls(walls_, {1, 0, 0}, boundary_.width_x, radius, room, boundary_.tube);
    if (!boundary_.periodic_y)
      add_walls(walls_, {0, 1, 0}, boundary_.width_y, radius, room, boundary_.tube);
  }
  if (sizes_ && radius > sizes_->smallest_radius())
    walls_.push_back({Obstacle::Kind::floor, {0, 0, 1}, radius});
}

void PourBed::next(std::uint32_t sphere) {
  next_ = sphere;
  if (sizes_ && sizes_->radius(sphere) != radius_) set_radius(sizes_->radius(sphere));
}

// Calls act(cells, reach) for the spheres of every level.
template <class Act>
void PourBed::for_each_level(const Act& act) const {
  if (!sizes_) return act(levels_.front().cells, EqualReach{});
  for (const Level& level : levels_)
    if (!level.radii.empty()) act(level.cells, SeveralReach{radius_, level});
}

Vec3 PourBed::wrapped(Vec3 p) const {
  return jostle::wrapped(boundary_, p);
}

void PourBed::gather(Vec3 p, double distance, std::vector<Obstacle>& found) const {
  constexpr std::size_t usual = 24;
  found.reserve(usual);
  found = walls_;
  if (tube_) found.push_back(*tube_);
  for_each_level([&](const SphereCells& cells, auto reach) {
    cells.any_near(p, reach.most() + distance, [&, distance](std::uint32_t index, Vec3 image) {
      const double touching = reach(index), farthest = touching + distance;
      if (norm_squared(image - p) <= farthest * farthest)
        found.push_back({Obstacle::Kind::sphere, image, touching});
      return false;
    });
  });
}

std::optional<double> PourBed::fall(Vec3 p) const {
  const double touching = 1e-10 * unit_;
  double best = 0;
  for_each_level([&](const SphereCells& cells, auto reach) {
    // Windows of centres' heights from p downwards; a centre lower than z is touched below z +
    // most.
    const double most = reach.most(), window = 2 * most;
    for (double high = std::min(p.z, top_ + touching); high > 0 && best < high + most;
         high -= window) {
      const Vec3 low_corner = {p.x - most, p.y - most, high - window};
      cells.any_in(
          low_corner, {p.x + most, p.y + most, high}, [&](std::uint32_t index, Vec3 image) {
            const double distance = reach(index);
            const double dx = p.x - image.x, dy = p.y - image.y, across = dx * dx + dy * dy;
            if (across >= distance * distance || image.z >= p.z) return false;
            const bool left_behind = std::sqrt(norm_squared(p - image)) - distance < touching;
            if (!left_behind)
              best = std::max(best, image.z + std::sqrt(distance * distance - across));
            return false;
          });
    }
  });
  if (best <= radius_) return std::nullopt;
  return std::min(best, p.z);
}

double PourBed::height_above_all() const {
  return top_ + 2 * (radius_ + (sizes_ ? sizes_->largest_radius() : sphere_radius));
}

void PourBed::keep_between_walls(Vec3& p) const {
  for (const Obstacle& side : walls_) {
    if (side.anchor.x != 0 && gap(side, p) < 0) p.x = side.reach / side.anchor.x;
    if (side.anchor.y != 0 && gap(side, p) < 0) p.y = side.reach / side.anchor.y;
  }
}

// One round of projections on the half-spaces that the overlapped spheres leave open.
bool PourBed::push_out(Vec3& p) const {
  p = wrapped(p);
  const Vec3 probe = p;
  bool pushed = false;
  for_each_level([&](const SphereCells& cells, auto reach) {
    cells.any_near(probe, reach.most() + 1e-9 * unit_, [&](std::uint32_t index, Vec3) {
      const double distance = reach(index);
      const Vec3 offset = separation(boundary_, p, cells.centres()[index]);
      const double squared = norm_squared(offset);
      if (squared >= distance * distance) return false;
      const double beyond_rounding = 2.3e-16 * (distance + probe.x + probe.y + probe.z);
      p = p + ((distance - std::sqrt(squared) + beyond_rounding) / distance) * offset;
      pushed = true;
      return false;
    });
  });
  return pushed || !clear_of_boundaries(boundary_, p, radius_);
}

bool PourBed::clear(Vec3& p, double tolerance) const {
  constexpr int max_passes = 100;
  for (int pass = 0; pass < max_passes && push_out(p); ++pass) {
    p.z = std::max(p.z, radius_);
    keep_between_walls(p);
    if (tube_ && gap(*tube_, p) <= 0) {
      const double shrink = 1 - 2e-16 + gap(*tube_, p) / tube_->reach;
      p.x = tube_->anchor.x + shrink * (p.x - tube_->anchor.x);
      p.y = tube_->anchor.y + shrink * (p.y - tube_->anchor.y);
    }
  }
  p = wrapped(p);
  std::vector<Obstacle> near;
  gather(p, 0, near);
  return std::all_of(near.begin(), near.end(),
                     [&](const Obstacle& obstacle) { return gap(obstacle, p) >= -tolerance; });
}

std::optional<Vec3> PourBed::drop_point_of_shares(double share_x, double share_y) const {
  const double margin_x = boundary_.periodic_x ? 0 : radius_,
               margin_y = boundary_.periodic_y ? 0 : radius_;
  Vec3 p = {margin_x + share_x * (boundary_.width_x - 2 * margin_x),
            margin_y + share_y * (boundary_.width_y - 2 * margin_y), height_above_all()};
  keep_between_walls(p);
  if (tube_ && gap(*tube_, p) < 0) return std::nullopt;
  return wrapped(p);
}

std::optional<Vec3> PourBed::drop_point(double x, double y) const {
  Vec3 p = {x, y, height_above_all()};
  if (!in_footprint(boundary_, p, radius_)) return std::nullopt;
  keep_between_walls(p);
  return into_periods(boundary_, p);
}

void PourBed::add(Vec3 centre) {
  Level& level = sizes_ ? levels_[level_of_[next_]] : levels_.front();
  level.cells.insert(centre);
  if (sizes_) level.radii.push_back(radius_);
  centres_.push_back(centre);
  top_ = std::max(top_, centre.z);
}

}  // namespace jostle::inline engine
