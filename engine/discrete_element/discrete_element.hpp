#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/bed/mixture.hpp"
#include "engine/column.hpp"
#include "engine/dynamics.hpp"
#include "engine/fields.hpp"

// The discrete-element engine: inelastic, frictional, rotating spheres move by Newton's equations
// (Rosato et al. 2010, sec. III). Settings are in SI units.
namespace jostle::inline engine {

inline constexpr Range stiffness_range = closed_range(1, 1e12);          // N/m
inline constexpr Range tangential_ratio_range = closed_range(1e-3, 10);  // ratio to the stiffness
inline constexpr Range rest_seconds_range = left_open_range(0, 1e5);     // s
inline constexpr Range contact_steps_range = closed_range(40, 1e6);      // time steps of a contact

/// The fields that all contact laws share.
template <class Law>
constexpr auto contact_fields(std::string_view ratio) {
  return std::tuple{
      field("stiffness", &Law::stiffness, Number{stiffness_range, "N/m"}),
      field("restitution", &Law::restitution, Number{closed_range(0.05, 1)},
            "Speed after / before a head-on collision"),
      field("friction", &Law::friction, Number{closed_range(0, 100)},
            "mu. 0: no tangential forces and no spin"),
      field("tangential_ratio", &Law::tangential_ratio, Number{tangential_ratio_range}, ratio)};
}

/// Partially latched springs (Walton & Braun 1986), with friction after Mindlin & Deresiewicz
/// (Walton & Braun's incremental form, exponent 1/3).
/// engine/discrete_element/kernel/contact_law.hpp
struct WaltonBraun {
  double stiffness = 1e5;         // K1, N/m
  double restitution = 0.9;       // in [0.05, 1]
  double friction = 0.1;          // mu; 0: no tangential forces, no spin
  double tangential_ratio = 0.8;  // K0 / K1
  bool operator==(const WaltonBraun&) const = default;

  static constexpr Description description{
      "walton_braun",
      "Partially latched springs (Walton & Braun 1986) with friction after Mindlin & Deresiewicz"};
  static constexpr auto fields() { return contact_fields<WaltonBraun>("K0 / K1"); }
};

/// Springs and dashpots (Cundall & Strack 1979), the tangential one cut where it slides.
struct LinearSpringDashpot {
  double stiffness = 1e5;             // N/m
  double restitution = 0.9;           // in [0.05, 1]
  double friction = 0.1;              // mu; 0: no tangential forces, no spin
  double tangential_ratio = 2.0 / 7;  // ratio to the normal stiffness
  double tangential_damping = 0.5;    // ratio of the dashpots' coefficients
  bool operator==(const LinearSpringDashpot&) const = default;

  static constexpr Description description{"linear_spring_dashpot",
                                           "Springs and dashpots (Cundall & Strack 1979)"};
  template <class Self = LinearSpringDashpot>
  static constexpr auto fields() {
    return std::tuple_cat(
        contact_fields<LinearSpringDashpot>("Ratio of the stiffnesses; 2/7 where absent"),
        std::tuple{field("tangential_damping", &Self::tangential_damping,
                         Number{closed_range(0, 10)}, "Ratio of the dashpots' coefficients")});
  }
};

using ContactLaw = std::variant<WaltonBraun, LinearSpringDashpot>;

/// A bed is at rest once its kinetic energy a sphere stays below `kinetic_energy`, in m g d, for
/// `seconds`. A bed thrown up hardly moves at the top of its flight: it is not at rest there.
struct QuietRest {
  double kinetic_energy = 5e-5;
  double seconds = 0.02;
  bool operator==(const QuietRest&) const = default;

  static constexpr Description description{"quiet"};
  template <class Self = QuietRest>
  static constexpr auto fields() {
    return std::tuple{
        field("kinetic_energy", &Self::kinetic_energy, Number{left_open_range(0, 1), "m g d"},
              "Kinetic energy per sphere at rest"),
        field("seconds", &Self::seconds, Number{rest_seconds_range, "s"},
              "How long it stays below")};
  }
};

/// A tap ends so many seconds after the floor has come to rest.
struct TimedRest {
  double seconds = 0.75;
  bool operator==(const TimedRest&) const = default;

