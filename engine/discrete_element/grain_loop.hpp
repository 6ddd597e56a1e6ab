#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/bed/bed_mechanics.hpp"
#include "engine/bed/packing.hpp"
#include "engine/discrete_element/contact_lists.hpp"
#include "engine/discrete_element/floor_motion.hpp"
#include "engine/discrete_element/reduced.hpp"
#include "engine/instruction_set.hpp"

namespace jostle::inline engine {

inline constexpr double sphere_inertia = 0.1;  // moment of, of a sphere of diameter and mass 1

/// A bed's energies, in m g d of the whole bed. The received energy less the dissipated energy is
/// the energy of the bed: the ledger closes within the accuracy of the integration.
struct Energies {
  double kinetic = 0;     // energy of centres and spins
  double potential = 0;   // energy of gravity, from z = 0
  double elastic = 0;     // stored in contacts
  double latched = 0;     // lost in Walton & Braun's springs, or in normal dashpots
  double friction = 0;    // lost by sliding, or in tangential dashpots
  double floor_work = 0;  // by the floor on the spheres

  double held() const { return kinetic + potential + elastic; }
  double dissipated() const { return latched + friction; }
};

/// Contacts as they are.
struct ContactCensus {
  double contacts = 0;      // a sphere, with force; those with floor and sides count once
  double sliding = 0;       // share of the contacts of two spheres whose tangential force is mu N
  double mean_overlap = 0;  // mean overlap of contacts between spheres, diameters of the smaller
};

/// How deep two bodies lie in each other, and how fast they part along their normal.
struct Approach {
  double overlap = 0, speed = 0;
};

/// State of a sphere that passes from step to step.
struct GrainState {
  Vec3 centre;                       // not brought into the box
  Vec3 velocity, spin;               // half a step before; spins of sizes are radius x spin
  Vec3 seen_velocity, seen_spin;     // input of the contact law
  double friction = 0, latched = 0;  // dissipated since the loop was loaded
};

/// Spheres that move by Newton's equations with the forces of contact_law.hpp, in steps dt of one
/// length, by the leap-frog: velocities and spins are half a step behind the positions. The
/// method is that of Cundall & Strack, Geotechnique 29, 47 (1979); Rosato et al. 2010, sec. III.
/// With x_k, the positions at the time k dt, a step is
///
///   1. the floor goes to its place at k dt                                        FloorMotion
///   2. lists of near pairs are renewed unless all that touch are in them          ContactLists
///   3. F_k = F(x_k, v, histories), of pairs, floor and sides                      contact_law.hpp
///   4. v_(k+1/2) = v_(k-1/2) + dt (F_k / m - g z),  x_(k+1) = x_k + dt v_(k+1/2) grain_kernels.cpp
///
/// and so for spins with the torques. WaltonBraunLaw takes v = v_(k-1/2), which gives the
/// displacement of the last step; LinearLaw, whose dashpots need the velocity at the time of the
/// positions, v_(k-1/2) + dt a_(k-1) / 2. Invariants: every pair that overlaps is in the near
/// lists; a sphere sums its contacts in the order of the spheres' numbers, so that results are the
/// same on every instruction set, and however spheres are sorted and lists are made.
class GrainLoop {
 public:
  /// Sizes of the spheres, or null for equal ones.
  GrainLoop(const Container& container, const ReducedSettings& settings,
            InstructionSet set = best_instruction_set(),
            std::shared_ptr<const Sizes> sizes = nullptr);

  /// Takes over a bed at rest. Throws std::invalid_argument for one of other sizes than the loop's.
  void load(const Packing& bed);
  /// [n_spheres] centres, brought into the box, in the order of load(), and their sizes.
  void store(Packing& bed) const;
  std::vector<GrainState> grains() const;  // in the order of load()
  /// Moves every centre, as a tap that is a displacement does; velocities stay.
  void displace(const Packing& displaced);

