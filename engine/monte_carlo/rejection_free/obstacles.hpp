#pragma once

#include <cassert>
#include <cstdint>

#include "engine/monte_carlo/kernel/four_floats.hpp"
#include "engine/monte_carlo/kernel/packed_centre.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_kernels.hpp"

// The part of rejection_free_kernels.cpp that looks around a sphere. Included there alone: compiled
// once for every instruction set.
//
// A step d takes the centre of a sphere from 0 to d. A sphere at r, s being the sum of both radii,
// rejects it where |r - d|^2 < s^2. All lengths of a pair are divided by its s, so that every pair
// is one of spheres of diameter 1: equal spheres have s = 1 anyway. c = |r|^2 / s^2 - 1 is the
// square of the tangent from the centre to the sphere of radius s.
namespace jostle::inline engine::JOSTLE_KERNELS {

namespace {

// Four numbers, of four spheres or the coordinates of one.
using Four = FourFloats;
using FourIntegers = std::int32_t __attribute__((vector_size(16), may_alias));

inline FourIntegers lanes_of(const GridPlace& place) {
  return *reinterpret_cast<const FourIntegers*>(&place);
}

// Number of spheres per group.
constexpr std::size_t group = 8;

// Obstacles of a group of spheres: r, relative to each centre, and s.
struct Obstacles {
  static constexpr std::uint32_t size = group * (most_in_the_way + Planes::most) + 4;
  std::uint32_t n = 0;
  alignas(16) float r[size][4];
};

// Another position relative to a sphere's own, and s. All use one arithmetic for obstacles.
// Differences wrap around, as places do through periodic sides.
template <class Spheres>
inline Four seen_from(const ObstacleLimits& limits, FourIntegers own, FourIntegers neighbour) {
  using Wrapping = std::uint32_t __attribute__((vector_size(16)));
  auto difference = (FourIntegers)((Wrapping)neighbour - (Wrapping)own);
  const Four unit = *reinterpret_cast<const Four*>(limits.unit);
  if constexpr (!Spheres::several) return __builtin_convertvector(difference, Four) * unit;
  constexpr FourIntegers radius = {0, 0, 0, -1}, position = {-1, -1, -1, 0};
  const Four s = (Four)(own & radius) + (Four)(neighbour & radius);
  return __builtin_convertvector(difference & position, Four) * unit + s;
}

// s of four pairs, its inverse, and the number by which a margin of c grows: the grid and the
// radii err by lengths, which count for more where s is small.
template <class Spheres>
struct Scale {
  static constexpr float s = 1, inverse = 1, coarser = 1;
  explicit Scale(Four) {}
};
template <>
struct Scale<SeveralSizes> {
  Four s, inverse, coarser;
  explicit Scale(Four sums) : s(sums), inverse(1.0f / sums) {
    coarser = inverse > 1.0f ? inverse : Four{} + 1.0f;
  }
};

// c of four pairs, rounded up; > 0. |r| / s is at most 1.3: the roundings of this expression come
// to less than 21 x 2^-24, and those of the places to less than 5 steps of the grid over s.
template <class Spheres>
inline Four tangent_squared(Four x, Four y, Four z, const Scale<Spheres>& scale, float margin) {
  const Four squared = x * x + y * y + z * z;
  return (squared - scale.s * scale.s) * (scale.inverse * scale.inverse) + margin * scale.coarser;
}

// The greatest c of an obstacle.
template <class Spheres>
inline auto farthest(const ObstacleLimits& limits, const Scale<Spheres>& scale) {
  if constexpr (!Spheres::several) {
    return limits.farthest;
  } else {
    const Four c =
        (limits.farthest_per_s + limits.farthest_per_s_squared * scale.inverse) * scale.inverse;
    const Four most = Four{} + limits.most_c, none = Four{};
    return scale.s > limits.least_s ? (c < most ? c : most) : none;
  }
}

// Tests four for obstacles, one bit each.
template <class Spheres>
inline unsigned in_the_way(const ObstacleLimits& limits, const Four (&r)[4]) {
  Four x = r[0], y = r[1], z = r[2], s = r[3];
  transpose(x, y, z, s);
  const Scale<Spheres> scale(s);
  const auto counts =
      (tangent_squared<Spheres>(x, y, z, scale, limits.margin) < farthest<Spheres>(limits, scale)) &
      (z > -limits.highest * scale.s);
  return bits_of_four(counts);
}

// A list: its length, then the spheres.
template <class Spheres>
inline const std::uint32_t* list_of(const SphereLists& sphere_lists, std::uint32_t i) {
  if constexpr (Spheres::several) return sphere_lists.lists + sphere_lists.offsets[i];
  return sphere_lists.lists + i * sphere_lists.stride;
}

// Four of a list, from place m to `last` at most.
struct ListedFour {
  std::uint32_t sphere[4];
  unsigned mask;  // those that are listed; the others repeat the last
};
inline ListedFour listed_from(const std::uint32_t* list, std::uint32_t m, std::uint32_t last) {
  ListedFour four;
  for (std::uint32_t k = 0; k < 4; ++k) four.sphere[k] = list[m + k < last ? m + k : last];
  four.mask = last - m < 3 ? (2u << (last - m)) - 1 : 15;
  return four;
}

// Adds the obstacles of sphere i among places `first` to `last` of its list.
template <class Spheres>
inline void look_around(const ObstacleLimits& limits, const SphereLists& sphere_lists,
                        std::uint32_t i, const std::uint32_t* list, std::uint32_t first,
                        std::uint32_t last, Obstacles& seen) {
  const FourIntegers own = lanes_of(sphere_lists.places[i]);
  std::uint32_t n = seen.n;
  for (std::uint32_t m = first; m <= last; m += 4) {
    const ListedFour four = listed_from(list, m, last);
    Four r[4];
    for (int k = 0; k < 4; ++k) {
      r[k] = seen_from<Spheres>(limits, own, lanes_of(sphere_lists.places[four.sphere[k]]));
    }
    const unsigned counts = in_the_way<Spheres>(limits, r) & four.mask;
    for (int k = 0; k < 4; ++k) {
      *reinterpret_cast<Four*>(seen.r[n]) = r[k];
      n += counts >> k & 1;  // no branch: it could not be guessed
    }
    assert(n <= seen.n + most_in_the_way);
  }
  seen.n = n;
}

template <class Spheres>
std::uint32_t seen_by(const ObstacleLimits& limits, const SphereLists& sphere_lists,
                      std::uint32_t i, const GridPlace& former, std::uint32_t* seeing) {
  const std::uint32_t* const list = list_of<Spheres>(sphere_lists, i);
  const FourIntegers old_place = lanes_of(former), now = lanes_of(sphere_lists.places[i]);
  std::uint32_t n = 0;
  for (std::uint32_t m = 1; m <= list[0]; m += 4) {
    const ListedFour four = listed_from(list, m, list[0]);
    Four r_before[4], r_now[4];
    for (int k = 0; k < 4; ++k) {
      const FourIntegers own = lanes_of(sphere_lists.places[four.sphere[k]]);
      r_before[k] = seen_from<Spheres>(limits, own, old_place);
      r_now[k] = seen_from<Spheres>(limits, own, now);
    }
    const unsigned counts =
        (in_the_way<Spheres>(limits, r_before) | in_the_way<Spheres>(limits, r_now)) & four.mask;
    for (int k = 0; k < 4; ++k) {
      seeing[n] = four.sphere[k];
      n += counts >> k & 1;
    }
  }
  return n;
}

// |r - d|^2 / s^2 is compared with 1 after a step d. Four at a time, so that the answer is that of
// the nearest of them all.
template <class Spheres>
class StepResolver;

template <>
class StepResolver<EqualSpheres> {
 public:
  explicit StepResolver(const ObstacleLimits& limits) : doubt_(limits.doubt) {}
  void see(Four squared, Four) { nearest_ = squared < nearest_ ? squared : nearest_; }
  bool blocked() const { return any_of_four(nearest_ < 1.0f - doubt_); }
  bool unsure() const { return any_of_four(nearest_ < 1.0f + doubt_); }

