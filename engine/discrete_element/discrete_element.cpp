#include "engine/discrete_element/discrete_element.hpp"

#include "engine/dropped_offsets.hpp"

namespace jostle::inline engine {

std::optional<std::string> engine_fault(const DiscreteElement& settings,
                                        const Container& container) {
  if (!has_gravity(container))
    return "discrete elements fall on a floor: without gravity (fully_periodic) there is none";
  const auto differs = [&](const std::optional<ContactLaw>& law) {
    return law && law->index() != settings.spheres.index();
  };
  if (differs(settings.floor) || differs(settings.sides))
    return "the contacts with floor and sides have the law of those between spheres, walton_braun "
           "or linear_spring_dashpot";
  return std::nullopt;
}

std::vector<Column> columns(const DiscreteElement&, Spheres spheres) {
  const bool equal = spheres == Spheres::equal;
  const std::string energy = equal ? "m g d per sphere" : "mean m g d per sphere";
  const std::string overlap = equal ? "diameter" : "diameter of the smaller sphere",
                    source = "jostle";
  return {
      {.name = DiscreteElement::work_column,
       .units = "s",
       .long_name = "time of the tap, its rest included",
       .source = source,
       .shown = Shown::mean,
       .decimals = 3},
      {.name = "kinetic_energy",
       .units = energy,
       .long_name = "kinetic energy a sphere when the tap ended, spin included",
       .source = "Rosato et al. 2010, sec. III",
       .shown = Shown::mean,
       .decimals = 7},
      {.name = "elastic_energy",
       .units = energy,
       .long_name = "elastic energy a sphere, stored in contacts when the tap ended",
       .source = source,
       .shown = Shown::stored},
      {.name = "input_energy",
       .units = energy,
       .long_name = "work of the floor, and of a displacement, in the tap",
       .source = source,
       .shown = Shown::stored},
      {.name = "latched_energy",
       .units = energy,
       .long_name = "energy dissipated normally in the tap: latched by springs, or in dashpots",
       .source = source,
       .shown = Shown::stored},
      {.name = "friction_energy",
       .units = energy,
       .long_name = "energy dissipated by friction in the tap",
       .source = source,
       .shown = Shown::stored},
      {.name = "ledger_error",
       .units = "1",
       .long_name = "energy that the ledger of the tap misses / energy dissipated in it",
       .source = source,
       .shown = Shown::stored},
      {.name = "greatest_overlap",
       .units = overlap,
       .long_name = "greatest overlap in the tap",
       .source = source,
       .shown = Shown::mean},
      {.name = "mean_overlap",
       .units = overlap,
       .long_name = "mean overlap of spheres that press on each other when the tap ended",
       .source = source,
       .shown = Shown::stored},
      {.name = "contacts",
       .units = "1",
       .long_name = "contacts with force a sphere when the tap ended, those with floor and "
                    "sides included",
       .source = source,
       .shown = Shown::mean},
      {.name = "sliding",
       .units = "1",
       .long_name = "share of the contacts between two spheres, floor and sides left out, whose "
                    "tangential force is mu N when the tap ended",
       .source = source,
       .shown = Shown::mean},
      {.name = "capped",
       .units = "1",
       .long_name = "1 where the cap on seconds ended the tap",
       .source = source,
       .shown = Shown::count,
       .if_any = "{} taps ended at the cap on seconds, not at rest: raise most_seconds",
       .if_none = "no tap ended at the cap on seconds"},
      dropped_offsets_column()};
}

}  // namespace jostle::inline engine
