#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "engine/column.hpp"
#include "engine/dynamics.hpp"
#include "engine/monte_carlo/monte_carlo.hpp"

// The engines there are. Who runs ensembles knows no engine but through this file.
namespace jostle::inline engine {

using EngineSettings = std::variant<MonteCarlo>;

/// What the engine records at every tap besides the observables, in order.
std::vector<Column> columns(const EngineSettings& settings);

/// The mechanics of one realization, before anything is loaded.
std::unique_ptr<Dynamics> make_dynamics(const EngineSettings& settings,
                                        const DynamicsStreams& streams);

}  // namespace jostle::inline engine
