// Compiled once for every instruction set, each time into a namespace of its own (JOSTLE_KERNELS).
// It must instantiate nothing that another translation unit could pick up.
#include <type_traits>

#include "engine/discrete_element/kernel/contact_law.hpp"
#include "engine/discrete_element/kernel/grain_rows.hpp"
#include "engine/discrete_element/kernel/lanes.hpp"

namespace jostle::inline engine::JOSTLE_KERNELS {

namespace {

using Half = double __attribute__((vector_size(32)));  // half of a row
using HalfBits = std::int64_t __attribute__((vector_size(32)));

[[gnu::always_inline]] inline Half& half_at(double* from) {
  return *reinterpret_cast<Half*>(from);
}
[[gnu::always_inline]] inline const Half& half_at(const double* from) {
  return *reinterpret_cast<const Half*>(from);
}

// Loads numbers of a law's history, and stores them.
template <class Law>
[[gnu::always_inline]] inline void read_history(Law& law, const ContactArrays& contacts,
                                                std::size_t at) {
  law.each_of_history([&](int k, Wide& value) __attribute__((always_inline)) {
    value = Wide::at(contacts.history[k] + at);
  });
}
template <class Law>
[[gnu::always_inline]] inline void write_history(Law& law, const ContactArrays& contacts,
                                                 std::size_t at) {
  law.each_of_history([&](int k, Wide& value) __attribute__((always_inline)) {
    value.store(contacts.history[k] + at);
  });
}

[[gnu::always_inline]] inline void write_action(const ContactArrays& contacts, std::size_t at,
                                                const ContactAction<Wide>& act, double share) {
  const Wide friction = share * act.dissipated_by_friction;
  const Wide normal = share * act.dissipated_normally;
  for (std::uint32_t p = 0; p < n_parts; ++p) {
    Lanes m[8] = {act.force.x.part[p],  act.force.y.part[p], act.force.z.part[p],
                  act.torque.y.part[p], friction.part[p],    normal.part[p],
                  act.torque.z.part[p], act.torque.x.part[p]};
    columns_to_rows(m);
    double* rows = contacts.action[at + p * n_lanes].of;
    for (std::uint32_t k = 0; k < 8; ++k) lanes_at(rows + k * n_lanes) = m[k];
  }
}

// Data of the spheres in a block of contacts: for pairs the differences of their rows, with the
// spins added; for sides the rows themselves.
struct Columns {
  Wide of[8], spin_z;
};

template <bool spin>
[[gnu::always_inline]] inline Columns of_pairs(const SphereArrays& spheres,
                                               const ContactArrays& contacts, std::size_t at) {
  constexpr std::uint32_t per_row = 8 / n_lanes;  // vectors
  Columns out;
  for (std::uint32_t p = 0; p < n_parts; ++p, at += n_lanes) {
    Lanes m[8];
    for (std::uint32_t lane = 0; lane < n_lanes; ++lane) {
      const double* a = spheres.rows[contacts.first[at + lane]].of;
      const double* b = spheres.rows[contacts.second[at + lane]].of;
      for (std::uint32_t k = 0; k < per_row; ++k) {
        LaneBits minus{};  // sign of the added rows: spins
        for (std::uint32_t l = 0; l < n_lanes; ++l)
          if (spin && (k * n_lanes + l) % 4 == 3) minus[l] = std::int64_t{1} << 63;
        m[lane * per_row + k] =
            lanes_at(a + k * n_lanes) - (Lanes)((LaneBits)lanes_at(b + k * n_lanes) ^ minus);
      }
      if constexpr (spin)
        out.spin_z.part[p][lane] =
            spheres.spin_z[contacts.first[at + lane]] + spheres.spin_z[contacts.second[at + lane]];
    }
    rows_to_columns(m);
    for (std::uint32_t k = 0; k < 8; ++k) out.of[k].part[p] = m[k];
  }
  return out;
}

template <bool spin>
[[gnu::always_inline]] inline Columns of_spheres(const SphereArrays& spheres,
                                                 const ContactArrays& contacts, std::size_t at) {
  constexpr std::uint32_t per_row = 8 / n_lanes;
  Columns out;
  for (std::uint32_t p = 0; p < n_parts; ++p, at += n_lanes) {
    Lanes m[8];
    for (std::uint32_t lane = 0; lane < n_lanes; ++lane) {
      const double* a = spheres.rows[contacts.first[at + lane]].of;
      for (std::uint32_t k = 0; k < per_row; ++k) m[lane * per_row + k] = lanes_at(a + k * n_lanes);
      if constexpr (spin) out.spin_z.part[p][lane] = spheres.spin_z[contacts.first[at + lane]];
    }
    rows_to_columns(m);
    for (std::uint32_t k = 0; k < 8; ++k) out.of[k].part[p] = m[k];
  }
  return out;
}

// Returns true if there was work.
template <class Law, class At>
[[gnu::always_inline]] inline bool act(const At& meeting, const ContactArrays& contacts,
                                       std::size_t at, const LawConstants& constants,
                                       double share) {
  Law law;
  read_history(law, contacts, at);
  if (!law.is_at_work(meeting)) {
    write_action(contacts, at, {}, share);
    return false;
  }
  const ContactAction<Wide> action = law(meeting, constants);
  write_history(law, contacts, at);
  write_action(contacts, at, action, share);
  return true;
}

// Returns true if any of a block's spheres may touch: in half the time of their meeting.
template <bool several>
[[gnu::always_inline]] inline bool may_touch(const SphereArrays& spheres,
                                             const ContactArrays& contacts, std::size_t at) {
  constexpr double reach2 = 1 + 1e-9;  // beyond the rounding of either way to compute distances
  HalfBits near{};
  for (std::size_t k = at; k < at + wide_size; k += 4) {
    Half m[4];
    for (std::size_t l = 0; l < 4; ++l)
      m[l] = half_at(spheres.rows[contacts.first[k + l]].of) -
             half_at(spheres.rows[contacts.second[k + l]].of);
    const Half a = __builtin_shufflevector(m[0], m[1], 0, 4, 2, 6);  // x0 x1 z0 z1
    const Half b = __builtin_shufflevector(m[2], m[3], 0, 4, 2, 6);
    const Half c = __builtin_shufflevector(m[0], m[1], 1, 5, 3, 7);
    const Half d = __builtin_shufflevector(m[2], m[3], 1, 5, 3, 7);
    const Half x = __builtin_shufflevector(a, b, 0, 1, 4, 5) - half_at(contacts.shift[0] + k);
    const Half y = __builtin_shufflevector(c, d, 0, 1, 4, 5) - half_at(contacts.shift[1] + k);
    const Half z = __builtin_shufflevector(a, b, 2, 3, 6, 7);
    Half within = Half{} + reach2;
    if constexpr (several) {
      const Half touching = half_at(contacts.size[touching_distance] + k);
      within = reach2 * (touching * touching);
    }
    near |= (HalfBits)(x * x + y * y + z * z < within);
  }
  return (near[0] | near[1] | near[2] | near[3]) != 0;
}

[[gnu::always_inline]] inline void keep_deepest(const ContactArrays& contacts,
                                                const Wide& deepest) {
  for (const Lanes& part : deepest.part)
    for (std::uint32_t k = 0; k < n_lanes; ++k)
      *contacts.deepest = part[k] > *contacts.deepest ? part[k] : *contacts.deepest;
}

[[gnu::always_inline]] inline void set_idle(const ContactArrays& contacts, std::size_t at,
                                            bool idle) {
  for (std::size_t k = 0; k < wide_size; k += smallest_block) contacts.idle[at + k] = idle ? 1 : 0;
}

// A pass of its own: beside a law's many numbers its own would be put aside and fetched again.
template <bool several>
[[gnu::noinline]] void find_idle(const ContactArrays& contacts, const SphereArrays& spheres) {
  for (std::size_t at = 0; at < contacts.n; at += wide_size) {
    if (contacts.idle[at] != 0 && may_touch<several>(spheres, contacts, at))
      set_idle(contacts, at, false);
  }
}

template <bool several>
using MeetingOf = std::conditional_t<several, SizedMeeting<Wide>, Meeting<Wide>>;

// Data of the sizes of the spheres in a block of contacts.
template <class Law>
[[gnu::always_inline]] inline void read_sizes(SizedMeeting<Wide>& meeting,
                                              const ContactArrays& contacts, std::size_t at) {
  meeting.per_diameter = Wide::at(contacts.size[per_diameter] + at);
  if constexpr (Law::has_dashpots) meeting.mass_root = Wide::at(contacts.size[mass_root] + at);
}

template <template <class, bool> class LawOf, bool friction, bool several>
void pairs(const ContactArrays& contacts, const SphereArrays& spheres,
           const LawConstants& constants) {
  using Law = LawOf<Wide, friction>;
  find_idle<several>(contacts, spheres);
  Wide deepest = *contacts.deepest;
  for (std::size_t at = 0; at < contacts.n; at += wide_size) {
    if (contacts.idle[at] != 0) continue;
    const Columns m = of_pairs<Law::has_spin>(spheres, contacts, at);
    const Vector3<Wide> between = {m.of[0] - Wide::at(contacts.shift[0] + at),
                                   m.of[1] - Wide::at(contacts.shift[1] + at), m.of[2]};
    const Wide distance = square_root(dot(between, between));
    MeetingOf<several> meeting;
    meeting.normal = scaled(1.0 / distance, between);
    meeting.velocity = {m.of[4], m.of[5], m.of[6]};
    if constexpr (Law::has_spin) meeting.spin = {m.of[3], m.of[7], m.spin_z};
    if constexpr (several) {
      read_sizes<Law>(meeting, contacts, at);
      meeting.overlap = Wide::at(contacts.size[touching_distance] + at) - distance;
      if constexpr (Law::has_spin)
        meeting.arm = Law::arm_is_radius ? meeting.normal : scaled(meeting.per_diameter, between);
      deepest =
          greater(deepest, meeting.overlap * Wide::at(contacts.size[per_smaller_diameter] + at));
    } else {
      meeting.overlap = 1.0 - distance;
      if constexpr (Law::has_spin)
        meeting.arm = scaled(Wide(0.5), Law::arm_is_radius ? meeting.normal : between);
      deepest = greater(deepest, meeting.overlap);
    }
    set_idle(contacts, at, !act<Law>(meeting, contacts, at, constants, 0.5));
  }
  keep_deepest(contacts, deepest);
}

template <template <class, bool> class LawOf, bool friction, bool several>
void sides(const ContactArrays& contacts, const SphereArrays& spheres,
           const LawConstants& constants) {
  using Law = LawOf<Wide, friction>;
  Wide deepest = *contacts.deepest;
  for (std::size_t at = 0; at < contacts.n; at += wide_size) {
    const Columns m = of_spheres<Law::has_spin>(spheres, contacts, at);
    const Wide distance = Wide::at(contacts.side[3] + at);
    MeetingOf<several> meeting;
    meeting.normal = {Wide::at(contacts.side[0] + at), Wide::at(contacts.side[1] + at),
                      Wide::at(contacts.side[2] + at)};
    if constexpr (several) {
      read_sizes<Law>(meeting, contacts, at);
      meeting.overlap = Wide::at(contacts.size[touching_distance] + at) - distance;
    } else {
      meeting.overlap = 0.5 - distance;
    }
    meeting.velocity = {m.of[4], m.of[5], m.of[6] - contacts.side_velocity};
    if constexpr (Law::has_spin) {
      if constexpr (several) {
        meeting.arm = Law::arm_is_radius
                          ? meeting.normal
                          : scaled((2.0 * meeting.per_diameter) * distance, meeting.normal);
      } else {
        meeting.arm = scaled(Law::arm_is_radius ? Wide(0.5) : distance, meeting.normal);
      }
      meeting.spin = {m.of[3], m.of[7], m.spin_z};
    }
    if constexpr (several) {
      deepest = greater(deepest, meeting.overlap * meeting.per_diameter);
    } else {
      deepest = greater(deepest, meeting.overlap);
    }
    act<Law>(meeting, contacts, at, constants, 1.0);
  }
  keep_deepest(contacts, deepest);
}

// A leap-frog step: every sphere sums what acts on it in the order of its slots; velocities, half a
// step back, go a step on, and then the positions. Moment of inertia 1/10; of several sizes 2/5 of
// mass and radius squared.
template <bool spin, bool full_step, bool all, bool several>
[[gnu::always_inline]] inline void advance_those(const SphereArrays& spheres, Advance& step) {
  constexpr Half sign_of[2] = {{1, 1, 1, 1}, {-1, -1, -1, 1}};
  const double dt = step.time_step;
  double turn = (several ? 2.5 : 10) * dt;
  Half kick = {dt, dt, dt, turn}, twist = {0, 0, 0, turn};
  const Half kick_of_1 = kick, twist_of_1 = twist, move = {dt, dt, dt, 0};
  const double turn_of_1 = turn;
  Half weight = {0, 0, 0 - step.gravity, 0};
  const Half drift = {step.drift[0], step.drift[1], step.drift[2], 0};
  double fastest = 0;
  for (std::size_t i = 0; i < spheres.n; ++i) {
    if constexpr (several) {
      const double per_mass = spheres.per_mass[i];
      weight[2] = 0 - step.gravity * spheres.mass[i];
      kick = per_mass * kick_of_1;
      twist = per_mass * twist_of_1;
      turn = per_mass * turn_of_1;
    }
    Half force = weight, rest = {};
    if (all || spheres.acted_upon[i] != 0) {
      for (std::uint32_t s = spheres.begin[i]; s < spheres.begin[i + 1]; ++s) {
        const std::uint32_t slot = spheres.slot[s];
        const double* action = spheres.action[slot >> 1].of;
        force += sign_of[slot & 1] * half_at(action);
        rest += half_at(action + 4);
      }
      spheres.dissipated[2 * i] += rest[0];
      spheres.dissipated[2 * i + 1] += rest[1];
    }
    const Half kicked = force * kick, twisted = rest * twist;
    double* row = spheres.rows[i].of;
    double* moving = full_step ? spheres.half_rows[i].of : row;
    half_at(moving + 4) += kicked;
    half_at(moving) += twisted;
    const Half velocity = half_at(moving + 4);
    const Half moved = half_at(row) + velocity * move;
    if constexpr (full_step) {
      const Half spun = half_at(moving) + 0.5 * twisted;
      half_at(row) = __builtin_shufflevector(moved, spun, 0, 1, 2, 7);
      half_at(row + 4) = velocity + 0.5 * kicked;
    } else {
      half_at(row) = moved;
    }
    if constexpr (spin) {
      const double turned = turn * rest[2];
      if constexpr (full_step) {
        spheres.half_spin_z[i] += turned;
        spheres.spin_z[i] = spheres.half_spin_z[i] + 0.5 * turned;
      } else {
        spheres.spin_z[i] += turned;
      }
    }
    const Half apart = velocity - drift, squares = apart * apart;
    const double speed_squared = squares[0] + squares[1] + squares[2];
    fastest = speed_squared > fastest ? speed_squared : fastest;
  }
  step.fastest_squared = fastest;
}

template <bool spin, bool full_step, bool several>
void advance(const SphereArrays& spheres, Advance& step) {
  if (spheres.acted_upon == nullptr) {
    advance_those<spin, full_step, true, several>(spheres, step);
  } else {
    advance_those<spin, full_step, false, several>(spheres, step);
  }
}

template <template <class, bool> class LawOf, bool friction, bool several>
GrainKernels kernels_of() {
  using Law = LawOf<Wide, friction>;
  return {pairs<LawOf, friction, several>,
          sides<LawOf, friction, several>,
          advance<Law::has_spin, Law::sees_full_step, several>,
          Law::n_history,
          Law::has_spin,
          Law::sees_full_step};
}

template <template <class, bool> class LawOf, bool friction>
GrainKernels kernels_for(GrainSizes sizes) {
  return sizes == GrainSizes::equal ? kernels_of<LawOf, friction, false>()
                                    : kernels_of<LawOf, friction, true>();
}

}  // namespace

GrainKernels grain_kernels(GrainLaw law, GrainSizes sizes) {
  switch (law) {
    case GrainLaw::walton_braun:
      return kernels_for<WaltonBraunLaw, true>(sizes);
    case GrainLaw::walton_braun_smooth:
      return kernels_for<WaltonBraunLaw, false>(sizes);
    case GrainLaw::linear:
      return kernels_for<LinearLaw, true>(sizes);
    case GrainLaw::linear_smooth:
      return kernels_for<LinearLaw, false>(sizes);
  }
  return {};
}

}  // namespace jostle::inline engine::JOSTLE_KERNELS
