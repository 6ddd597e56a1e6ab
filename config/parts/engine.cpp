#include "config/parts/parts.hpp"

namespace jostle::inline config {

bool read_part(const Reader& reader, DiscreteElement& grains) {
  return read_object(DiscreteElement::fields(), reader, grains);
}
Json written_part(const DiscreteElement& grains) {
  DiscreteElement complete = grains;
  complete.steps_per_contact = steps_of_contact(grains);
  return written_object(DiscreteElement::fields(), complete);
}
Json part_schema(std::type_identity<DiscreteElement>, Definitions& definitions) {
  return object_schema(DiscreteElement::fields(), definitions).json();
}

std::optional<DiscreteElement> read_engine(const Reader& reader) {
  const auto choice = reader.named_choice({"monte_carlo", "discrete_element"});
  if (!choice) return std::nullopt;
  if (choice->name == "discrete_element") {
    DiscreteElement grains;
    read_part(choice->settings, grains);
    return grains;
  }
  choice->settings.is_object_of({});  // its settings are "relax" and "relax_start"
  return std::nullopt;
}

Json written_engine(const DiscreteElement& grains) {
  return {{"discrete_element", written_part(grains)}};
}

Json engine_schema(Definitions& definitions) {
  ObjectSchema engines;
  engines.rules = {{"minProperties", 1}, {"maxProperties", 1}};
  engines.properties = {
      {"monte_carlo", ObjectSchema{}.json()},
      {"discrete_element",
       described_as(part_schema(std::type_identity<DiscreteElement>{}, definitions),
                    "Discrete elements",
                    "Inelastic, frictional, rotating spheres by Newton's equations. SI units.",
                    std::nullopt, "")}};
  return either(words_schema({"monte_carlo", "discrete_element"}), engines.json());
}

}  // namespace jostle::inline config
