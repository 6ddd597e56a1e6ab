#include "engine/engines.hpp"

namespace jostle::inline engine {

namespace {

std::optional<std::string> motion_fault(const DiscreteElement& grains, const FloorTap auto& tap,
                                        const LightestMasses& lightest) {
  constexpr double largest_amplitude = 100;
  const double amplitude = floor_amplitude(tap, grains.gravity / grains.diameter);
  if (amplitude > largest_amplitude)
    return "at this acceleration and frequency the floor moves by " + std::to_string(amplitude) +
           " diameters, " + std::to_string(static_cast<int>(largest_amplitude)) +
           " at most: raise the frequency, or lower the acceleration";
  if (grains.spheres.index() != grains.floor.value_or(grains.spheres).index() ||
      grains.spheres.index() != grains.sides.value_or(grains.spheres).index())
    return std::nullopt;  // a fault of its own
  const double steps = 0.5 / tap.frequency / contact_times(grains, lightest).step_seconds;
  if (steps >= least_steps_per_half_period) return std::nullopt;
  return "half a period of the floor takes " + std::to_string(steps) + " time steps, " +
         std::to_string(static_cast<int>(least_steps_per_half_period)) +
         " at least: lower the frequency, or raise stiffness or steps_per_contact";
}

}  // namespace

std::vector<Column> columns(const EngineSettings& settings, Spheres spheres) {
  return std::visit([&](const auto& engine) { return columns(engine, spheres); }, settings);
}

std::optional<std::string> engine_tap_fault(const EngineSettings& settings, const Tap& tap,
                                            const LightestMasses& lightest) {
  if (!moves_floor(tap)) return std::nullopt;
  if (const auto* grains = std::get_if<DiscreteElement>(&settings)) {
    return std::visit(
        [&]<class T>(const T& motion) -> std::optional<std::string> {
          if constexpr (FloorTap<T>) return motion_fault(*grains, motion, lightest);
          return std::nullopt;
        },
        tap);
  }
  std::string taps;
  const std::vector<std::string_view> names = displacing_taps();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k > 0) taps += k + 1 < names.size() ? ", " : " or ";
    taps += names[k];
  }
  return "the floor moves under discrete elements only: set \"engine\" to "
         "{\"discrete_element\": {}}, or tap by " +
         taps;
}

std::optional<std::string> engine_start_fault(const EngineSettings& settings, const Start& start) {
  const auto* given = std::get_if<GivenPacking>(&start);
  if (given == nullptr || given->most_overlap == 0 ||
      std::holds_alternative<DiscreteElement>(settings))
    return std::nullopt;
  return "trials move hard spheres: a packing that overlaps can be given to discrete elements only";
}

const char* unit_name(const EngineSettings& settings) {
  return std::visit([](const auto& engine) { return engine.unit; }, settings);
}

const char* round_name(const EngineSettings& settings) {
  return std::visit([](const auto& engine) { return engine.round; }, settings);
}

const char* work_column(const EngineSettings& settings) {
  return std::visit([](const auto& engine) { return engine.work_column; }, settings);
}

const char* work_name(const EngineSettings& settings) {
  return std::visit([](const auto& engine) { return engine.work; }, settings);
}

std::unique_ptr<Dynamics> make_dynamics(const EngineSettings& settings,
                                        const DynamicsStreams& streams) {
  return std::visit([&](const auto& engine) { return make_dynamics(engine, streams); }, settings);
}

}  // namespace jostle::inline engine
