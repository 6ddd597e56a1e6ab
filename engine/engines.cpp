#include "engine/engines.hpp"

namespace jostle {

std::vector<Column> columns(const EngineSettings& settings) {
  return std::visit([](const auto& engine) { return columns(engine); }, settings);
}

}  // namespace jostle