  static constexpr Description description{"timed"};
  template <class Self = TimedRest>
  static constexpr auto fields() {
    return std::tuple{field("seconds", &Self::seconds, Number{rest_seconds_range, "s"},
                            "Time after the floor came to rest")};
  }
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
  std::optional<ContactLaw> floor, sides;  // with the floor and the sides; absent: as `spheres`
  std::optional<double>
      steps_per_contact{};  // steps of the shortest contact; absent: steps_of_contact()
  Rest rest;
  double most_seconds = 5;  // limit of one tap or start: then it is capped
  /// True if both move grains alike: a default that is spelled out is the same.
  bool operator==(const DiscreteElement& grains) const;

  template <class Self = DiscreteElement>
  static constexpr auto fields() {
    constexpr OneOf<ContactLaw> law{.by_name = true, .definition = "contact_law"};
    return std::tuple{
        field("diameter", &Self::diameter, Number{closed_range(1e-6, 10), "m"}),
        field("density", &Self::density, Number{closed_range(1, 1e5), "kg/m^3"}),
        field("gravity", &Self::gravity, Number{closed_range(1e-4, 1e4), "m/s^2"}),
        field("contact", &Self::spheres, law, "Contact law of two spheres"),
        field("floor", &Self::floor, law,
              "Contact law of a sphere and the floor; absent: that of two spheres"),
        field("sides", &Self::sides, law,
              "Contact law of a sphere and a side; absent: that of two spheres"),
        field("steps_per_contact", &Self::steps_per_contact, Number{contact_steps_range},
              "Time steps that the shortest contact takes. Without it 40; 160 of "
              "linear_spring_dashpot"),
        field(
            "rest", &Self::rest, OneOf<Rest>{.by_name = true},
            "When a tap, or the start, has come to rest. quiet: the kinetic energy per sphere, in "
            "m g d, stays below a value for so many seconds. timed: so many seconds after the "
            "floor came to rest",
            {.title = "Rest"}),
        field("most_seconds", &Self::most_seconds, Number{rest_seconds_range},
              "A tap, or the start, that is not at rest so many seconds after the floor is "
              "capped")};
  }
};

/// Time steps of the shortest contact, at least: 40 by default, 160 for springs with dashpots,
/// whose force begins and ends with a jump.
double steps_of_contact(const DiscreteElement& settings);

/// Why beds of the container cannot be moved so; nothing if they can.
std::optional<std::string> engine_fault(const DiscreteElement& settings,
                                        const Container& container);

/// The lightest bodies that meet in a bed, which make the shortest contacts. In masses of a sphere
/// of diameter 1 and density 1.
struct LightestMasses {
  double sphere = 1;  // the lightest of all: with floor and sides
  double pair = 0.5;  // reduced mass of the two lightest: m1 m2 / (m1 + m2)
};
LightestMasses lightest_masses(std::span<const double> masses);
LightestMasses lightest_masses(const Packing& bed);
/// Bounds from below, whatever diameters are drawn. Requires kinds without faults; those of equal
/// spheres where there are none.
LightestMasses lightest_masses(const std::vector<MixtureKind>& kinds);

/// Numbers derived from the settings.
struct ContactTimes {
  double mass = 0;             // mass of a sphere of diameter 1 and density 1, kg
  double contact_seconds = 0;  // duration of a collision of the two lightest spheres
  double step_seconds = 0;
};
ContactTimes contact_times(const DiscreteElement& settings, const LightestMasses& lightest = {});

/// A floor that moves needs so many time steps in half a period, at least.
inline constexpr double least_steps_per_half_period = 20;

/// Columns of every tap, and of the start. For spheres of several sizes energies are in units of
/// their mean weight times d, and overlaps are relative to the smaller sphere.
std::vector<Column> columns(const DiscreteElement& settings, Spheres spheres = Spheres::equal);

/// One realization's mechanics. A unit is one sphere moved through one time step.
std::unique_ptr<Dynamics> make_dynamics(const DiscreteElement& settings,
                                        const DynamicsStreams& streams);

}  // namespace jostle::inline engine
