#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/discrete_element/kernel/law_constants.hpp"
#include "engine/large_pages.hpp"

// Input and output of the kernels, as plain arrays. Units as in contact_law.hpp.
namespace jostle::inline engine {

/// A sphere that moves, in one cache line of two halves: position and velocity, each with a
/// component of the spin; spin z is in an array of its own. For spheres of several sizes spins are
/// radius x angular velocity.
struct alignas(64) SphereRow {
  double x = 0, y = 0, z = 0, spin_x = 0;
  double velocity_x = 0, velocity_y = 0, velocity_z = 0, spin_y = 0;
};

/// The action of a contact in a step, in one cache line: force on its first sphere (the opposite
/// acts on the second), torque on each of the two, and dissipated energies, halved where two
/// spheres share them. For spheres of several sizes torques are divided by the radius, which makes
/// them equal for both spheres. A component has the place, in its half, of the component of a
/// SphereRow that it changes: a step then adds whole halves.
struct alignas(64) ActionRow {
  double force_x = 0, force_y = 0, force_z = 0, torque_y = 0;
  double dissipated_by_friction = 0, dissipated_normally = 0, torque_z = 0, torque_x = 0;
};

/// A vector whose elements begin at a cache line, as kernels load them.
template <class T>
using CacheLines = std::vector<T, LargePageAllocator<T>>;

/// True if kernels take the radii and masses of the spheres, or 1/2 and 1.
enum class GrainSizes { equal, several };

/// Data of contacts of spheres of several sizes, each in an array of its own.
enum ContactSize : std::size_t {
  touching_distance,    // the sum of the radii; at a side the radius
  per_diameter,         // 1 / (sum of the radii); at a side 1 / diameter
  mass_root,            // square root of the mass of both together over that of spheres of mass 1
  per_smaller_diameter  // 1 / (the diameter of the smaller sphere)
};
inline constexpr std::size_t n_contact_sizes = 4;

/// The most numbers that a law remembers of a contact.
inline constexpr std::size_t most_history = 6;

/// Kernels go through contacts in blocks of 4, 8 or 16.
inline constexpr std::size_t smallest_block = 4, block_size = 16;

/// Contacts that may be: pairs of spheres, or spheres and sides. All arrays are of `n` entries, a
/// multiple of block_size; what fills the last block are spheres that touch nothing.
struct ContactArrays {
  std::size_t n = 0;
  const std::uint32_t* first = nullptr;
  const std::uint32_t* second = nullptr;              // second sphere of pairs
  std::array<const double*, 2> shift{};               // shift of pairs: periods in x and y
  std::array<const double*, 4> side{};                // plane of sides: normal, distance
  std::array<const double*, n_contact_sizes> size{};  // data of several sizes, by ContactSize
  std::array<double*, most_history> history{};
  ActionRow* action = nullptr;
  // Flags of pairs: in every fourth 1 if the kernel's block has neither history nor action.
  std::uint8_t* idle = nullptr;
  double side_velocity = 0;   // velocity of the floor, upwards
  double* deepest = nullptr;  // the greatest overlap, raised; in diameters of the smaller sphere
};

/// The spheres, [n_spheres + 2]: the last two touch nothing.
struct SphereArrays {
  std::size_t n = 0;
  SphereRow* rows = nullptr;
  double* spin_z = nullptr;
  // Rows for laws that use full steps: velocity and spin half a step before.
  SphereRow* half_rows = nullptr;
  double* half_spin_z = nullptr;
  double* dissipated = nullptr;          // [n][2] by friction, normally
  const std::uint32_t* begin = nullptr;  // [n + 1], of `slot`
  const std::uint32_t* slot = nullptr;   // contact x 2, plus 1 for the second sphere
  const ActionRow* action = nullptr;
  const double* mass = nullptr;              // mass for several sizes: [n]
  const double* per_mass = nullptr;          // 1 / mass for several sizes: [n]
  const std::uint8_t* acted_upon = nullptr;  // [n] 0 where all actions are 0; null: not known
};

/// Input and results of an advance by one step.
struct Advance {
  double time_step = 0, gravity = 1;
  double drift[3] = {0, 0, 0};  // velocity from which `fastest` is counted
  double fastest_squared = 0;
};

/// One law, for one instruction set.
struct GrainKernels {
  void (*pairs)(const ContactArrays&, const SphereArrays&, const LawConstants&);
  void (*sides)(const ContactArrays&, const SphereArrays&, const LawConstants&);
  void (*advance)(const SphereArrays&, Advance&);
  int n_history;
  bool has_spin, sees_full_step;
};

enum class GrainLaw { walton_braun, walton_braun_smooth, linear, linear_smooth };

namespace baseline {
GrainKernels grain_kernels(GrainLaw law, GrainSizes sizes = GrainSizes::equal);
}
namespace avx2 {
GrainKernels grain_kernels(GrainLaw law, GrainSizes sizes = GrainSizes::equal);
}
namespace avx512 {
GrainKernels grain_kernels(GrainLaw law, GrainSizes sizes = GrainSizes::equal);
}

}  // namespace jostle::inline engine
