#pragma once

#include <variant>
#include <vector>

#include "engine/column.hpp"
#include "engine/monte_carlo/monte_carlo.hpp"

// The engines there are. Who runs ensembles knows no engine but through this file.
namespace jostle {

using EngineSettings = std::variant<MonteCarlo>;

/// What the engine records at every tap besides the observables, in order.
std::vector<Column> columns(const EngineSettings& settings);

}  // namespace jostle
