#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"

// The excitation of one tap. Strengths are dimensionless or in diameters.
namespace jostle::inline engine {

/// z -> z (1 + epsilon). Philippe & Bideau 2001, sec. II.
struct Dilate {
  double epsilon = 0.02;
  bool operator==(const Dilate&) const = default;
};

/// (z - 1/2) -> (z - 1/2)(1 + delta): a sphere on the floor stays. Rosato et al. 2010, fig. 2.
struct DilateFloorHeld {
  double delta = 0.025;
  bool operator==(const DilateFloorHeld&) const = default;
};

/// z -> z + gamma. Rosato et al. 2010, sec. II.
struct Lift {
  double gamma = 0.25;
  bool operator==(const Lift&) const = default;
};

/// z -> z (1 + lambda), then each centre, in random order, is offset laterally by a vector uniform
/// in a disc of the given radius; an offset that would overlap is drawn again up to `retries`
/// times, then dropped. After Barker & Mehta, as quoted by Rosato et al. 2010, sec. II.
struct Shake {
  double lambda = 0.02;
  double lateral_radius = 0.05;
  std::uint32_t retries = 10;
  bool operator==(const Shake&) const = default;
};

using Tap = std::variant<Dilate, DilateFloorHeld, Lift, Shake>;

/// Taps of a protocol, at most.
inline constexpr std::uint64_t most_taps = 1'000'000'000;

/// What scenes call the strength of a tap and ramps change: epsilon, delta, gamma, lambda.
double& strength(Tap& tap);

/// What a tap's strength is plotted against: eps^(1/2) of dilations (Philippe & Bideau 2001), gamma
/// of a lift (Rosato et al. 2010), lambda of a shake.
struct Control {
  std::string name;  // "sqrt_epsilon"
  std::string units;
  double value = 0;
};
Control control(const Tap& tap);

/// Why a bed in the container cannot be tapped so; nothing if it can. Without gravity a tap only
/// relaxes: a dilation or a lift of strength zero.
std::optional<std::string> tap_fault(const Tap& tap, const Container& container);

/// What a tap did beyond moving the spheres.
struct TapReport {
  std::uint64_t lateral_offsets_dropped = 0;  // of n_spheres; only a shake drops any
};

/// Applies the tap to every centre. Only Shake draws from `random`.
TapReport excite(Packing& packing, const Tap& tap, RandomStream& random);

}  // namespace jostle::inline engine
