#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "engine/fields.hpp"

// The excitation of one tap. Strengths are dimensionless or in diameters.
namespace jostle::inline engine {

/// The strength of a dilation.
inline constexpr Strength dilation_strength{closed_range(0, 10), "", true};

/// z -> z (1 + epsilon). Philippe & Bideau 2001, sec. II.
struct Dilate {
  double epsilon = 0.02;
  bool operator==(const Dilate&) const = default;

  static constexpr Description description{
      .name = "dilate", .text = "epsilon: z -> z (1 + epsilon)", .symbol = "ε"};
  template <class Self = Dilate>
  static constexpr auto fields() {
    return std::tuple{field("", &Self::epsilon, dilation_strength, "", {.examples = "[0.02]"})};
  }
};

/// (z - 1/2) -> (z - 1/2)(1 + delta): a sphere on the floor stays. Rosato et al. 2010, fig. 2. In a
/// mixture the smallest radius takes the place of 1/2, so that no pair comes to overlap: only the
/// smallest spheres on the floor stay.
struct DilateFloorHeld {
  double delta = 0.025;
  bool operator==(const DilateFloorHeld&) const = default;

  static constexpr Description description{
      .name = "dilate_floor_held",
      .text =
          "Delta: (z - r) -> (z - r)(1 + Delta), r being the smallest radius (1/2 for equal "
          "spheres); spheres of this radius on the floor keep their height",
      .symbol = "Δ"};
  template <class Self = DilateFloorHeld>
  static constexpr auto fields() {
    return std::tuple{field("", &Self::delta, dilation_strength, "", {.examples = "[0.025]"})};
  }
};

/// z -> z + gamma. Rosato et al. 2010, sec. II.
struct Lift {
  double gamma = 0.25;
  bool operator==(const Lift&) const = default;

  static constexpr Description description{
      .name = "lift", .text = "gamma: z -> z + gamma, diameters", .symbol = "γ"};
  template <class Self = Lift>
  static constexpr auto fields() {
    return std::tuple{field("", &Self::gamma, Strength{closed_range(0, 100), "diameters"}, "",
                            {.examples = "[0.25]"})};
  }
};

/// z -> z (1 + lambda), then each centre, in random order, is offset laterally by a vector uniform
/// in a disc of the given radius; an offset that would overlap is drawn again up to `retries`
/// times, then dropped. After Barker & Mehta, as quoted by Rosato et al. 2010, sec. II.
struct Shake {
  double lambda = 0.02;
  double lateral_radius = 0.05;
  std::uint32_t retries = 10;
  bool operator==(const Shake&) const = default;

  static constexpr Description description{
      "shake", "z -> z (1 + lambda), then random lateral offsets that never overlap"};
  template <class Self = Shake>
  static constexpr auto fields() {
    return std::tuple{
        field("lambda", &Self::lambda, dilation_strength, "Relative dilation before the offsets"),
        field("lateral_radius", &Self::lateral_radius, Number{closed_range(0, 1), "diameters"},
              "Radius of the disc of the lateral offsets"),
        field("retries", &Self::retries, Whole{0, 1000},
              "Number of times that an offset that would overlap is drawn again before it is "
              "dropped")};
  }
};

/// The strength of a floor's motion a sin(2 pi f t): its amplitude a, in diameters, or its
/// acceleration Gamma = a (2 pi f)^2 / g.
enum class FloorStrength : std::uint32_t { amplitude, acceleration };
inline constexpr NameTable<FloorStrength, 2> floor_strengths{
    {{"amplitude", FloorStrength::amplitude}, {"acceleration", FloorStrength::acceleration}}};

/// The fields that all taps share which move the floor.
template <class Tap>
constexpr auto floor_fields() {
  return std::tuple{keyed_number<Tap, FloorStrength, 2>(
                        &Tap::strength, &Tap::kind, floor_strengths,
                        {Number{closed_range(0, 100), "diameters"}, Number{closed_range(0, 100)}},
                        {"a", "Gamma = a (2 pi f)^2 / g, in place of the amplitude"}),
                    field("frequency", &Tap::frequency, Number{closed_range(1e-3, 1e6), "Hz"})};
}

/// The floor rises and falls as a sin(2 pi f t) for half a period, then rests: Rosato et al. 2010,
/// sec. III. Discrete elements only.
struct HalfSine {
  double strength = 0.4413;
  double frequency = 7.5;  // f, Hz
  FloorStrength kind = FloorStrength::amplitude;
  bool operator==(const HalfSine&) const = default;

