#include "engine/engines.hpp"

namespace jostle::inline engine {

std::vector<Column> columns(const EngineSettings& settings) {
  return std::visit([](const auto& engine) { return columns(engine); }, settings);
}

std::unique_ptr<Dynamics> make_dynamics(const EngineSettings& settings,
                                        const DynamicsStreams& streams) {
  return std::visit([&](const auto& engine) { return make_dynamics(engine, streams); }, settings);
}

}  // namespace jostle::inline engine
