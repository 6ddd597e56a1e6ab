#include "study/running/scene_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <variant>

#include "ensemble/statistics/finite_text.hpp"
#include "study/amounts.hpp"
#include "study/running/grain_summary.hpp"

namespace jostle::inline study {
namespace {

// From here on a number is more likely another unit than a choice.
constexpr double largest_angle = 2, largest_degrees = 180;  // theta0 of 1000 means: any direction
constexpr double largest_stretch = 1;                       // twice as high; the papers end at 0.5
constexpr double largest_lift = 5;                          // diameters; the papers' end at 0.5
constexpr double large_diameter = 0.5;                      // m
constexpr double small_density = 20;                        // kg/m^3; 20 g/cm^3 is gold
constexpr double large_gravity = 300;                       // m/s^2; 30 g
constexpr double much_disk = 1e12;                          // bytes
constexpr std::size_t most_warnings = 50;

class Warnings {
 public:
  void look_at(const Plan& plan) {
    std::visit([this](const auto& engine) { look_at_engine(engine); }, plan.engine);
    for (const Stage& stage : plan.protocol) {
      std::visit([this](const auto& tap) { look_at_tap(tap); }, stage.tap);
    }
    for (std::string& warning : overlap_warnings(plan)) add(std::move(warning));
  }
  /// Realizations of a scene without random numbers.
  void look_at_chance(const Plan& plan, std::uint64_t n_realizations) {
    const bool given = std::holds_alternative<Crystal>(plan.start) ||
                       std::holds_alternative<GivenPacking>(plan.start);
    const bool random = !std::holds_alternative<DiscreteElement>(plan.engine) || !given ||
                        has_drawn_sizes(plan) ||
                        std::ranges::any_of(plan.protocol, [](const Stage& stage) {
                          const auto* shake = std::get_if<Shake>(&stage.tap);
                          return shake != nullptr && shake->lateral_radius > 0 && stage.count > 0;
                        });
    if (random || n_realizations < 2) return;
    add(fmt::format(
        "/realizations: nothing is random in this scene: discrete elements that start from a {} "
        "make {} identical realizations, which count as one; 1 realization gives the same "
        "results, a random start gives independent ones",
        std::holds_alternative<Crystal>(plan.start) ? "crystal" : "file", n_realizations));
  }
  void add(std::string text) {
    if (known_.insert(text).second && known_.size() <= most_warnings) {
      texts_.push_back(std::move(text));
    }
  }
  std::vector<std::string> texts() && {
    if (known_.size() > most_warnings) {
      texts_.push_back(fmt::format("... and {} more", known_.size() - most_warnings));
    }
    return std::move(texts_);
  }

 private:
  void look_at_engine(const MonteCarlo& engine) {
    look_at("/relax", engine.relax);
    if (engine.relax_start) look_at("/relax_start", *engine.relax_start);
  }
  void look_at_engine(const DiscreteElement& engine) {
    const double rest =
        std::visit([](const auto& alternative) { return alternative.seconds; }, engine.rest);
    if (rest > engine.most_seconds) {
      add(finite_text(
          "/engine: a bed rests no sooner than after {:g} s, and is capped after {:g} s: "
          "every tap will be",
          rest, engine.most_seconds));
    }
    if (engine.diameter > large_diameter) {
      add(finite_text("/engine: the diameter is in metres, and {:g} m is a boulder",
                      engine.diameter));
    }
    if (engine.density < small_density) {
      add(finite_text(
          "/engine: the density is in kg/m^3, and {:g} is less than that of nearly all solids; "
          "{:g} g/cm^3 are {:g}",
          engine.density, engine.density, 1000 * engine.density));
    }
    if (engine.gravity > large_gravity) {
      add(
          finite_text("/engine: gravity is in m/s^2, and {:g} is {:.0f} times that of the Earth; "
                      "{:g} cm/s^2 are {:g}",
                      engine.gravity, engine.gravity / 9.81, engine.gravity, engine.gravity / 100));
    }
  }
  void look_at(const char* key, const Relaxation& relax) {
    const auto* move = std::get_if<PolarMove>(&relax.move);
    if (move == nullptr || move->theta0 <= largest_angle || move->theta0 > largest_degrees) return;
    add(
        finite_text("{}: theta0 is an angle in radians, and {:g} is more than a right angle; "
                    "{:g} degrees are {:.4f}",
                    key, move->theta0, move->theta0, move->theta0 * std::numbers::pi / 180));
  }
  void look_at_tap(const Dilate& tap) { look_at_stretch("dilate", tap.epsilon); }
  void look_at_tap(const DilateFloorHeld& tap) { look_at_stretch("dilate_floor_held", tap.delta); }
  void look_at_tap(const Shake& tap) { look_at_stretch("shake", tap.lambda); }
  void look_at_tap(const Lift& tap) {
    if (tap.gamma <= largest_lift) return;
    add(finite_text("/protocol: lift {:g} drops the bed from {:g} diameters above the floor",
                    tap.gamma, tap.gamma));
  }
  void look_at_tap(const HalfSine& tap) { look_at_floor("half_sine", tap); }
  void look_at_tap(const Vibration& tap) { look_at_floor("vibration", tap); }
  template <class FloorTap>
  void look_at_floor(const char* name, const FloorTap& tap) {
    if (tap.kind != FloorStrength::amplitude || tap.strength <= largest_lift) return;
    add(finite_text("/protocol: {}: the amplitude is in diameters, and {:g} are many", name,
                    tap.strength));
  }
  void look_at_stretch(const char* name, double strength) {
    if (strength < largest_stretch) return;
    add(
        finite_text("/protocol: {} {:g} stretches the bed to {:g} times its height; {:g} percent "
                    "are {:g}",
                    name, strength, 1 + strength, strength, strength / 100));
  }

  std::set<std::string> known_;
  std::vector<std::string> texts_;  // the first of them
};

}  // namespace

std::vector<std::string> scene_warnings(const LoadedScene& loaded) {
  Warnings warnings;
  for (const Plan& plan : loaded.plans) {
    warnings.look_at(plan);
    warnings.look_at_chance(plan, loaded.scene.realizations);
  }
  const auto disk = static_cast<double>(disk_estimate(study_of(loaded), Shard{}));
  if (disk > much_disk) {
    warnings.add(
        fmt::format("the results may take {} of disk: fewer snapshots, taps or "
                    "realizations take less",
                    format_bytes(disk)));
  }
  return std::move(warnings).texts();
}

}  // namespace jostle::inline study
