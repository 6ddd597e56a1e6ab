#include "study/running/grain_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <variant>

#include "engine/discrete_element/discrete_element.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline study {
namespace {

/// How the floor moves in a tap.
struct Floor {
  double amplitude = 0, frequency = 1, seconds = 0;
};
struct FloorOf {
  double gravity;  // diameters / s^2

  std::optional<Floor> operator()(const HalfSine& tap) const {
    return Floor{floor_amplitude(tap, gravity), tap.frequency, 0.5 / tap.frequency};
  }
  std::optional<Floor> operator()(const Vibration& tap) const {
    return Floor{floor_amplitude(tap, gravity), tap.frequency,
                 static_cast<double>(tap.cycles) / tap.frequency};
  }
  template <class Displacement>
  std::optional<Floor> operator()(const Displacement&) const {
    return std::nullopt;
  }
};

// Overlaps that beds reach, over that of two spheres at the floor's speed: 2.5 to 3.6 was seen.
constexpr double in_beds = 4;

// The greatest overlap of two like spheres that meet at one speed, in their diameters, over that of
// spheres of diameter 1 and mass 1.
double deepest_of(const Sizes& sizes) {
  double deepest = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i)
    deepest = std::max(deepest, std::sqrt(sizes.mass(i)) / sizes.diameter(i));
  return deepest;
}

}  // namespace

std::vector<std::string> grain_summary(const Plan& plan) {
  const auto* engine = std::get_if<DiscreteElement>(&plan.engine);
  if (engine == nullptr) return {};
  // The first realization, where each draws its own.
  const std::shared_ptr<const Sizes> sizes = sizes_of(plan, 0);
  const ContactTimes times =
      contact_times(*engine, sizes ? lightest_masses(sizes->masses()) : LightestMasses{});
  std::vector<std::string> lines{finite_text("contact time {:.3g} s, time step {:.3g} s",
                                             times.contact_seconds, times.step_seconds)};
  const double deepest = sizes ? deepest_of(*sizes) : 1;
  std::set<std::string> known;
  const double stiffness =
      std::visit([](const auto& law) { return law.stiffness; }, engine->spheres);
  for (const Stage& stage : plan.protocol) {
    const auto floor = std::visit(FloorOf{engine->gravity / engine->diameter}, stage.tap);
    if (!floor || stage.count == 0) continue;
    const double omega = 2 * std::numbers::pi * floor->frequency;
    const double gamma = floor->amplitude * engine->diameter * omega * omega / engine->gravity;
    const double speed = floor->amplitude * engine->diameter * omega;
    const double overlap =
        deepest * speed * std::sqrt(times.mass / (2 * stiffness)) / engine->diameter;
    const std::string line = finite_text(
        "a = {:.4g} d, f = {:.4g} Hz: Gamma {:.3f}, floor speed {:.3g} m/s, overlap {:.2g} "
        "{} where two {}spheres meet at it and up to some {:.2g} in beds, "
        "{:.0f} steps while the floor moves{}",
        floor->amplitude, floor->frequency, gamma, speed, overlap,
        sizes ? "of their diameter" : "d", sizes ? "like " : "", in_beds * overlap,
        floor->seconds / times.step_seconds,
        in_beds * overlap < 0.2 ? "" : "; beds fail at 0.2: raise the stiffness");
    if (known.insert(line).second && known.size() <= 5) lines.push_back(line);
  }
  if (known.size() > 5) lines.push_back(fmt::format("... and {} more taps", known.size() - 5));
  return lines;
}

}  // namespace jostle::inline study
