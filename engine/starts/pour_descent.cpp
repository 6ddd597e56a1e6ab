#include "engine/starts/pour_descent.hpp"

#include <algorithm>
#include <cmath>

#include "engine/starts/pour_path.hpp"

namespace jostle::inline engine {

namespace {

// Lengths are multiples of the bed's unit.
constexpr double touching = 1e-10;      // gap below which a contact is one
constexpr double deepest_graze = 1e-8;  // on the way; at rest nothing overlaps
constexpr double deepest_at_rest = 1e-12;
constexpr double no_push = 1e-9;  // share of the weight that counts as none
constexpr double tipping = 1e-7;  // sideways step off an unstable balance
constexpr int max_turns = 1000;
constexpr int max_tips = 20;  // one is enough to leave an unstable balance
constexpr Vec3 downward = {0, 0, -1};

// The contacts that steer a motion: none (free fall), one, or two.
struct Steering {
  bool moves = false;
  std::vector<std::size_t> contacts;
};

// True if a motion enters none of the obstacles, but for the slope `slack`; along their surface is
// no entering.
bool opens(Vec3 motion, const std::vector<Vec3>& outwards, double slack) {
  const double speed = std::sqrt(norm_squared(motion));
  const double tangential = 1e-3 * std::min(1e-6, speed) + slack * speed;
  return std::all_of(outwards.begin(), outwards.end(),
                     [&](Vec3 outward) { return dot(motion, outward) >= -tangential; });
}

// Gravity projected on the plane perpendicular to one contact; nothing if that contact pulls or
// the projection vanishes but for rounding.
constexpr double still = 1e-22;  // squared

std::optional<Vec3> slide(Vec3 outward) {
  const double push = -dot(downward, outward);
  const Vec3 motion = downward + push * outward;
  if (push <= 0 || norm_squared(motion) < still) return std::nullopt;
  return motion;
}

std::optional<Vec3> slide(Vec3 a, Vec3 b, double slack) {
  const double ab = dot(a, b), determinant = (1 - ab) * (1 + ab);
  if (determinant < 1e-14) return std::nullopt;
  const double ga = dot(downward, a), gb = dot(downward, b);
  const double push_a = (gb * ab - ga) / determinant, push_b = (ga * ab - gb) / determinant;
  const Vec3 motion = downward + push_a * a + push_b * b;
  // The line along both surfaces, level but for the rounding of `motion`: two contacts that face
  // each other, such as a wall and a sphere at the same height, make much of it.
  const Vec3 line = cross(a, b);
  if (line.z * line.z < still * norm_squared(line)) return std::nullopt;
  const double least = -no_push - slack;
  if (push_a < least || push_b < least || norm_squared(motion) < still) return std::nullopt;
  return motion;
}

// The projection on a cone is unique: the first set of contacts that gives an open direction. With
// slack several sets may; as many as `skip` are passed over.
Steering steer(const std::vector<Vec3>& outwards, double slack = 0, int skip = 0) {
  if (opens(downward, outwards, slack) && skip-- == 0) return {true, {}};
  for (std::size_t i = 0; i < outwards.size(); ++i) {
    const auto motion = slide(outwards[i]);
    if (motion && opens(*motion, outwards, slack) && skip-- == 0) return {true, {i}};
  }
  for (std::size_t i = 0; i < outwards.size(); ++i) {
    for (std::size_t j = i + 1; j < outwards.size(); ++j) {
      const auto motion = slide(outwards[i], outwards[j], slack);
      if (motion && opens(*motion, outwards, slack) && skip-- == 0) return {true, {i, j}};
    }
  }
  return {};
}

struct Turn {
  Vec3 p;
  bool rests = false;
};

// Up to the next turn of the path; nothing where it is degenerate.
std::optional<Turn> roll(const PourBed& bed, Vec3 p, const std::vector<Obstacle>& contacts,
                         const std::vector<std::size_t>& steering) {
  std::vector<Obstacle> supports;
  for (const std::size_t i : steering) supports.push_back(contacts[i]);
  // Spheres first.
  if (supports.size() == 2 && supports[0].kind != Obstacle::Kind::sphere) {
    std::swap(supports[0], supports[1]);
  }
  if (supports[0].kind != Obstacle::Kind::sphere) return std::nullopt;
  std::vector<Obstacle> obstacles;
  const Obstacle sphere = supports[0];
  const double unit = bed.unit();
  bed.gather(sphere.anchor, sphere.reach + 1e-9 * unit, obstacles);
  if (supports.size() == 1) return Turn{follow(arc_on(sphere, p), p, obstacles, supports, unit)};
  switch (supports[1].kind) {
    case Obstacle::Kind::sphere:
      return Turn{follow(arc_on(sphere, supports[1], p), p, obstacles, supports, unit)};
    case Obstacle::Kind::wall:
      return Turn{follow(arc_along_wall(sphere, supports[1], p), p, obstacles, supports, unit)};
    case Obstacle::Kind::floor:
      return std::nullopt;
    case Obstacle::Kind::tube:
      break;
  }
  const TubePathEnd end = follow_tube(sphere, supports[1], p, obstacles, unit);
  return Turn{end.p, end.at_bottom};
}

// True if a turn ends where it began, in front of something that p touches already.
bool stalls(const PourBed& bed, Vec3 p, const Turn& turn) {
  const double at_once = 1e-6 * bed.unit();
  return !turn.rests && norm_squared(turn.p - p) < at_once * at_once;
}

// A turn that gets away from p where the steepest one stalls: p rolls on some of its contacts along
// the surface of another, and their curvatures decide on which. Almost on top of a sphere that
// touches the tube as p does, the tube carries, too; where the normals of three contacts lie in one
// plane, so do two others of them.
std::optional<Turn> other_turn(const PourBed& bed, Vec3 p, const std::vector<Obstacle>& contacts,
                               const std::vector<Vec3>& outwards) {
  constexpr double slack = 1e-6;
  for (int skip = 0;; ++skip) {
    const Steering steering = steer(outwards, slack, skip);
    if (!steering.moves) return std::nullopt;
    if (steering.contacts.empty()) continue;
    const auto turn = roll(bed, p, contacts, steering.contacts);
    if (turn && !stalls(bed, p, *turn)) return turn;
  }
}

constexpr double least_push = 1e-9;  // push of a carrying contact, in weights

// True if three of these contacts enclose the vertical: each of them pushes.
bool carried(const std::vector<Vec3>& outwards) {
  for (std::size_t i = 0; i < outwards.size(); ++i) {
    for (std::size_t j = i + 1; j < outwards.size(); ++j) {
      const Vec3 ab = cross(outwards[i], outwards[j]);
      for (std::size_t k = j + 1; k < outwards.size(); ++k) {
        const Vec3 bc = cross(outwards[j], outwards[k]), ca = cross(outwards[k], outwards[i]);
        const double volume = dot(outwards[i], bc);
        if (std::abs(volume) > 1e-9 && bc.z / volume > least_push && ca.z / volume > least_push &&
            ab.z / volume > least_push)
          return true;
      }
    }
  }
  return false;
}

// Moves p onto the three contacts that carry the sphere, as near as rounding allows without an
// overlap.
Vec3 polished(Vec3 p, const std::vector<Obstacle>& contacts, double unit) {
  const double rounding = 4.4e-16 * (unit + std::abs(p.x) + std::abs(p.y) + p.z);
  const auto excess = [&](const Obstacle& contact, Vec3 position) {
    return gap(contact, position) - (contact.kind == Obstacle::Kind::wall ? 0 : rounding);
  };
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = i + 1; j < contacts.size(); ++j) {
      for (std::size_t k = j + 1; k < contacts.size(); ++k) {
        Vec3 solved = p;
        for (int step = 0; step < 3; ++step) {
          const Vec3 a = outward(contacts[i], solved), b = outward(contacts[j], solved),
                     c = outward(contacts[k], solved);
          const Vec3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
          const double volume = dot(a, bc);
          const bool carried = bc.z / volume > least_push && ca.z / volume > least_push &&
                               ab.z / volume > least_push;
          if (!(std::abs(volume) > 1e-9) || !carried) break;
          const double ga = excess(contacts[i], solved), gb = excess(contacts[j], solved),
                       gc = excess(contacts[k], solved);
          solved = solved - (1 / volume) * (ga * bc + gb * ca + gc * ab);
        }
        if (!(solved == p) && norm_squared(solved - p) < touching * (unit * unit)) return solved;
      }
    }
  }
  return p;
}

