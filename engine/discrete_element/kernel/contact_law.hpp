#pragma once

#include <cstdint>

#include "engine/discrete_element/kernel/law_constants.hpp"

// The force of a contact, for one contact (N = double) or for as many as vectors of doubles have
// room for (N = Wide, kernel/lanes.hpp): the same operations in the same order, so the same bits.
// All of it is inlined, for it is compiled once for every instruction set. Lengths in diameters,
// masses in sphere masses, times in sqrt(diameter / gravity).
namespace jostle::inline engine {

#define JOSTLE_INLINE [[gnu::always_inline]] inline

// What Wide has, too, for one number.
JOSTLE_INLINE double select(bool mask, double yes, double no) {
  return mask ? yes : no;
}
JOSTLE_INLINE bool any_of(bool mask) {
  return mask;
}
JOSTLE_INLINE double square_root(double x) {
  return __builtin_sqrt(x);
}
/// A third of the exponent, and of what follows it: within 6 % of the cube root of x > 0.
JOSTLE_INLINE double cube_root_guess(double x) {
  const std::int64_t high = __builtin_bit_cast(std::int64_t, x) >> 32;
  return __builtin_bit_cast(double, (((high * 0x55555556) >> 32) + 715094163) << 32);
}

template <class N>
struct Vector3 {
  N x, y, z;
};

template <class N>
JOSTLE_INLINE Vector3<N> operator+(const Vector3<N>& a, const Vector3<N>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class N>
JOSTLE_INLINE Vector3<N> operator-(const Vector3<N>& a, const Vector3<N>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class N>
JOSTLE_INLINE Vector3<N> scaled(const N& s, const Vector3<N>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class N>
JOSTLE_INLINE N dot(const Vector3<N>& a, const Vector3<N>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class N>
JOSTLE_INLINE Vector3<N> cross(const Vector3<N>& a, const Vector3<N>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The vector where the mask is set, else 0.
template <class Mask, class N>
JOSTLE_INLINE Vector3<N> masked(const Mask& mask, const Vector3<N>& a) {
  const N zero{};
  return {select(mask, a.x, zero), select(mask, a.y, zero), select(mask, a.z, zero)};
}

template <class N>
JOSTLE_INLINE N lesser(const N& a, const N& b) {
  return select(a < b, a, b);
}
template <class N>
JOSTLE_INLINE N greater(const N& a, const N& b) {
  return select(a > b, a, b);
}

/// The cube root of x in [1e-300, 1] to 1e-14: Halley's method, from a guess good to 6 %.
template <class N>
JOSTLE_INLINE N cube_root_of(const N& x) {
  N root = cube_root_guess(x);
  for (int step = 0; step < 2; ++step) {
    const N cube = root * root * root;
    root = root * ((cube + 2.0 * x) / (2.0 * cube + x));
  }
  return root;
}

/// Where two bodies meet: sphere i, and sphere j or a side.
template <class N>
struct Meeting {
  Vector3<N> normal;    // from the other body to sphere i
  N overlap;            // positive where they touch
  Vector3<N> arm;       // from the contact to the centre of sphere i
  Vector3<N> velocity;  // of sphere i relative to the other body, of the centres
  Vector3<N> spin;      // sum of the spins
};

/// What acts on sphere i, and what the contact dissipated in the step: on the other body acts the
/// opposite force and, where it is a sphere, the same torque.
template <class N>
struct ContactAction {
  Vector3<N> force, torque;
  N dissipated_by_friction, dissipated_normally;
};

/// The relative velocity of the surfaces where they meet, along the tangent plane.
template <class N>
JOSTLE_INLINE Vector3<N> sliding_velocity(const Meeting<N>& at) {
  const Vector3<N> surface = at.velocity - cross(at.spin, at.arm);
  return surface - scaled(dot(surface, at.normal), at.normal);
}

/// A force in the tangent plane, by its length and direction; without any, the direction is 0.
template <class N>
struct TangentialForce {
  Vector3<N> force, along;
  N length;
};

/// The force `old`, which lay in the tangent plane of the step before, turned with the pair: by the
/// mean spin about the normal, then by projection into the present plane, which shortens it.
template <class N>
JOSTLE_INLINE Vector3<N> projected(const Vector3<N>& old, const Meeting<N>& at, double time_step) {
  const N twist = (0.5 * time_step) * dot(at.spin, at.normal);
  const Vector3<N> spun = old + scaled(twist, cross(at.normal, old));
  return spun - scaled(dot(spun, at.normal), at.normal);
}

/// The same, with the length that it had.
template <class N>
JOSTLE_INLINE TangentialForce<N> turned(const Vector3<N>& old, const Meeting<N>& at,
                                        double time_step) {
  const N zero{};
  const N length = square_root(dot(old, old));
  const Vector3<N> plane = projected(old, at, time_step);
  const N plane2 = dot(plane, plane);
  const N inverse = 1.0 / square_root(select(plane2 > zero, plane2, zero + 1.0));
  const Vector3<N> along = scaled(inverse, plane);
  return {scaled(length, along), along, length};
}

/// The partially latched spring of Walton & Braun, J. Rheol. 30, 949 (1986): loading along K1,
/// unloading and reloading along K2 from the overlap a0 that stays of the greatest one. A constant
/// restitution e = sqrt(K1 / K2). With friction, the incremental law of Walton & Braun after
/// Mindlin & Deresiewicz (1953), exponent 1/3 (Rosato et al. 2010, sec. III).
template <class N, bool friction>
struct WaltonBraunLaw {
  static constexpr bool has_spin = friction;
  static constexpr bool sees_full_step = false;  // but the velocity half a step before: the history
                                                 // takes the displacement of the step
  static constexpr bool arm_is_radius = false;   // but half the distance: keeps angular momentum
  static constexpr int n_history = friction ? 6 : 1;

  N greatest;             // overlap since the bodies touched
  Vector3<N> tangential;  // force on sphere i
  N reversal;             // force at the last reversal / (mu N), signed along the force
  N shrinking;            // 0 while the tangential force grew, else 1

  template <class Visit>
  JOSTLE_INLINE void each_of_history(Visit&& visit) {
    visit(0, greatest);
    if constexpr (friction) {
      visit(1, tangential.x);
      visit(2, tangential.y);
      visit(3, tangential.z);
      visit(4, reversal);
      visit(5, shrinking);
    }
  }

  JOSTLE_INLINE ContactAction<N> operator()(const Meeting<N>& at, const LawConstants& law) {
    const N zero{};
    const auto touching = at.overlap > zero;
    if (!any_of(touching) && !any_of(greatest > zero)) return {};
    const N before = greatest;
    greatest = greater(before, at.overlap);
    const N unloading = law.unloading * (at.overlap - law.latched * greatest);
    N normal_force = lesser(law.stiffness * at.overlap, greater(unloading, zero));
    normal_force = select(touching, normal_force, zero);
    // What the spring latched is lost when the contact opens, which erases its history.
    ContactAction<N> act;
    act.dissipated_normally =
        select(touching, zero, (0.5 * law.stiffness * law.latched) * before * before);
    greatest = select(touching, greatest, zero);
    act.force = scaled(normal_force, at.normal);
    act.torque = {zero, zero, zero};
    act.dissipated_by_friction = zero;
    if constexpr (friction) shear(at, law, normal_force, act);
    return act;
  }

 private:
  JOSTLE_INLINE void shear(const Meeting<N>& at, const LawConstants& law, const N& normal_force,
                           ContactAction<N>& act) {
    const N zero{}, one = zero + 1.0;
    const auto touching = at.overlap > zero;
    const N lost = (0.5 / law.tangential) * dot(tangential, tangential);  // if it opens
    const Vector3<N> step = scaled(zero + law.time_step, sliding_velocity(at));
    const auto [start, along, length] = turned(tangential, at, law.time_step);
    const N growth = zero - dot(step, along);  // the displacement that makes the force grow
    const N limit = law.friction * normal_force;

    // T* is T at each reversal; stored as a share of mu N, it follows N.
    N direction = 1.0 - 2.0 * shrinking;
    const N towards = select(growth > zero, one, select(growth < zero, zero - one, direction));
    const N share = length / select(limit > zero, limit, one);
    const N at_reversal = lesser(share, one);
    reversal = select(towards * direction < zero, at_reversal, reversal);
    direction = towards;

    const N room = limit - direction * length;
    const N whole = limit * (1.0 - direction * reversal);
    const N rest = room / select(whole > zero, whole, one);
    const N left = select(whole > zero, greater(lesser(rest, one), zero), zero);
    const N floor = zero + 1e-30;
    const N softened = law.tangential * cube_root_of(greater(left, floor));
    // K_T along the force, K0 across it.
    const N extra = (softened - law.tangential) * growth;
    Vector3<N> end = start - scaled(zero + law.tangential, step) + scaled(extra, along);
    const auto flipped = dot(end, along) < zero;
    reversal = select(flipped, zero - reversal, reversal);
    direction = select(flipped, zero - direction, direction);
    const N end2 = dot(end, end);
    const auto slides = end2 > limit * limit;
    if (any_of(slides)) {
      const N cut = limit / square_root(select(slides, end2, one));
      end = scaled(select(slides, cut, one), end);
    }

    // Work on the contact in this step, less what its spring K0 then holds.
    const N work = zero - 0.5 * dot(start + end, step);
    const N slip = work - (0.5 / law.tangential) * (dot(end, end) - length * length);
    act.dissipated_by_friction = select(touching, slip, lost);
    tangential = masked(touching, end);
    reversal = select(touching, reversal, zero);
    shrinking = select(touching, 0.5 - 0.5 * direction, zero);
    act.torque = cross(tangential, at.arm);
    act.force = act.force + tangential;
  }
};

/// Spring and dashpot, normal and tangential, the latter with the displacement since the bodies
/// touched, cut where it slides: Cundall & Strack, Geotechnique 29, 47 (1979), as LAMMPS'
/// gran/hooke and gran/hooke/history have them.
template <class N, bool friction>
struct LinearLaw {
  static constexpr bool has_spin = friction;
  static constexpr bool sees_full_step = true;  // the dashpots' velocity is that of the positions
  static constexpr bool arm_is_radius = true;
  static constexpr int n_history = friction ? 3 : 0;

  Vector3<N> spring;  // force on the other body, with the whole displacement of the last step

  template <class Visit>
  JOSTLE_INLINE void each_of_history(Visit&& visit) {
    if constexpr (friction) {
      visit(0, spring.x);
      visit(1, spring.y);
      visit(2, spring.z);
    }
  }

  JOSTLE_INLINE ContactAction<N> operator()(const Meeting<N>& at, const LawConstants& law) {
    const N zero{};
    const auto touching = at.overlap > zero;
    if (!any_of(touching) && !any_of(dot(spring, spring) > zero)) return {};
    const N speed = dot(at.velocity, at.normal);
    const N resisting = law.stiffness * at.overlap - law.damping * speed;
    const N normal_force = select(touching, resisting, zero);
    const N damped = (law.damping * law.time_step) * speed * speed;
    ContactAction<N> act;
    act.dissipated_normally = select(touching, damped, zero);
    act.force = scaled(normal_force, at.normal);
    act.torque = {zero, zero, zero};
    act.dissipated_by_friction = zero;
    if constexpr (friction) shear(at, law, normal_force, act);
    return act;
  }

 private:
  JOSTLE_INLINE void shear(const Meeting<N>& at, const LawConstants& law, const N& normal_force,
                           ContactAction<N>& act) {
    const N zero{}, one = zero + 1.0;
    const auto touching = at.overlap > zero;
    const N spring2 = dot(spring, spring);
    const N held = (0.5 / law.tangential) * spring2;
    const Vector3<N> velocity = sliding_velocity(at);
    const N stretch = zero + law.tangential * law.time_step;
    const Vector3<N> plane = projected(spring, at, law.time_step);
    const N plane2 = dot(plane, plane);
    const N longer = square_root(spring2 / select(plane2 > zero, plane2, one));
    const Vector3<N> start = scaled(longer, plane);  // as long as it was
    const Vector3<N> trial = start + scaled(stretch, velocity);
    // Half the last displacement comes after this step's positions.
    const N ahead = zero + (law.shear_damping - 0.5 * law.tangential * law.time_step);
    const Vector3<N> resisting = trial + scaled(ahead, velocity);
    const N size2 = dot(resisting, resisting);
    const N limit = law.friction * greater(normal_force, zero - normal_force);
    const auto slides = size2 > limit * limit;
    Vector3<N> acting = resisting;
    if (any_of(slides)) {
      const N cut = limit / square_root(select(slides, size2, one));
      acting = scaled(select(slides, cut, one), resisting);
    }
    const Vector3<N> kept = acting - scaled(ahead, velocity);
    // Work on the contact in this step, less what its spring then holds.
    const N work = law.time_step * dot(acting, velocity);
    const N rubbed = work - (0.5 / law.tangential) * (dot(kept, kept) - dot(start, start));
    act.dissipated_by_friction = select(touching, rubbed, held);
    spring = masked(touching, kept);
    const Vector3<N> force = masked(touching, scaled(zero - 1.0, acting));
    act.torque = cross(force, at.arm);
    act.force = act.force + force;
  }
};

#undef JOSTLE_INLINE

}  // namespace jostle::inline engine