  /// The floor moves from the next step on.
  void begin_motion(const FloorMotion& motion);
  bool floor_moves() const { return time_ < motion_.duration(); }
  const FloorMotion& motion() const { return motion_; }
  std::uint64_t steps() const { return steps_; }
  /// Since the last begin_motion.
  double time() const { return time_; }
  void run(std::uint64_t steps);

  /// Value at the time of the positions.
  Energies energies() const;
  ContactCensus census();
  /// Value of velocities half a step before the positions, summed in the order of load().
  double kinetic_energy() const;
  /// Contacts with the forces of the step that would follow, and velocities and spins at the time
  /// of the positions: those half a step before, with half a step of what acts. Spins of laws with
  /// friction alone. Times in sqrt(diameter / gravity).
  BedMechanics mechanics() const;
  /// In diameters of the smaller of the two spheres.
  double greatest_overlap() const { return lists_.deepest(); }
  void forget_greatest_overlap() { lists_.set_deepest(0); }
  /// True if all spheres are at possible places.
  bool is_sound() const;
  std::size_t n_spheres() const { return numbers_.size(); }
  /// Mass of all spheres, in masses of a sphere of diameter 1 and density 1.
  double mass() const;
  std::uint64_t pair_tests() const { return pair_tests_; }
  std::size_t bytes() const;

  /// All that the next step depends on.
  struct State {
    std::vector<GrainState> grains;  // in the order of load()
    std::vector<KeptPair> pairs;
    std::vector<KeptSide> sides;
    FloorMotion motion;
    std::uint64_t steps = 0;  // since motion began
    double floor_work = 0, floor_force = 0, greatest_overlap = 0;
  };
  State state() const;
  void restore(const State& state);

 private:
  void place(const std::vector<GrainState>& grains);
  void place_sizes();
  void step();
  void find_forces();
  Energies contact_energies() const;
  double sliding_share() const;
  void add_contacts(std::vector<Contact>& contacts);
  void add_velocities(BedMechanics& mechanics);
  void renew_lists();
  bool near_lists_hold();
  Approach approach_of(const KeptPair& pair) const;
  Approach approach_of(const KeptSide& side) const;
  double radius_of(std::uint32_t sphere) const {
    return sizes_ ? sizes_->radius(sphere) : sphere_radius;
  }
  double mass_of(std::uint32_t sphere) const { return sizes_ ? sizes_->mass(sphere) : 1; }
  /// Square of the spin in grains().
  double inertia_of(std::uint32_t sphere) const {
    return sizes_ ? 4 * sphere_inertia * sizes_->mass(sphere) : sphere_inertia;
  }
  /// Those of the contact, for the masses that meet there.
  LawConstants constants_of(const KeptPair& pair) const;
  LawConstants constants_of(const KeptSide& side) const;
  double farthest_since(const std::vector<Vec3>& reference, const Vec3& drift) const;
  SphereArrays spheres();

  Container container_;
  Boundary boundary_;
  ReducedSettings settings_;
  std::shared_ptr<const Sizes> sizes_;  // null: equal spheres
  GrainKernels kernels_;
  ContactLists lists_;

  std::vector<std::uint32_t> numbers_;       // numbers of the sphere at each place
  std::vector<std::uint32_t> place_of_;      // place of each sphere
  std::vector<SphereRow> rows_, half_rows_;  // [n_spheres + 2]
  std::vector<double> spin_z_, half_spin_z_, dissipated_;
  std::vector<double> mass_at_, per_mass_at_;  // [n_spheres] by place; empty of equal spheres

  FloorMotion motion_;
  std::uint64_t steps_ = 0;
  double time_ = 0;
  FloorMotion::Place floor_;
  double floor_work_ = 0, floor_force_ = 0;

  // How far spheres may have come since the lists were made, against what drifts with the bed.
  bool have_lists_ = false;
  double side_path_ = 0, pair_path_ = 0;
  Vec3 drift_;                   // velocity
  Vec3 near_drift_, far_drift_;  // displacements
  std::vector<Vec3> near_reference_, far_reference_;
  std::uint64_t pair_tests_ = 0;
};

}  // namespace jostle::inline engine