// The obstacles that a centre above the floor touches. Spheres stop on the floor, and never leave
// it.
std::vector<Obstacle> touched(const PourBed& bed, Vec3 p) {
  const double nearly = touching * bed.unit();
  std::vector<Obstacle> near;
  bed.gather(p, 2 * nearly, near);
  std::erase_if(near, [&](const Obstacle& obstacle) {
    return gap(obstacle, p) >= nearly || obstacle.kind == Obstacle::Kind::floor;
  });
  return near;
}

std::optional<Vec3> at_rest(const PourBed& bed, Vec3 p) {
  if (!bed.clear(p, deepest_at_rest * std::min(1.0, bed.unit()))) return std::nullopt;
  return p;
}

}  // namespace

std::optional<Vec3> open_direction(const std::vector<Vec3>& outwards) {
  constexpr double blocked = -1e-12;
  const auto open = [&](Vec3 tangent) {
    return std::none_of(outwards.begin(), outwards.end(),
                        [&](Vec3 outward) { return dot(tangent, outward) < blocked; });
  };
  // If any direction is open, so is one at the rim of a contact's half-plane.
  bool level = true;
  for (const Vec3& outward : outwards) {
    const double length = std::sqrt(outward.x * outward.x + outward.y * outward.y);
    if (length < 1e-12) continue;
    level = false;
    const Vec3 tangent = {-outward.y / length, outward.x / length, 0};
    if (open(tangent)) return tangent;
    if (open(-1.0 * tangent)) return -1.0 * tangent;
  }
  if (level) return Vec3{1, 0, 0};
  return std::nullopt;
}

