#include "engine/starts/pour_descent.hpp"

#include <algorithm>
#include <cmath>

#include "engine/starts/pour_path.hpp"

namespace jostle::inline engine {

namespace {

constexpr double touching = 1e-10;      // gap below which a contact is one
constexpr double deepest_graze = 1e-8;  // on the way; at rest nothing overlaps
constexpr double deepest_at_rest = 1e-12;
constexpr double no_push = 1e-9;  // share of the weight that counts as none
constexpr double tipping = 1e-7;  // sideways step off an unstable balance
constexpr int max_turns = 1000;
constexpr Vec3 downward = {0, 0, -1};

// The contacts that steer a motion: none (free fall), one, or two.
struct Steering {
  bool moves = false;
  std::vector<std::size_t> contacts;
};

// Whether a motion enters none of the obstacles; along their surface is no entering.
bool opens(Vec3 motion, const std::vector<Vec3>& outwards) {
  const double tangential = 1e-3 * std::min(1e-6, std::sqrt(norm_squared(motion)));
  return std::all_of(outwards.begin(), outwards.end(),
                     [&](Vec3 out) { return dot(motion, out) >= -tangential; });
}

// Gravity projected on the plane perpendicular to one contact; nothing if that contact pulls or
// the projection vanishes but for rounding.
constexpr double still = 1e-22;  // squared

std::optional<Vec3> slide(Vec3 out) {
  const double push = -dot(downward, out);
  const Vec3 motion = downward + push * out;
  if (push <= 0 || norm_squared(motion) < still) return std::nullopt;
  return motion;
}

std::optional<Vec3> slide(Vec3 a, Vec3 b) {
  const double ab = dot(a, b), determinant = (1 - ab) * (1 + ab);
  if (determinant < 1e-14) return std::nullopt;
  const double ga = dot(downward, a), gb = dot(downward, b);
  const double push_a = (gb * ab - ga) / determinant, push_b = (ga * ab - gb) / determinant;
  const Vec3 motion = downward + push_a * a + push_b * b;
  if (push_a < -no_push || push_b < -no_push || norm_squared(motion) < still) {
    return std::nullopt;
  }
  return motion;
}

// The projection on a cone is unique: the first set of contacts that gives an open direction.
Steering steer(const std::vector<Vec3>& outwards) {
  if (opens(downward, outwards)) return {true, {}};
  for (std::size_t i = 0; i < outwards.size(); ++i) {
    const auto motion = slide(outwards[i]);
    if (motion && opens(*motion, outwards)) return {true, {i}};
  }
  for (std::size_t i = 0; i < outwards.size(); ++i) {
    for (std::size_t j = i + 1; j < outwards.size(); ++j) {
      const auto motion = slide(outwards[i], outwards[j]);
      if (motion && opens(*motion, outwards)) return {true, {i, j}};
    }
  }
  return {};
}

struct Turn {
  Vec3 p;
  bool rests = false;
};

// Up to the next turn of the path; nothing where it is degenerate.
std::optional<Turn> roll(const PourBed& bed, Vec3 p, std::vector<Obstacle> supports) {
  // Spheres first.
  if (supports.size() == 2 && supports[0].kind != Obstacle::Kind::sphere) {
    std::swap(supports[0], supports[1]);
  }
  if (supports[0].kind != Obstacle::Kind::sphere) return std::nullopt;
  constexpr double around_support = 2 + 1e-9;
  std::vector<Obstacle> obstacles;
  const Vec3 sphere = supports[0].at;
  bed.gather(sphere, around_support, obstacles);
  if (supports.size() == 1) return Turn{follow(arc_on(sphere, p), p, obstacles, supports)};
  switch (supports[1].kind) {
    case Obstacle::Kind::sphere:
      return Turn{follow(arc_on(sphere, supports[1].at, p), p, obstacles, supports)};
    case Obstacle::Kind::wall:
      return Turn{follow(arc_along_wall(sphere, supports[1], p), p, obstacles, supports)};
    case Obstacle::Kind::tube:
      break;
  }
  const TubePathEnd end = follow_tube(sphere, supports[1], p, obstacles);
  return Turn{end.p, end.at_bottom};
}

// Moves p onto the three contacts that carry the sphere, as near as rounding allows without an
// overlap.
Vec3 polished(Vec3 p, const std::vector<Obstacle>& contacts) {
  constexpr double least_push = 1e-9;
  const double rounding = 4.4e-16 * (1 + std::abs(p.x) + std::abs(p.y) + p.z);
  const auto excess = [&](const Obstacle& contact, Vec3 at) {
    return gap(contact, at) - (contact.kind == Obstacle::Kind::wall ? 0 : rounding);
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
        if (!(solved == p) && norm_squared(solved - p) < touching) return solved;
      }
    }
  }
  return p;
}

std::vector<Obstacle> touched(const PourBed& bed, Vec3 p) {
  std::vector<Obstacle> near;
  bed.gather(p, 1 + 2 * touching, near);
  std::erase_if(near, [&](const Obstacle& obstacle) { return gap(obstacle, p) >= touching; });
  return near;
}

std::optional<Vec3> at_rest(const PourBed& bed, Vec3 p) {
  if (!bed.clear(p, deepest_at_rest)) return std::nullopt;
  return p;
}

}  // namespace

std::optional<Vec3> open_direction(const std::vector<Vec3>& outwards) {
  constexpr double blocked = -1e-12;
  const auto open = [&](Vec3 aside) {
    return std::none_of(outwards.begin(), outwards.end(),
                        [&](Vec3 out) { return dot(aside, out) < blocked; });
  };
  // If any direction is open, so is one at the rim of a contact's half-plane.
  bool level = true;
  for (const Vec3& out : outwards) {
    const double length = std::sqrt(out.x * out.x + out.y * out.y);
    if (length < 1e-12) continue;
    level = false;
    const Vec3 aside = {-out.y / length, out.x / length, 0};
    if (open(aside)) return aside;
    if (open(-1.0 * aside)) return -1.0 * aside;
  }
  if (level) return Vec3{1, 0, 0};
  return std::nullopt;
}

std::optional<Vec3> descend(const PourBed& bed, Vec3 p) {
  std::vector<Vec3> outwards;
  for (int turn = 0; turn < max_turns; ++turn) {
    p = bed.wrapped(p);
    if (p.z <= sphere_radius + deepest_at_rest) {
      p.z = sphere_radius;
      return at_rest(bed, p);
    }
    const std::vector<Obstacle> contacts = touched(bed, p);
    outwards.clear();
    for (const Obstacle& contact : contacts) {
      if (gap(contact, p) < -deepest_graze) return std::nullopt;
      outwards.push_back(outward(contact, p));
    }
    const Steering steering = steer(outwards);
    if (!steering.moves) {
      const auto open = open_direction(outwards);
      if (!open) return at_rest(bed, polished(p, contacts));
      p = p + tipping * *open;
      continue;
    }
    if (steering.contacts.empty()) {
      p.z = bed.fall(p).value_or(sphere_radius);
      continue;
    }
    std::vector<Obstacle> supports;
    for (const std::size_t i : steering.contacts) supports.push_back(contacts[i]);
    const auto next = roll(bed, p, supports);
    if (!next) return std::nullopt;
    if (next->rests) return at_rest(bed, next->p);
    p = next->p;
  }
  return std::nullopt;
}

}  // namespace jostle::inline engine
