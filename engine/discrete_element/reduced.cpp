#include "engine/discrete_element/reduced.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "engine/bed/container.hpp"
#include "engine/bed/elementary.hpp"

namespace jostle::inline engine {

namespace {

using std::numbers::pi;

// For a contact whose two bodies have this mass together: 1/2 of two spheres, 1 of one and a side.
// `unit` is the stiffness m g / d.
struct MakeConstants {
  double unit, mass;

  LawConstants operator()(const WaltonBraun& law) const {
    const double k1 = law.stiffness / unit, e2 = law.restitution * law.restitution;
    return {.stiffness = k1,
            .unloading = k1 / e2,
            .latched = 1 - e2,
            .tangential = law.tangential_ratio * k1,
            .friction = law.friction};
  }
  // A damped oscillation that ends after half a period: e = exp(-gamma t_c / 2), with the dashpot's
  // coefficient mass x gamma.
  LawConstants operator()(const LinearSpringDashpot& law) const {
    const double k = law.stiffness / unit;
    const double loss = -natural_log(law.restitution);
    const double gamma = 2 * loss * std::sqrt(k / mass / (pi * pi + loss * loss));
    return {.stiffness = k,
            .tangential = law.tangential_ratio * k,
            .friction = law.friction,
            .damping = mass * gamma,
            .shear_damping = law.tangential_damping * mass * gamma};
  }
};

// How long a contact of this mass lasts, and how long its faster half, twice.
struct Lasting {
  double whole, faster;
};
struct LastingOf {
  double mass;

  Lasting operator()(const WaltonBraun& law, const LawConstants& constants) const {
    const double quarter = 0.5 * pi * std::sqrt(mass / constants.stiffness);
    return {quarter * (1 + law.restitution), 2 * quarter * law.restitution};
  }
  Lasting operator()(const LinearSpringDashpot&, const LawConstants& constants) const {
    const double damped = 0.5 * constants.damping / mass;
    const double half = pi / std::sqrt(constants.stiffness / mass - damped * damped);
    // Along the tangent plane spheres turn, too: 2/7 of the mass. Its spring and its dashpot must
    // be resolved as well, the latter by ten steps of its own time.
    const double turning = 2.0 / 7 * mass;
    const double tangential = pi * std::sqrt(turning / constants.tangential);
    const double dashpot =
        constants.shear_damping > 0 ? 4 * turning / constants.shear_damping : half;
    return {half, std::min({half, tangential, dashpot})};
  }
};

double friction_of(const ContactLaw& law) {
  return std::visit([](const auto& contact_law) { return contact_law.friction; }, law);
}

double sphere_mass(const DiscreteElement& settings) {
  const double d = settings.diameter;
  return sphere_volume * d * d * d * settings.density;
}

GrainLaw law_of(const DiscreteElement& settings, const ContactLaw& floor, const ContactLaw& sides) {
  const bool friction =
      friction_of(settings.spheres) > 0 || friction_of(floor) > 0 || friction_of(sides) > 0;
  if (std::holds_alternative<WaltonBraun>(settings.spheres))
    return friction ? GrainLaw::walton_braun : GrainLaw::walton_braun_smooth;
  return friction ? GrainLaw::linear : GrainLaw::linear_smooth;
}

}  // namespace

ReducedSettings reduced(const DiscreteElement& settings, const LightestMasses& lightest) {
  const ContactLaw& floor = settings.floor ? *settings.floor : settings.spheres;
  const ContactLaw& sides = settings.sides ? *settings.sides : settings.spheres;
  if (floor.index() != settings.spheres.index() || sides.index() != settings.spheres.index())
    throw std::invalid_argument("spheres, floor and sides have one kind of contact law");
  const double unit = sphere_mass(settings) * settings.gravity / settings.diameter;
  ReducedSettings reduced_settings;
  reduced_settings.law = law_of(settings, floor, sides);
  reduced_settings.seconds = std::sqrt(settings.diameter / settings.gravity);
  double shortest = std::numeric_limits<double>::infinity();
  // All times of a contact go with the root of the mass.
  const auto constants = [&](const ContactLaw& law, double mass, double least_mass) {
    const LawConstants made = std::visit(MakeConstants{unit, mass}, law);
    const Lasting lasts = std::visit(
        [&](const auto& contact_law) { return LastingOf{mass}(contact_law, made); }, law);
    const double root = std::sqrt(least_mass / mass);
    shortest = std::min({shortest, root * lasts.whole, root * lasts.faster});
    if (mass < 1) reduced_settings.contact_time = root * lasts.whole;
    return made;
  };
  reduced_settings.spheres = constants(settings.spheres, 0.5, lightest.pair);
  reduced_settings.floor = constants(floor, 1, lightest.sphere);
  reduced_settings.sides = constants(sides, 1, lightest.sphere);
  reduced_settings.time_step = shortest / steps_of_contact(settings);
  for (LawConstants* law_constants :
       {&reduced_settings.spheres, &reduced_settings.floor, &reduced_settings.sides})
    law_constants->time_step = reduced_settings.time_step;
  return reduced_settings;
}

bool DiscreteElement::operator==(const DiscreteElement& grains) const {
  const auto all_but_steps = [](const DiscreteElement& settings) {
    return std::tie(settings.diameter, settings.density, settings.gravity, settings.spheres,
                    settings.floor, settings.sides, settings.rest, settings.most_seconds);
  };
  return all_but_steps(*this) == all_but_steps(grains) &&
         steps_of_contact(*this) == steps_of_contact(grains);
}

double steps_of_contact(const DiscreteElement& settings) {
  const bool has_dashpots = std::holds_alternative<LinearSpringDashpot>(settings.spheres);
  return settings.steps_per_contact.value_or(has_dashpots ? 160 : 40);
}

LightestMasses lightest_masses(std::span<const double> masses) {
  double first = std::numeric_limits<double>::infinity(), second = first;
  for (const double mass : masses) {
    if (mass < second) second = mass;
    if (second < first) std::swap(first, second);
  }
  if (masses.empty()) return {};
  if (masses.size() == 1) return {first, 0.5 * first};
  return {first, first * second / (first + second)};
}

LightestMasses lightest_masses(const Packing& bed) {
  return bed.sizes ? lightest_masses(bed.sizes->masses()) : LightestMasses{};
}

LightestMasses lightest_masses(const std::vector<MixtureKind>& kinds) {
  std::vector<double> masses;
  for (const MixtureKind& kind : kinds) {
    const auto add = [&](double d) { masses.push_back(kind.density * (d * d * d)); };
    if (const auto* listed = std::get_if<ListedDiameters>(&kind.diameter)) {
      std::ranges::for_each(listed->values, add);
    } else {
      for (std::uint32_t k = 0; k < std::min(kind.count, 2u); ++k)
        add(range_of(kind.diameter).least);
    }
  }
  return lightest_masses(masses);
}

ContactTimes contact_times(const DiscreteElement& settings, const LightestMasses& lightest) {
  const ReducedSettings units = reduced(settings, lightest);
  return {sphere_mass(settings), units.contact_time * units.seconds,
          units.time_step * units.seconds};
}

}  // namespace jostle::inline engine
