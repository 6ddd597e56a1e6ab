// Compiled once for every instruction set, each time into a namespace of its own (JOSTLE_KERNELS).
// It must instantiate nothing that another translation unit could pick up.
#include <cstddef>
#include <type_traits>

#include "engine/discrete_element/kernel/contact_law.hpp"
#include "engine/discrete_element/kernel/grain_rows.hpp"
#include "engine/discrete_element/kernel/lanes.hpp"

namespace jostle::inline engine::JOSTLE_KERNELS {

namespace {

using Half = double __attribute__((vector_size(32)));  // half of a row
using HalfBits = std::int64_t __attribute__((vector_size(32)));

[[gnu::always_inline]] inline Half& half_at(double* source) {
  return *reinterpret_cast<Half*>(source);
}
[[gnu::always_inline]] inline const Half& half_at(const double* source) {
  return *reinterpret_cast<const Half*>(source);
}

// The eight numbers of a row. (By its first member: of the row itself gcc 12 makes longer code.)
[[gnu::always_inline]] inline double* numbers_of(SphereRow& row) {
  return &row.x;
}
[[gnu::always_inline]] inline double* numbers_of(ActionRow& row) {
  return &row.force_x;
}
[[gnu::always_inline]] inline const double* numbers_of(const ActionRow& row) {
  return &row.force_x;
}

// advance_spheres() adds halves: a component of an action changes the one of a sphere at its place.
static_assert(offsetof(ActionRow, force_x) % 32 == offsetof(SphereRow, velocity_x) % 32);
static_assert(offsetof(ActionRow, torque_y) % 32 == offsetof(SphereRow, spin_y) % 32);
static_assert(offsetof(ActionRow, torque_x) % 32 == offsetof(SphereRow, spin_x) % 32);

// Places in the second half of an action.
constexpr int friction_place = 0, normal_place = 1, torque_z_place = 2;

// Loads numbers of a law's history, and stores them.
template <class Law>
[[gnu::always_inline]] inline void read_history(Law& law, const ContactArrays& contacts,
                                                std::size_t index) {
  law.each_of_history([&](int k, Wide& value) __attribute__((always_inline)) {
    value = Wide::load(contacts.history[k] + index);
  });
}
template <class Law>
[[gnu::always_inline]] inline void write_history(Law& law, const ContactArrays& contacts,
                                                 std::size_t index) {
  law.each_of_history([&](int k, Wide& value) __attribute__((always_inline)) {
    value.store(contacts.history[k] + index);
  });
}

[[gnu::always_inline]] inline void write_action(const ContactArrays& contacts, std::size_t index,
                                                const ContactAction<Wide>& action, double share) {
  const Wide friction = share * action.dissipated_by_friction;
  const Wide normal = share * action.dissipated_normally;
  for (std::uint32_t p = 0; p < n_parts; ++p) {
    Lanes m[8] = {action.force.x.part[p],  action.force.y.part[p], action.force.z.part[p],
                  action.torque.y.part[p], friction.part[p],       normal.part[p],
                  action.torque.z.part[p], action.torque.x.part[p]};  // order of an ActionRow
    columns_to_rows(m);
    double* rows = numbers_of(contacts.action[index + p * n_lanes]);
    for (std::uint32_t k = 0; k < 8; ++k) lanes_at(rows + k * n_lanes) = m[k];
  }
}

// Data of the spheres in a block of contacts: for pairs the differences of positions and velocities
// and the sums of the spins; for sides those of the sphere.
struct BlockData {
  Vector3<Wide> position, velocity, spin;
};

// Transposes the rows of a part of a block, or their differences, into components.
[[gnu::always_inline]] inline void set_components(BlockData& block, std::uint32_t p,
                                                  Lanes (&rows)[8]) {
  rows_to_columns(rows);
  block.position.x.part[p] = rows[0];
  block.position.y.part[p] = rows[1];
  block.position.z.part[p] = rows[2];
  block.spin.x.part[p] = rows[3];
  block.velocity.x.part[p] = rows[4];
  block.velocity.y.part[p] = rows[5];
  block.velocity.z.part[p] = rows[6];
  block.spin.y.part[p] = rows[7];
}

template <bool spin>
[[gnu::always_inline]] inline BlockData pair_data(const SphereArrays& spheres,
                                                  const ContactArrays& contacts,
                                                  std::size_t index) {
  constexpr std::uint32_t per_row = 8 / n_lanes;  // vectors
  BlockData block;
  for (std::uint32_t p = 0; p < n_parts; ++p, index += n_lanes) {
    Lanes m[8];
    for (std::uint32_t lane = 0; lane < n_lanes; ++lane) {
      const double* a = numbers_of(spheres.rows[contacts.first[index + lane]]);
      const double* b = numbers_of(spheres.rows[contacts.second[index + lane]]);
      for (std::uint32_t k = 0; k < per_row; ++k) {
        LaneBits minus{};  // sign of the added rows: spins
        for (std::uint32_t l = 0; l < n_lanes; ++l)
          if (spin && (k * n_lanes + l) % 4 == 3) minus[l] = std::int64_t{1} << 63;
        m[lane * per_row + k] =
            lanes_at(a + k * n_lanes) - (Lanes)((LaneBits)lanes_at(b + k * n_lanes) ^ minus);
      }
      if constexpr (spin)
        block.spin.z.part[p][lane] = spheres.spin_z[contacts.first[index + lane]] +
                                     spheres.spin_z[contacts.second[index + lane]];
    }
    set_components(block, p, m);
  }
  return block;
}

template <bool spin>
[[gnu::always_inline]] inline BlockData sphere_data(const SphereArrays& spheres,
                                                    const ContactArrays& contacts,
                                                    std::size_t index) {
  constexpr std::uint32_t per_row = 8 / n_lanes;
  BlockData block;
  for (std::uint32_t p = 0; p < n_parts; ++p, index += n_lanes) {
    Lanes m[8];
    for (std::uint32_t lane = 0; lane < n_lanes; ++lane) {
      const double* a = numbers_of(spheres.rows[contacts.first[index + lane]]);
      for (std::uint32_t k = 0; k < per_row; ++k) m[lane * per_row + k] = lanes_at(a + k * n_lanes);
      if constexpr (spin) block.spin.z.part[p][lane] = spheres.spin_z[contacts.first[index + lane]];
    }
    set_components(block, p, m);
  }
  return block;
}

// Writes the actions of a block of contacts by the law. Returns false if the block is idle: no
// contact touches or remembers.
template <class Law, class AnyMeeting>
[[gnu::always_inline]] inline bool apply_law(const AnyMeeting& meeting,
                                             const ContactArrays& contacts, std::size_t index,
                                             const LawConstants& constants, double share) {
  Law law;
  read_history(law, contacts, index);
  if (!law.is_at_work(meeting)) {
    write_action(contacts, index, {}, share);
    return false;
  }
  const ContactAction<Wide> action = law(meeting, constants);
  write_history(law, contacts, index);
  write_action(contacts, index, action, share);
  return true;
}

// Returns true if any of a block's spheres may touch: in half the time of their meeting.
template <bool several>
[[gnu::always_inline]] inline bool may_touch(const SphereArrays& spheres,
                                             const ContactArrays& contacts, std::size_t index) {
  constexpr double reach2 = 1 + 1e-9;  // beyond the rounding of either way to compute distances
  HalfBits near{};
  for (std::size_t k = index; k < index + wide_size; k += 4) {
    Half m[4];
    for (std::size_t l = 0; l < 4; ++l)
      m[l] = half_at(numbers_of(spheres.rows[contacts.first[k + l]])) -
             half_at(numbers_of(spheres.rows[contacts.second[k + l]]));
    const Half a = __builtin_shufflevector(m[0], m[1], 0, 4, 2, 6);  // x0 x1 z0 z1
    const Half b = __builtin_shufflevector(m[2], m[3], 0, 4, 2, 6);
    const Half c = __builtin_shufflevector(m[0], m[1], 1, 5, 3, 7);
    const Half d = __builtin_shufflevector(m[2], m[3], 1, 5, 3, 7);
    const Half x = __builtin_shufflevector(a, b, 0, 1, 4, 5) - half_at(contacts.shift[0] + k);
    const Half y = __builtin_shufflevector(c, d, 0, 1, 4, 5) - half_at(contacts.shift[1] + k);
    const Half z = __builtin_shufflevector(a, b, 2, 3, 6, 7);
    Half cutoff2 = Half{} + reach2;
    if constexpr (several) {
      const Half touching = half_at(contacts.size[touching_distance] + k);
      cutoff2 = reach2 * (touching * touching);
    }
    near |= (HalfBits)(x * x + y * y + z * z < cutoff2);
  }
  return (near[0] | near[1] | near[2] | near[3]) != 0;
}

[[gnu::always_inline]] inline void keep_deepest(const ContactArrays& contacts,
                                                const Wide& deepest) {
  for (const Lanes& part : deepest.part)
    for (std::uint32_t k = 0; k < n_lanes; ++k)
      *contacts.deepest = part[k] > *contacts.deepest ? part[k] : *contacts.deepest;
}

[[gnu::always_inline]] inline void set_idle(const ContactArrays& contacts, std::size_t index,
                                            bool idle) {
  for (std::size_t k = 0; k < wide_size; k += smallest_block)
    contacts.idle[index + k] = idle ? 1 : 0;
}

// A pass of its own: beside a law's many numbers its own would be put aside and fetched again.
template <bool several>
[[gnu::noinline]] void find_idle(const ContactArrays& contacts, const SphereArrays& spheres) {
  for (std::size_t index = 0; index < contacts.n; index += wide_size) {
    if (contacts.idle[index] != 0 && may_touch<several>(spheres, contacts, index))
      set_idle(contacts, index, false);
  }
}

template <bool several>
using MeetingOf = std::conditional_t<several, SizedMeeting<Wide>, Meeting<Wide>>;

// Data of the sizes of the spheres in a block of contacts.
template <class Law>
[[gnu::always_inline]] inline void read_sizes(SizedMeeting<Wide>& meeting,
                                              const ContactArrays& contacts, std::size_t index) {
  meeting.per_diameter = Wide::load(contacts.size[per_diameter] + index);
  if constexpr (Law::has_dashpots) meeting.mass_root = Wide::load(contacts.size[mass_root] + index);
}

template <template <class, bool> class LawOf, bool friction, bool several>
void pairs(const ContactArrays& contacts, const SphereArrays& spheres,
           const LawConstants& constants) {
  using Law = LawOf<Wide, friction>;
  find_idle<several>(contacts, spheres);
  Wide deepest = *contacts.deepest;
  for (std::size_t index = 0; index < contacts.n; index += wide_size) {
    if (contacts.idle[index] != 0) continue;
    const BlockData block = pair_data<Law::has_spin>(spheres, contacts, index);
    const Vector3<Wide> branch = {block.position.x - Wide::load(contacts.shift[0] + index),
                                  block.position.y - Wide::load(contacts.shift[1] + index),
                                  block.position.z};
    const Wide distance = square_root(dot(branch, branch));
    MeetingOf<several> meeting;
    meeting.normal = scaled(1.0 / distance, branch);
    meeting.velocity = block.velocity;
    if constexpr (Law::has_spin) meeting.spin = block.spin;
    if constexpr (several) {
      read_sizes<Law>(meeting, contacts, index);
      meeting.overlap = Wide::load(contacts.size[touching_distance] + index) - distance;
      if constexpr (Law::has_spin)
        meeting.arm = Law::arm_is_radius ? meeting.normal : scaled(meeting.per_diameter, branch);
      deepest = greater(deepest,
                        meeting.overlap * Wide::load(contacts.size[per_smaller_diameter] + index));
    } else {
      meeting.overlap = 1.0 - distance;
      if constexpr (Law::has_spin)
        meeting.arm = scaled(Wide(0.5), Law::arm_is_radius ? meeting.normal : branch);
      deepest = greater(deepest, meeting.overlap);
    }
    set_idle(contacts, index, !apply_law<Law>(meeting, contacts, index, constants, 0.5));
  }
  keep_deepest(contacts, deepest);
}

template <template <class, bool> class LawOf, bool friction, bool several>
void sides(const ContactArrays& contacts, const SphereArrays& spheres,
           const LawConstants& constants) {
  using Law = LawOf<Wide, friction>;
  Wide deepest = *contacts.deepest;
  for (std::size_t index = 0; index < contacts.n; index += wide_size) {
    const BlockData block = sphere_data<Law::has_spin>(spheres, contacts, index);
    const Wide distance = Wide::load(contacts.side[3] + index);
    MeetingOf<several> meeting;
    meeting.normal = {Wide::load(contacts.side[0] + index), Wide::load(contacts.side[1] + index),
                      Wide::load(contacts.side[2] + index)};
    if constexpr (several) {
      read_sizes<Law>(meeting, contacts, index);
      meeting.overlap = Wide::load(contacts.size[touching_distance] + index) - distance;
    } else {
      meeting.overlap = 0.5 - distance;
    }
    meeting.velocity = {block.velocity.x, block.velocity.y,
                        block.velocity.z - contacts.side_velocity};
    if constexpr (Law::has_spin) {
      if constexpr (several) {
        meeting.arm = Law::arm_is_radius
                          ? meeting.normal
                          : scaled((2.0 * meeting.per_diameter) * distance, meeting.normal);
      } else {
        meeting.arm = scaled(Law::arm_is_radius ? Wide(0.5) : distance, meeting.normal);
      }
      meeting.spin = block.spin;
    }
    if constexpr (several) {
      deepest = greater(deepest, meeting.overlap * meeting.per_diameter);
    } else {
      deepest = greater(deepest, meeting.overlap);
    }
    apply_law<Law>(meeting, contacts, index, constants, 1.0);
  }
  keep_deepest(contacts, deepest);
}

// A leap-frog step (grain_loop.hpp, 4): every sphere sums the actions of its contacts in the order
// of its slots; velocities, half a step back, go a step on, and then the positions. Moment of
// inertia 1/10; of several sizes 2/5 of mass and radius squared.
template <bool spin, bool full_step, bool all, bool several>
[[gnu::always_inline]] inline void advance_spheres(const SphereArrays& spheres, Advance& step) {
  // The first half of an action, on the first sphere and on the second.
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
    Half force = weight, rest = {};  // the two halves of the sum of actions
    if (all || spheres.acted_upon[i] != 0) {
      for (std::uint32_t s = spheres.begin[i]; s < spheres.begin[i + 1]; ++s) {
        const std::uint32_t slot = spheres.slot[s];
        const double* action = numbers_of(spheres.action[slot >> 1]);
        force += sign_of[slot & 1] * half_at(action);
        rest += half_at(action + 4);
      }
      spheres.dissipated[2 * i] += rest[friction_place];
      spheres.dissipated[2 * i + 1] += rest[normal_place];
    }
    const Half kicked = force * kick, twisted = rest * twist;
    double* row = numbers_of(spheres.rows[i]);
    double* moving = full_step ? numbers_of(spheres.half_rows[i]) : row;
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
      const double turned = turn * rest[torque_z_place];
      if constexpr (full_step) {
        spheres.half_spin_z[i] += turned;
        spheres.spin_z[i] = spheres.half_spin_z[i] + 0.5 * turned;
      } else {
        spheres.spin_z[i] += turned;
      }
    }
    const Half relative = velocity - drift, squares = relative * relative;
    const double speed_squared = squares[0] + squares[1] + squares[2];
    fastest = speed_squared > fastest ? speed_squared : fastest;
  }
  step.fastest_squared = fastest;
}

template <bool spin, bool full_step, bool several>
void advance(const SphereArrays& spheres, Advance& step) {
  if (spheres.acted_upon == nullptr) {
    advance_spheres<spin, full_step, true, several>(spheres, step);
  } else {
    advance_spheres<spin, full_step, false, several>(spheres, step);
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
