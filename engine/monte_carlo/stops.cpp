#include "engine/monte_carlo/stops.hpp"

namespace jostle::inline engine {

std::optional<std::string> stop_fault(const StopRule& rule, const Container& container) {
  if (has_gravity(container) || std::holds_alternative<SweepsStop>(rule)) return std::nullopt;
  return "without gravity (fully_periodic) nothing settles: end a relaxation after a number of "
         "\"sweeps\"";
}

std::optional<std::string> cap_fault(const Stop& stop) {
  const auto* fixed = std::get_if<SweepsStop>(&stop.rule);
  if (fixed == nullptr || fixed->sweeps <= stop.max_sweeps) return std::nullopt;
  return std::to_string(fixed->sweeps) + " sweeps are more than the cap max_sweeps of " +
         std::to_string(stop.max_sweeps) + ": every relaxation would end capped";
}

}  // namespace jostle::inline engine