std::optional<Vec3> descend(const PourBed& bed, Vec3 p) {
  std::vector<Vec3> outwards;
  const double unit = bed.unit(), floor = bed.radius();
  int tips = 0;  // since the centre moved otherwise
  Vec3 balanced;
  for (int turn = 0; turn < max_turns; ++turn) {
    p = bed.wrapped(p);
    if (p.z <= floor + deepest_at_rest * unit) {
      p.z = floor;
      return at_rest(bed, p);
    }
    const std::vector<Obstacle> contacts = touched(bed, p);
    outwards.clear();
    for (const Obstacle& contact : contacts) {
      if (gap(contact, p) < -deepest_graze * unit) return std::nullopt;
      outwards.push_back(outward(contact, p));
    }
    const Steering steering = steer(outwards);
    if (!steering.moves) {
      const auto open = open_direction(outwards);
      if (!open) return at_rest(bed, polished(p, contacts, unit));
      // In a tube, on a sphere at its axis, all places are equivalent.
      if (tips++ == 0) balanced = p;
      if (tips > max_tips) return at_rest(bed, balanced);
      p = p + (tipping * unit) * *open;
      continue;
    }
    tips = 0;
    if (steering.contacts.empty()) {
      p.z = bed.fall(p).value_or(floor);
      continue;
    }
    auto next = roll(bed, p, contacts, steering.contacts);
    if (next && stalls(bed, p, *next))
      next = other_turn(bed, p, contacts, outwards).value_or(*next);
    if (!next) return std::nullopt;
    if (next->rests) return at_rest(bed, next->p);
    // A slope within the tolerance of steer(), against what holds the sphere.
    if (next->p == p && carried(outwards)) return at_rest(bed, polished(p, contacts, unit));
    p = next->p;
  }
  return std::nullopt;
}

}  // namespace jostle::inline engine
