#include "engine/engines.hpp"

namespace jostle::inline engine {

std::vector<Column> columns(const EngineSettings& settings) {
  return std::visit([](const auto& engine) { return columns(engine); }, settings);
}

std::optional<std::string> engine_tap_fault(const EngineSettings& settings, const Tap& tap) {
  if (std::holds_alternative<DiscreteElement>(settings) || !moves_floor(tap)) return std::nullopt;
  return "the floor moves under discrete elements only: set \"engine\" to "
         "{\"discrete_element\": {}}, or tap by dilate, dilate_floor_held, lift or shake";
}

const char* unit_name(const EngineSettings& settings) {
  return std::holds_alternative<MonteCarlo>(settings) ? "trials" : "sphere steps";
}

const char* round_name(const EngineSettings& settings) {
  return std::holds_alternative<MonteCarlo>(settings) ? "sweeps" : "time steps";
}

std::unique_ptr<Dynamics> make_dynamics(const EngineSettings& settings,
                                        const DynamicsStreams& streams) {
  return std::visit([&](const auto& engine) { return make_dynamics(engine, streams); }, settings);
}

}  // namespace jostle::inline engine