 private:
  Four nearest_ = {2, 2, 2, 2};
  float doubt_;
};

template <>
class StepResolver<SeveralSizes> {
 public:
  explicit StepResolver(const ObstacleLimits& limits) : doubt_(limits.doubt) {}
  // Doubt is twice the margin times 1 + |d| / s.
  void see(Four squared, Four s) {
    const Scale<SeveralSizes> scale(s);
    const Four ratio = squared * (scale.inverse * scale.inverse);
    const Four doubt = doubt_ * (scale.coarser * scale.coarser);
    blocked_ |= ratio < 1.0f - doubt;
    unsure_ |= ratio < 1.0f + doubt;
  }
  bool blocked() const { return any_of_four(blocked_); }
  bool unsure() const { return any_of_four(unsure_); }

 private:
  FourMask blocked_ = {}, unsure_ = {};
  float doubt_;
};

template <class Spheres>
StepOutcome try_step(const ObstacleLimits& limits, const SphereLists& sphere_lists, std::uint32_t i,
                     double dx, double dy, double dz) {
  const std::uint32_t* const list = list_of<Spheres>(sphere_lists, i);
  const FourIntegers own = lanes_of(sphere_lists.places[i]);
  const Four step = {static_cast<float>(dx), static_cast<float>(dy), static_cast<float>(-dz), 0};
  StepResolver<Spheres> resolver(limits);
  for (std::uint32_t m = 1; m <= list[0]; m += 4) {
    const ListedFour four = listed_from(list, m, list[0]);
    Four r[4];
    for (int k = 0; k < 4; ++k) {
      r[k] = seen_from<Spheres>(limits, own, lanes_of(sphere_lists.places[four.sphere[k]])) - step;
    }
    transpose(r[0], r[1], r[2], r[3]);
    resolver.see(r[0] * r[0] + r[1] * r[1] + r[2] * r[2], r[3]);
  }
  if (resolver.blocked()) return StepOutcome::blocked;
  return resolver.unsure() ? StepOutcome::unsure : StepOutcome::free;
}

}  // namespace

}  // namespace jostle::inline engine::JOSTLE_KERNELS
