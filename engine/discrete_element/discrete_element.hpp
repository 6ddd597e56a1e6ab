#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/column.hpp"
#include "engine/dynamics.hpp"

// The discrete-element engine: inelastic, frictional, rotating spheres move by Newton's equations
// (Rosato et al. 2010, sec. III). Settings are in SI units.
namespace jostle::inline engine {

/// Partially latched springs (Walton & Braun 1986), with friction after Mindlin & Deresiewicz
/// (Walton & Braun's incremental form, exponent 1/3).
/// engine/discrete_element/kernel/contact_law.hpp
struct WaltonBraun {
  double stiffness = 1e5;         // K1, N/m
  double restitution = 0.9;       // in [0.05, 1]
  double friction = 0.1;          // mu; 0: no tangential forces, no spin
  double tangential_ratio = 0.8;  // K0 / K1
  bool operator==(const WaltonBraun&) const = default;
};

/// Springs and dashpots (Cundall & Strack 1979), the tangential one cut where it slides.
struct LinearSpringDashpot {
  double stiffness = 1e5;             // N/m
  double restitution = 0.9;           // in [0.05, 1]
  double friction = 0.1;              // mu; 0: no tangential forces, no spin
  double tangential_ratio = 2.0 / 7;  // of the stiffnesses
  double tangential_damping = 0.5;    // of the dashpots' coefficients
  bool operator==(const LinearSpringDashpot&) const = default;
};

using ContactLaw = std::variant<WaltonBraun, LinearSpringDashpot>;

/// A bed is at rest once its kinetic energy a sphere stays below `kinetic_energy`, in m g d, for
/// `seconds`. A bed thrown up hardly moves at the top of its flight: it is not at rest there.
struct QuietRest {
  double kinetic_energy = 5e-5;
  double seconds = 0.02;
  bool operator==(const QuietRest&) const = default;
};

/// A tap ends so many seconds after the floor has come to rest.
struct TimedRest {
  double seconds = 0.75;
  bool operator==(const TimedRest&) const = default;
};

using Rest = std::variant<QuietRest, TimedRest>;

struct DiscreteElement {
  static constexpr const char *unit = "sphere steps", *round = "time steps";
  /// Simulated time of a tap.
  static constexpr const char *work_column = "seconds", *work = "simulated seconds";

  double diameter = 0.02;  // m
  double density = 1200;   // kg/m^3
  double gravity = 9.81;   // m/s^2
  ContactLaw spheres;
  std::optional<ContactLaw> floor, sides;     // with the floor and the sides; absent: as `spheres`
  std::optional<double> steps_per_contact{};  // of the shortest; absent: steps_of_contact()
  Rest rest;
  double most_seconds = 5;  // of one tap or start: then it is capped
  bool operator==(const DiscreteElement&) const = default;
};

/// Time steps of the shortest contact, at least: 40 where the scene does not say, 160 of springs
/// with dashpots, whose force begins and ends with a jump.
double steps_of_contact(const DiscreteElement& settings);

/// Why beds of the container cannot be moved so; nothing if they can.
std::optional<std::string> engine_fault(const DiscreteElement& settings,
                                        const Container& container);

/// What the settings come to.
struct ContactTimes {
  double mass = 0;             // of a sphere, kg
  double contact_seconds = 0;  // that two spheres touch in a collision
  double step_seconds = 0;
};
ContactTimes contact_times(const DiscreteElement& settings);

/// What is recorded of every tap, and of the start.
std::vector<Column> columns(const DiscreteElement& settings);

/// One realization's mechanics. A unit is one sphere moved through one time step.
std::unique_ptr<Dynamics> make_dynamics(const DiscreteElement& settings,
                                        const DynamicsStreams& streams);

}  // namespace jostle::inline engine
