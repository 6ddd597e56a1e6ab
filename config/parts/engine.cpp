#include "config/parts/kinds.hpp"
#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

constexpr Range stiffnesses = between(1, 1e12);  // N/m
constexpr Range restitutions = between(0.05, 1);
constexpr Range frictions = between(0, 100);
constexpr Range ratios = between(1e-3, 10);  // of stiffnesses
constexpr Range seconds = above(0, 1e5);

ContactLaw read_walton_braun(const Reader& in) {
  WaltonBraun law;
  if (!in.is_object_of({"stiffness", "restitution", "friction", "tangential_ratio"})) return law;
  in.read("stiffness", law.stiffness, stiffnesses);
  in.read("restitution", law.restitution, restitutions);
  in.read("friction", law.friction, frictions);
  in.read("tangential_ratio", law.tangential_ratio, ratios);
  return law;
}

Json written_walton_braun(const WaltonBraun& law) {
  return {{"stiffness", plain_number(law.stiffness)},
          {"restitution", plain_number(law.restitution)},
          {"friction", plain_number(law.friction)},
          {"tangential_ratio", plain_number(law.tangential_ratio)}};
}

ContactLaw read_linear(const Reader& in) {
  LinearSpringDashpot law;
  if (!in.is_object_of(
          {"stiffness", "restitution", "friction", "tangential_ratio", "tangential_damping"}))
    return law;
  in.read("stiffness", law.stiffness, stiffnesses);
  in.read("restitution", law.restitution, restitutions);
  in.read("friction", law.friction, frictions);
  in.read("tangential_ratio", law.tangential_ratio, ratios);
  in.read("tangential_damping", law.tangential_damping, between(0, 10));
  return law;
}

Json written_linear(const LinearSpringDashpot& law) {
  return {{"stiffness", plain_number(law.stiffness)},
          {"restitution", plain_number(law.restitution)},
          {"friction", plain_number(law.friction)},
          {"tangential_ratio", plain_number(law.tangential_ratio)},
          {"tangential_damping", plain_number(law.tangential_damping)}};
}

constexpr Kinds<ContactLaw> laws{{"walton_braun", read_walton_braun, written_walton_braun},
                                 {"linear_spring_dashpot", read_linear, written_linear}};

ContactLaw read_law(const Reader& in) {
  const auto choice = in.named_choice(names_of(laws));
  return choice ? read_kind(laws, *choice) : ContactLaw{};
}

Rest read_quiet(const Reader& in) {
  QuietRest rest;
  if (!in.is_object_of({"kinetic_energy", "seconds"})) return rest;
  in.read("kinetic_energy", rest.kinetic_energy, above(0, 1));
  in.read("seconds", rest.seconds, seconds);
  return rest;
}

Rest read_timed(const Reader& in) {
  TimedRest rest;
  if (!in.is_object_of({"seconds"})) return rest;
  in.read("seconds", rest.seconds, seconds);
  return rest;
}

constexpr Kinds<Rest> rests{{"quiet", read_quiet,
                             [](const QuietRest& rest) -> Json {
                               return {{"kinetic_energy", plain_number(rest.kinetic_energy)},
                                       {"seconds", plain_number(rest.seconds)}};
                             }},
                            {"timed", read_timed, [](const TimedRest& rest) -> Json {
                               return {{"seconds", plain_number(rest.seconds)}};
                             }}};

DiscreteElement read_discrete_element(const Reader& in) {
  DiscreteElement engine;
  if (!in.is_object_of({"diameter", "density", "gravity", "contact", "floor", "sides",
                        "steps_per_contact", "rest", "most_seconds"}))
    return engine;
  in.read("diameter", engine.diameter, between(1e-6, 10));
  in.read("density", engine.density, between(1, 1e5));
  in.read("gravity", engine.gravity, between(1e-4, 1e4));
  if (const auto law = in.find("contact")) engine.spheres = read_law(*law);
  if (const auto law = in.find("floor")) engine.floor = read_law(*law);
  if (const auto law = in.find("sides")) engine.sides = read_law(*law);
  double steps = steps_of_contact(engine);
  in.read("steps_per_contact", steps, between(40, 1e6));
  engine.steps_per_contact = steps;
  if (const auto rest = in.find("rest")) {
    if (const auto choice = rest->named_choice(names_of(rests)))
      engine.rest = read_kind(rests, *choice);
  }
  in.read("most_seconds", engine.most_seconds, seconds);
  return engine;
}

Json written(const DiscreteElement& engine) {
  Json out = {{"diameter", plain_number(engine.diameter)},
              {"density", plain_number(engine.density)},
              {"gravity", plain_number(engine.gravity)},
              {"contact", written_kind(laws, engine.spheres)}};
  if (engine.floor) out["floor"] = written_kind(laws, *engine.floor);
  if (engine.sides) out["sides"] = written_kind(laws, *engine.sides);
  out["steps_per_contact"] = plain_number(steps_of_contact(engine));
  out["rest"] = written_kind(rests, engine.rest);
  out["most_seconds"] = plain_number(engine.most_seconds);
  return out;
}

}  // namespace

std::optional<DiscreteElement> read_engine(const Reader& in) {
  const auto choice = in.named_choice({"monte_carlo", "discrete_element"});
  if (!choice) return std::nullopt;
  if (choice->name == "discrete_element") return read_discrete_element(choice->settings);
  choice->settings.is_object_of({});  // its settings are "relax" and "relax_start"
  return std::nullopt;
}

Json written_engine(const DiscreteElement& engine) {
  return {{"discrete_element", written(engine)}};
}

}  // namespace jostle::inline config
