#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/column.hpp"
#include "engine/discrete_element/discrete_element.hpp"
#include "engine/dynamics.hpp"
#include "engine/monte_carlo/monte_carlo.hpp"

// The engines there are. Who runs ensembles knows no engine but through this file.
namespace jostle::inline engine {

using EngineSettings = std::variant<MonteCarlo, DiscreteElement>;

/// Columns of the engine at every tap besides the observables, in order.
std::vector<Column> columns(const EngineSettings& settings, Spheres spheres = Spheres::equal);

/// Why the engine cannot make this tap; nothing if it can. Only discrete elements follow a floor
/// that moves; a displacement both can make.
std::optional<std::string> engine_tap_fault(const EngineSettings& settings, const Tap& tap,
                                            const LightestMasses& lightest = {});

/// Why the engine cannot begin from this start; nothing if it can. Only discrete elements may
/// overlap.
std::optional<std::string> engine_start_fault(const EngineSettings& settings, const Start& start);

/// Names in reports of a unit of the engine, and of one unit per sphere: "trials" and
/// "sweeps", "sphere steps" and "time steps".
const char* unit_name(const EngineSettings& settings);
const char* round_name(const EngineSettings& settings);

/// The column that measures the work of a tap: "sweeps", or "seconds" of simulated time; and its
/// name in reports: "sweeps", "simulated seconds".
const char* work_column(const EngineSettings& settings);
const char* work_name(const EngineSettings& settings);

/// The mechanics of one realization, before anything is loaded.
std::unique_ptr<Dynamics> make_dynamics(const EngineSettings& settings,
                                        const DynamicsStreams& streams);

}  // namespace jostle::inline engine
