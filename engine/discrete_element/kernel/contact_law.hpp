#pragma once

#include <cstdint>

#include "engine/discrete_element/kernel/law_constants.hpp"

// The force of a contact, for one contact (N = double) or for as many as vectors of doubles have
// room for (N = Wide, kernel/lanes.hpp): the same operations in the same order, so the same bits.
// All of it is inlined, for it is compiled once for every instruction set. Lengths in diameters,
// masses in sphere masses, times in sqrt(diameter / gravity).
namespace jostle::inline engine {

#define JOSTLE_INLINE [[gnu::always_inline]] inline

// The upper half of 1.33 times the bits of 1: what a guess of x^(-1/3) takes a third of x's from.
inline constexpr std::int64_t inverse_cube_root_bits = 0x553ef0ff;

// A tangential force shorter than this, whose square has no inverse, counts as none.
inline constexpr double least_force = 1e-140;

// Largest component across the force, relative to the square of a slip, of a path that counts as
// straight.
inline constexpr double one_dimensional = 1e-9;

// The functions of Wide for one number.
JOSTLE_INLINE double select(bool mask, double yes, double no) {
  return mask ? yes : no;
}
JOSTLE_INLINE bool any_of(bool mask) {
  return mask;
}
JOSTLE_INLINE double lesser(double a, double b) {
  return a < b ? a : b;
}
JOSTLE_INLINE double greater(double a, double b) {
  return a > b ? a : b;
}
JOSTLE_INLINE double square_root(double x) {
  return __builtin_sqrt(x);
}
/// Less a third of the exponent, and of what follows it: within 5 % of x^(-1/3), x > 0.
JOSTLE_INLINE double inverse_cube_root_guess(double x) {
  const std::int64_t high = __builtin_bit_cast(std::int64_t, x) >> 32;
  return __builtin_bit_cast(double, (inverse_cube_root_bits - ((high * 0x55555556) >> 32)) << 32);
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

/// (1 + u)^(-1/2) to 0.3 u^4, for u near 0.
template <class N>
JOSTLE_INLINE N inverse_root_by_series(const N& u) {
  return 1.0 - u * (0.5 - u * (0.375 - u * 0.3125));
}

/// The cube root of x in [1e-300, 1] to 1e-14: Householder's method of the fourth order for
/// x^(-1/3), which needs no division.
template <class N>
JOSTLE_INLINE N cube_root_of(const N& x) {
  N inverse = inverse_cube_root_guess(x);
  for (int step = 0; step < 2; ++step) {
    const N miss = 1.0 - x * inverse * inverse * inverse;
    inverse = inverse + inverse * miss * (1.0 / 3.0 + miss * (2.0 / 9.0 + miss * (14.0 / 81.0)));
  }
  return x * inverse * inverse;
}

/// Where two bodies meet: sphere i of diameter 1, and such a sphere j or a side.
template <class N>
struct Meeting {
  Vector3<N> normal;    // from the other body to sphere i
  N overlap;            // positive where they touch
  Vector3<N> arm;       // from the contact to the centre of sphere i
  Vector3<N> velocity;  // velocity of sphere i relative to the other body, of the centres
  Vector3<N> spin;      // sum of the spins

  /// The angle by which the bodies turn about their normal in a step, in the mean.
  JOSTLE_INLINE N twist(double time_step) const { return (0.5 * time_step) * dot(spin, normal); }
  /// A dashpot's coefficient, of constants for the masses of such bodies.
  JOSTLE_INLINE double damping_of(double constant) const { return constant; }
};

/// Like the laws of equal spheres, for several sizes. Spins are radius x angular velocity, so that
/// surfaces slide with (u_i + u_j) x arm for any radii; the arm is that of a sphere over its
/// radius.
template <class N>
struct SizedMeeting : Meeting<N> {
  N per_diameter;  // 1 / (sum of the radii), or 1 / (diameter) at a side
  N mass_root;     // square root of the mass of the two together over that of equal spheres

  // Mean angular velocity, each weighted by its radius.
  JOSTLE_INLINE N twist(double time_step) const {
    return (time_step * per_diameter) * dot(this->spin, this->normal);
  }
  JOSTLE_INLINE N damping_of(double constant) const { return constant * mass_root; }
};

/// Force and torque on sphere i, and the energy dissipated in the step: on the other body acts the
/// opposite force and, where it is a sphere, the same torque.
template <class N>
struct ContactAction {
  Vector3<N> force, torque;
  N dissipated_by_friction, dissipated_normally;
};

/// The relative velocity of the surfaces where they meet, along the tangent plane; `speed` is that
/// of the centres along the normal, in which spins have no part.
template <class N>
JOSTLE_INLINE Vector3<N> sliding_velocity(const Meeting<N>& at, const N& speed) {
  return at.velocity - scaled(speed, at.normal) - cross(at.spin, at.arm);
}

/// A force which lay in the tangent plane of the step before, turned with the pair: by the mean
/// spin about the normal, then by projection into the present plane. Its length is sqrt(1 + change)
/// of what it was; `inverse2` is one over the square of that, or anything where there is no force.
template <class N>
struct Projected {
  Vector3<N> force;
  N change;
};
template <class N, class At>
JOSTLE_INLINE Projected<N> projected(const Vector3<N>& old, const N& inverse2, const At& at,
                                     double time_step) {
  const N twist = at.twist(time_step);
  const N out = dot(old, at.normal);  // component out of the plane
  const N twist2 = twist * twist, tilt2 = out * out * inverse2;
  return {old + scaled(twist, cross(at.normal, old)) - scaled(out, at.normal),
          lesser(twist2 - tilt2 * (1.0 + twist2), N(1.0))};
}

/// A force in the tangent plane, by its length and direction; without any, the direction is 0.
template <class N>
struct TangentialForce {
  Vector3<N> force, along;
  N length;
};

/// The force `old` in the present plane, with the length that it had.
template <class N, class At>
JOSTLE_INLINE TangentialForce<N> turned(const Vector3<N>& old, const At& at, double time_step) {
  const N zero{};
  const N length = square_root(dot(old, old));
  const N inverse = 1.0 / select(length > zero + least_force, length, zero + 1.0);
  const auto [plane, change] = projected(old, inverse * inverse, at, time_step);
  const Vector3<N> force = scaled(inverse_root_by_series(change), plane);
  return {force, scaled(inverse, force), length};
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
  static constexpr bool has_dashpots = false;
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

  /// True if they touch or have touched: if not, there is neither action nor history.
  JOSTLE_INLINE bool is_at_work(const Meeting<N>& at) const {
    const N zero{};
    return any_of(at.overlap > zero) || any_of(greatest > zero);
  }

  template <class At>
  JOSTLE_INLINE ContactAction<N> operator()(const At& at, const LawConstants& law) {
    const N zero{};
    const auto touching = at.overlap > zero;
    const N before = greatest;
    greatest = greater(before, at.overlap);
    const N unloading = law.unloading * (at.overlap - law.latched * greatest);
    N normal_force = lesser(law.stiffness * at.overlap, greater(unloading, zero));
    normal_force = select(touching, normal_force, zero);
    // Latched energy is lost when the contact opens, which erases its history.
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
  /// T* / (mu N) of a force that shrank and, at this share of mu N, grows without a reversal: what
  /// leaves K_T as it is, (mu N - T)/(mu N - T*) = (mu N + T)/(mu N + T* before). At zero: -T*.
  JOSTLE_INLINE N beyond_zero(const N& share) const {
    return 1.0 - (1.0 - share) * (1.0 + reversal) / (1.0 + share);
  }

  template <class At>
  JOSTLE_INLINE void shear(const At& at, const LawConstants& law, const N& normal_force,
                           ContactAction<N>& act) {
    const N zero{}, one = zero + 1.0;
    const auto touching = at.overlap > zero;
    const auto [start, along, length] = turned(tangential, at, law.time_step);
    const N before2 = length * length;
    const N lost = (0.5 / law.tangential) * before2;  // if it opens
    const N speed = dot(at.velocity, at.normal);
    const Vector3<N> step = scaled(zero + law.time_step, sliding_velocity(at, speed));
    const N growth = zero - dot(step, along);  // the displacement that makes the force grow
    const N limit = law.friction * normal_force;

    // T* is T at each reversal; stored as a share of mu N, it follows N.
    N direction = 1.0 - 2.0 * shrinking;
    const N towards = select(growth > zero, one, select(growth < zero, zero - one, direction));
    const N share = length / select(limit > zero, limit, one);
    const N at_reversal = lesser(share, one);
    N next = at_reversal;
    const auto grows_again = towards > direction;
    if (any_of(grows_again)) {
      // This slip on the force one such step before, T + K0 s: where it shrinks that one, it is the
      // force that turned, passing zero on one side, and no slip that turned round.
      const N step2 = dot(step, step), aside2 = (1.0 - one_dimensional) * step2 - growth * growth;
      const N turned_by = law.tangential * step2 - length * growth;
      const auto passes_zero = select(grows_again, lesser(turned_by, aside2), zero) > zero;
      next = select(passes_zero, beyond_zero(at_reversal), at_reversal);
    }
    reversal = select(towards * direction < zero, next, reversal);
    direction = towards;

    const N room = 1.0 - direction * share;  // shares of mu N
    const N whole = 1.0 - direction * reversal;
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
    N end2 = dot(end, end);
    const N limit2 = limit * limit;
    const auto slides = end2 > limit2;
    if (any_of(slides)) {
      const N cut = limit / square_root(select(slides, end2, one));
      end = scaled(select(slides, cut, one), end);
      end2 = lesser(end2, limit2);
    }

    // Work on the contact in this step, less what its spring K0 then holds.
    const N work = zero - 0.5 * dot(start + end, step);
    const N slip = work - (0.5 / law.tangential) * (end2 - before2);
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
  static constexpr bool has_dashpots = true;
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

  JOSTLE_INLINE bool is_at_work(const Meeting<N>& at) const {
    const N zero{};
    return any_of(at.overlap > zero) || any_of(dot(spring, spring) > zero);
  }

  template <class At>
  JOSTLE_INLINE ContactAction<N> operator()(const At& at, const LawConstants& law) {
    const N zero{};
    const auto touching = at.overlap > zero;
    const N speed = dot(at.velocity, at.normal);
    const auto damping = at.damping_of(law.damping);
    const N resisting = law.stiffness * at.overlap - damping * speed;
    const N normal_force = select(touching, resisting, zero);
    const N damped = (damping * law.time_step) * speed * speed;
    ContactAction<N> act;
    act.dissipated_normally = select(touching, damped, zero);
    act.force = scaled(normal_force, at.normal);
    act.torque = {zero, zero, zero};
    act.dissipated_by_friction = zero;
    if constexpr (friction) shear(at, law, speed, normal_force, act);
    return act;
  }

 private:
  template <class At>
  JOSTLE_INLINE void shear(const At& at, const LawConstants& law, const N& speed,
                           const N& normal_force, ContactAction<N>& act) {
    const N zero{}, one = zero + 1.0;
    const auto touching = at.overlap > zero;
    const N spring2 = dot(spring, spring);
    const N held = (0.5 / law.tangential) * spring2;
    const Vector3<N> velocity = sliding_velocity(at, speed);
    const N stretch = zero + law.tangential * law.time_step;
    const N inverse2 = 1.0 / select(spring2 > zero + least_force * least_force, spring2, one);
    const auto [plane, change] = projected(spring, inverse2, at, law.time_step);
    const Vector3<N> start = scaled(inverse_root_by_series(change), plane);  // with its old length
    const Vector3<N> trial = start + scaled(stretch, velocity);
    // Half the last displacement comes after this step's positions.
    const N ahead =
        zero + (at.damping_of(law.shear_damping) - 0.5 * law.tangential * law.time_step);
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
    const N rubbed = work - (0.5 / law.tangential) * (dot(kept, kept) - spring2);
    act.dissipated_by_friction = select(touching, rubbed, held);
    spring = masked(touching, kept);
    const Vector3<N> force = masked(touching, scaled(zero - 1.0, acting));
    act.torque = cross(force, at.arm);
    act.force = act.force + force;
  }
};

#undef JOSTLE_INLINE

}  // namespace jostle::inline engine
