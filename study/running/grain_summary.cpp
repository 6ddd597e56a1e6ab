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

constexpr double largest_overlap = 0.2;  // at which a realization fails

/// The sphere that overlaps most in the first realization: `deepest` of sizes, and contact times.
struct Spheres {
  std::shared_ptr<const Sizes> sizes;
  ContactTimes times;
  double deepest;
};
Spheres spheres_of(const Plan& plan, const DiscreteElement& engine) {
  std::shared_ptr<const Sizes> sizes = sizes_of(plan, 0);
  const ContactTimes times =
      contact_times(engine, sizes ? lightest_masses(sizes->masses()) : LightestMasses{});
  const double deepest = sizes ? deepest_of(*sizes) : 1;
  return {std::move(sizes), times, deepest};
}

/// Gamma, speed and overlap of a tap that moves the floor; none for other taps and stages without.
struct FloorTap {
  Floor floor;
  double gamma, speed, overlap;  // m/s; of two spheres that meet at this speed, diameters
};
std::optional<FloorTap> floor_tap(const Stage& stage, const DiscreteElement& engine,
                                  const Spheres& spheres) {
  const auto floor = std::visit(FloorOf{engine.gravity / engine.diameter}, stage.tap);
  if (!floor || stage.count == 0) return std::nullopt;
  const double stiffness =
      std::visit([](const auto& law) { return law.stiffness; }, engine.spheres);
  const double omega = 2 * std::numbers::pi * floor->frequency;
  const double speed = floor->amplitude * engine.diameter * omega;
  return FloorTap{
      *floor, speed * omega / engine.gravity, speed,
      spheres.deepest * speed * std::sqrt(spheres.times.mass / (2 * stiffness)) / engine.diameter};
}

const char* overlap_unit(const Spheres& spheres) {
  return spheres.sizes ? "of their diameter" : "d";
}

}  // namespace

std::vector<std::string> overlap_warnings(const Plan& plan) {
  const auto* engine = std::get_if<DiscreteElement>(&plan.engine);
  if (engine == nullptr) return {};
  const Spheres spheres = spheres_of(plan, *engine);
  std::vector<std::string> warnings;
  for (const Stage& stage : plan.protocol) {
    const auto tap = floor_tap(stage, *engine, spheres);
    if (!tap || in_beds * tap->overlap < largest_overlap) continue;
    const std::string warning = finite_text(
        "/protocol: a floor of amplitude {:.4g} d and frequency {:.4g} Hz makes spheres overlap by "
        "up to some {:.2g} {}, and beds fail at {:g}: raise the stiffness",
        tap->floor.amplitude, tap->floor.frequency, in_beds * tap->overlap, overlap_unit(spheres),
        largest_overlap);
    if (std::ranges::find(warnings, warning) == warnings.end()) warnings.push_back(warning);
  }
  return warnings;
}

std::vector<std::string> grain_summary(const Plan& plan) {
  const auto* engine = std::get_if<DiscreteElement>(&plan.engine);
  if (engine == nullptr) return {};
  const Spheres spheres = spheres_of(plan, *engine);
  const ContactTimes& times = spheres.times;
  std::vector<std::string> lines{finite_text("contact time {:.3g} s, time step {:.3g} s",
                                             times.contact_seconds, times.step_seconds)};
  std::set<std::string> known;
  for (const Stage& stage : plan.protocol) {
    const auto tap = floor_tap(stage, *engine, spheres);
    if (!tap) continue;
    const std::string line = finite_text(
        "a = {:.4g} d, f = {:.4g} Hz: Gamma {:.3f}, floor speed {:.3g} m/s, overlap {:.2g} "
        "{} where two {}spheres meet at it and up to some {:.2g} in beds, "
        "{:.0f} steps while the floor moves",
        tap->floor.amplitude, tap->floor.frequency, tap->gamma, tap->speed, tap->overlap,
        overlap_unit(spheres), spheres.sizes ? "like " : "", in_beds * tap->overlap,
        tap->floor.seconds / times.step_seconds);
    if (known.insert(line).second && known.size() <= 5) lines.push_back(line);
  }
  if (known.size() > 5) lines.push_back(fmt::format("... and {} more taps", known.size() - 5));
  return lines;
}

}  // namespace jostle::inline study
