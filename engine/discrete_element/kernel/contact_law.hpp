#pragma once

#include "engine/discrete_element/kernel/law_constants.hpp"
#include "engine/discrete_element/kernel/vector3.hpp"

// The force of a contact. With the overlap a, the normal n towards sphere i, the relative velocity
// v of the centres, the tangential displacement s of a step and the time step dt:
//
//   WaltonBraunLaw (Walton & Braun 1986; Rosato et al. 2010, sec. III)
//     N    = K1 a while a grows, K2 (a - a0) below the greatest overlap, never negative;
//            K2 = K1 / e^2, a0 = (1 - e^2) x the greatest overlap
//     T   -> T - K_T s along T, T - K0 s across it, then cut to |T| = mu N
//     K_T  = K0 ((1 - t) / (1 - t*))^(1/3) while T grows, K0 ((1 + t) / (1 + t*))^(1/3) while it
//            shrinks; t = T / (mu N), t* = t at the last reversal, 0 at first
//   LinearLaw (Cundall & Strack 1979)
//     N    = k_n a - c_n v.n
//     T    = -(k_t x the displacement since the bodies touched + c_t x the sliding velocity),
//            then cut to |T| = mu |N|
//
// A tangential force of the step before is first turned with the pair: projected(), turned().
// Sliding velocity: sliding_velocity(). The loop that calls the laws: grain_loop.hpp.
//
// Everything is written for one contact (N = double) or for as many as vectors of doubles hold (N =
// Wide, kernel/lanes.hpp): the same operations in the same order, so the same bits. All of it is
// inlined, for it is compiled once for every instruction set. Lengths in diameters, masses in
// sphere masses, times in sqrt(diameter / gravity).
namespace jostle::inline engine {

#define JOSTLE_INLINE [[gnu::always_inline]] inline

// A tangential force shorter than this, whose square has no inverse, counts as none.
inline constexpr double least_force = 1e-140;

// Largest component across the force, relative to the square of a slip, of a path that counts as
// straight.
inline constexpr double one_dimensional = 1e-9;

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
JOSTLE_INLINE Vector3<N> sliding_velocity(const Meeting<N>& meeting, const N& speed) {
  return meeting.velocity - scaled(speed, meeting.normal) - cross(meeting.spin, meeting.arm);
}

/// A force which lay in the tangent plane of the step before, turned with the pair: by the mean
/// spin about the normal, then by projection into the present plane. Its length is sqrt(1 + change)
/// of what it was; `inverse2` is one over the square of that, or anything where there is no force.
template <class N>
struct Projected {
  Vector3<N> force;
  N change;
};
template <class N, class AnyMeeting>
JOSTLE_INLINE Projected<N> projected(const Vector3<N>& old, const N& inverse2,
                                     const AnyMeeting& meeting, double time_step) {
  const N twist = meeting.twist(time_step);
  const N normal_part = dot(old, meeting.normal);  // component out of the plane
  const N twist2 = twist * twist, tilt2 = normal_part * normal_part * inverse2;
  return {old + scaled(twist, cross(meeting.normal, old)) - scaled(normal_part, meeting.normal),
          lesser(twist2 - tilt2 * (1.0 + twist2), N(1.0))};
}

/// A force in the tangent plane, its unit vector (0 without a force) and its length.
template <class N>
struct TangentialForce {
  Vector3<N> force, unit;
  N length;
};

/// The force `old` in the present plane, with the length that it had.
template <class N, class AnyMeeting>
JOSTLE_INLINE TangentialForce<N> turned(const Vector3<N>& old, const AnyMeeting& meeting,
                                        double time_step) {
  const N zero{};
  const N length = square_root(dot(old, old));
  const N inverse = 1.0 / select(length > zero + least_force, length, zero + 1.0);
  const auto [plane, change] = projected(old, inverse * inverse, meeting, time_step);
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
  JOSTLE_INLINE bool is_at_work(const Meeting<N>& meeting) const {
    const N zero{};
    return any_of(meeting.overlap > zero) || any_of(greatest > zero);
  }

  template <class AnyMeeting>
  JOSTLE_INLINE ContactAction<N> operator()(const AnyMeeting& meeting, const LawConstants& law) {
    const N zero{};
    const auto touching = meeting.overlap > zero;
    const N old_greatest = greatest;
    greatest = greater(old_greatest, meeting.overlap);
    const N unloading = law.unloading * (meeting.overlap - law.latched * greatest);
    N normal_force = lesser(law.stiffness * meeting.overlap, greater(unloading, zero));
    normal_force = select(touching, normal_force, zero);
    // Latched energy is lost when the contact opens, which erases its history.
    ContactAction<N> action;
    action.dissipated_normally =
        select(touching, zero, (0.5 * law.stiffness * law.latched) * old_greatest * old_greatest);
    greatest = select(touching, greatest, zero);
    action.force = scaled(normal_force, meeting.normal);
    action.torque = {zero, zero, zero};
    action.dissipated_by_friction = zero;
    if constexpr (friction) shear(meeting, law, normal_force, action);
    return action;
  }

 private:
  /// The t* of a force that shrank and, at this t, grows without a reversal. It leaves K_T as it
  /// is: (1 - t) / (1 - t*) = (1 + t) / (1 + t* before). At t = 0: minus t* before.
  JOSTLE_INLINE N beyond_zero(const N& mobilized) const {
    return 1.0 - (1.0 - mobilized) * (1.0 + reversal) / (1.0 + mobilized);
  }

  template <class AnyMeeting>
  JOSTLE_INLINE void shear(const AnyMeeting& meeting, const LawConstants& law,
                           const N& normal_force, ContactAction<N>& action) {
    const N zero{}, unity = zero + 1.0;
    const auto touching = meeting.overlap > zero;
    const auto [start, unit, length] = turned(tangential, meeting, law.time_step);
    const N start2 = length * length;
    const N released = (0.5 / law.tangential) * start2;  // if it opens
    const N speed = dot(meeting.velocity, meeting.normal);
    const Vector3<N> step = scaled(zero + law.time_step, sliding_velocity(meeting, speed));
    const N growth = zero - dot(step, unit);  // the displacement that makes the force grow
    const N limit = law.friction * normal_force;

    // loading: 1 while T grows, -1 while it shrinks. t* is t at each reversal: as a share of mu N
    // it follows N.
    N loading = 1.0 - 2.0 * shrinking;
    const N loading_now =
        select(growth > zero, unity, select(growth < zero, zero - unity, loading));
    const N mobilized = length / select(limit > zero, limit, unity);
    const N mobilized_now = lesser(mobilized, unity);
    N next = mobilized_now;
    const auto grows_again = loading_now > loading;
    if (any_of(grows_again)) {
      // This slip on the force one such step before, T + K0 s: where it shrinks that one, it is the
      // force that turned, passing zero on one side, and no slip that turned round.
      const N step2 = dot(step, step), aside2 = (1.0 - one_dimensional) * step2 - growth * growth;
      const N turned_by = law.tangential * step2 - length * growth;
      const auto passes_zero = select(grows_again, lesser(turned_by, aside2), zero) > zero;
      next = select(passes_zero, beyond_zero(mobilized_now), mobilized_now);
    }
    reversal = select(loading_now * loading < zero, next, reversal);
    loading = loading_now;

    const N numerator = 1.0 - loading * mobilized;
    const N denominator = 1.0 - loading * reversal;
    const N quotient = numerator / select(denominator > zero, denominator, unity);
    const N fraction = select(denominator > zero, greater(lesser(quotient, unity), zero), zero);
    const N least = zero + 1e-30;
    const N softened = law.tangential * cube_root_of(greater(fraction, least));  // K_T
    // K_T along the force, K0 across it.
    const N extra = (softened - law.tangential) * growth;
    Vector3<N> end = start - scaled(zero + law.tangential, step) + scaled(extra, unit);
    const auto flipped = dot(end, unit) < zero;
    reversal = select(flipped, zero - reversal, reversal);
    loading = select(flipped, zero - loading, loading);
    N end2 = dot(end, end);
    const N limit2 = limit * limit;
    const auto slides = end2 > limit2;
    if (any_of(slides)) {
      const N cut = limit / square_root(select(slides, end2, unity));
      end = scaled(select(slides, cut, unity), end);
      end2 = lesser(end2, limit2);
    }

    // Work on the contact in this step, less what its spring K0 then holds.
    const N work = zero - 0.5 * dot(start + end, step);
    const N slip_energy = work - (0.5 / law.tangential) * (end2 - start2);
    action.dissipated_by_friction = select(touching, slip_energy, released);
    tangential = masked(touching, end);
    reversal = select(touching, reversal, zero);
    shrinking = select(touching, 0.5 - 0.5 * loading, zero);
    action.torque = cross(tangential, meeting.arm);
    action.force = action.force + tangential;
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

  JOSTLE_INLINE bool is_at_work(const Meeting<N>& meeting) const {
    const N zero{};
    return any_of(meeting.overlap > zero) || any_of(dot(spring, spring) > zero);
  }

  template <class AnyMeeting>
  JOSTLE_INLINE ContactAction<N> operator()(const AnyMeeting& meeting, const LawConstants& law) {
    const N zero{};
    const auto touching = meeting.overlap > zero;
    const N speed = dot(meeting.velocity, meeting.normal);
    const auto damping = meeting.damping_of(law.damping);
    const N resisting = law.stiffness * meeting.overlap - damping * speed;
    const N normal_force = select(touching, resisting, zero);
    const N damped = (damping * law.time_step) * speed * speed;
    ContactAction<N> action;
    action.dissipated_normally = select(touching, damped, zero);
    action.force = scaled(normal_force, meeting.normal);
    action.torque = {zero, zero, zero};
    action.dissipated_by_friction = zero;
    if constexpr (friction) shear(meeting, law, speed, normal_force, action);
    return action;
  }

 private:
  template <class AnyMeeting>
  JOSTLE_INLINE void shear(const AnyMeeting& meeting, const LawConstants& law, const N& speed,
                           const N& normal_force, ContactAction<N>& action) {
    const N zero{}, unity = zero + 1.0;
    const auto touching = meeting.overlap > zero;
    const N spring2 = dot(spring, spring);
    const N held = (0.5 / law.tangential) * spring2;
    const Vector3<N> velocity = sliding_velocity(meeting, speed);
    const N stretch = zero + law.tangential * law.time_step;
    const N inverse2 = 1.0 / select(spring2 > zero + least_force * least_force, spring2, unity);
    const auto [plane, change] = projected(spring, inverse2, meeting, law.time_step);
    const Vector3<N> start = scaled(inverse_root_by_series(change), plane);  // with its old length
    const Vector3<N> trial = start + scaled(stretch, velocity);
    // Half the last displacement comes after this step's positions.
    const N ahead =
        zero + (meeting.damping_of(law.shear_damping) - 0.5 * law.tangential * law.time_step);
    const Vector3<N> resisting = trial + scaled(ahead, velocity);
    const N size2 = dot(resisting, resisting);
    const N limit = law.friction * greater(normal_force, zero - normal_force);
    const auto slides = size2 > limit * limit;
    Vector3<N> acting = resisting;
    if (any_of(slides)) {
      const N cut = limit / square_root(select(slides, size2, unity));
      acting = scaled(select(slides, cut, unity), resisting);
    }
    const Vector3<N> kept = acting - scaled(ahead, velocity);
    // Work on the contact in this step, less what its spring then holds.
    const N work = law.time_step * dot(acting, velocity);
    const N rubbed = work - (0.5 / law.tangential) * (dot(kept, kept) - spring2);
    action.dissipated_by_friction = select(touching, rubbed, held);
    spring = masked(touching, kept);
    const Vector3<N> force = masked(touching, scaled(zero - 1.0, acting));
    action.torque = cross(force, meeting.arm);
    action.force = action.force + force;
  }
};

#undef JOSTLE_INLINE

}  // namespace jostle::inline engine