  static constexpr Description description{
      "half_sine",
      "The floor moves as a sin(2 pi f t) for half a period: amplitude a in diameters, frequency f "
      "in Hz. Discrete elements"};
  static constexpr auto fields() { return floor_fields<HalfSine>(); }
};

/// Whole periods of a vibration, at most.
inline constexpr std::uint64_t most_cycles = 1'000'000;

/// The floor vibrates as a sin(2 pi f t) for whole periods: Rosato et al. 2010, fig. 15. Discrete
/// elements only.
struct Vibration {
  double strength = 0.1;
  double frequency = 30;  // f, Hz
  std::uint64_t cycles = 10;
  FloorStrength kind = FloorStrength::amplitude;
  bool operator==(const Vibration&) const = default;

  static constexpr Description description{
      "vibration", "The floor moves as a sin(2 pi f t) for whole periods. Discrete elements"};
  template <class Self = Vibration>
  static constexpr auto fields() {
    return std::tuple_cat(
        floor_fields<Vibration>(),
        std::tuple{field("cycles", &Self::cycles, Whole{1, most_cycles}, "Whole periods")});
  }
};

using Tap = std::variant<Dilate, DilateFloorHeld, Lift, Shake, HalfSine, Vibration>;

/// A tap that moves the floor, not the spheres.
template <class T>
concept FloorTap = requires(const T& tap) {
  tap.frequency;
  tap.kind;
};

/// The amplitude of the floor, diameters, where `gravity` is in diameters / s^2.
double floor_amplitude(const FloorTap auto& tap, double gravity) {
  if (tap.kind == FloorStrength::amplitude) return tap.strength;
  const double angular = 2 * std::numbers::pi * tap.frequency;
  return tap.strength * gravity / (angular * angular);
}

/// Taps of a protocol, at most.
inline constexpr std::uint64_t most_taps = 1'000'000'000;

/// Name of the strength of a tap in scenes and ramps: epsilon, delta, gamma, lambda, a
/// or Gamma.
double& strength(Tap& tap);

/// Control parameter against which a tap's strength is plotted: eps^(1/2) of dilations (Philippe &
/// Bideau 2001), gamma of a lift (Rosato et al. 2010), lambda of a shake, a or Gamma of a floor
/// that moves.
struct Control {
  std::string name;  // "sqrt_epsilon"
  std::string units;
  double value = 0;
};
Control control(const Tap& tap);

/// The name of a control parameter and its symbol on axes.
struct ControlSymbol {
  std::string_view name, symbol;
};
/// Those of all control parameters: figures find the swept one in a table by its name here.
std::span<const ControlSymbol> control_symbols();
/// The symbol in print of the strength of the tap of that name; empty where it has none.
std::string_view tap_symbol(std::string_view name);
/// The names of the taps that displace spheres, which every engine follows.
std::vector<std::string_view> displacing_taps();

/// Why a bed in the container cannot be tapped so; nothing if it can. Without gravity a tap only
/// relaxes: a dilation or a lift of strength zero.
std::optional<std::string> tap_fault(const Tap& tap, const Container& container);

/// True if the tap moves the floor, not the spheres: what excite() cannot do.
bool moves_floor(const Tap& tap);

/// Effects of a tap beyond moving the spheres.
struct TapReport {
  std::uint64_t lateral_offsets_dropped =
      0;  // lateral offsets dropped of n_spheres; only a shake drops any
};

/// Applies the tap to every centre. Only Shake draws from `random`. Throws std::invalid_argument
/// for a tap that moves the floor.
TapReport excite(Packing& packing, const Tap& tap, RandomStream& random);

}  // namespace jostle::inline engine
