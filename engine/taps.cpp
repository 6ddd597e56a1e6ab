#include "engine/taps.hpp"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/cells/sized_grid.hpp"

namespace jostle::inline engine {

namespace {

// A vector uniform in the disc, by rejection from the square.
Vec3 random_in_disc(double radius, RandomStream& random) {
  for (;;) {
    const double x = 2 * random.uniform() - 1;
    const double y = 2 * random.uniform() - 1;
    if (x * x + y * y <= 1) return {radius * x, radius * y, 0};
  }
}

// The numbers 0 .. n - 1 in random order, every order alike (Fisher & Yates).
std::vector<std::uint32_t> random_order(std::size_t n, RandomStream& random) {
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t left = n; left > 1; --left) {
    std::swap(order[left - 1], order[random.integer_below(left)]);
  }
  return order;
}

// Lateral offsets, one sphere after another; each uses the positions at that time.
class LateralOffsets {
 public:
  LateralOffsets(Packing& packing, const Shake& shake)
      : packing_(packing), boundary_(packing.container), shake_(shake) {
    // Both spheres of a pair may have gone up to one radius of the disc since the grid was built.
    grid_.build(
        boundary_, 2 * shake.lateral_radius, static_cast<std::uint32_t>(packing.centres.size()),
        [&](std::uint32_t i) { return packing.centres[i]; },
        [&](std::uint32_t i) { return packing.radius(i); });
    origins_ = packing.centres;
  }

  std::uint64_t operator()(RandomStream& random) const {
    std::uint64_t dropped = 0;
    for (const std::uint32_t i : random_order(packing_.centres.size(), random)) {
      dropped += !offset(i, random);
    }
    return dropped;
  }

 private:
  bool offset(std::uint32_t i, RandomStream& random) const {
    for (std::uint32_t attempt = 0; attempt <= shake_.retries; ++attempt) {
      const Vec3 offset = random_in_disc(shake_.lateral_radius, random);
      const Vec3 target = wrapped(boundary_, packing_.centres[i] + offset);
      if (is_free(i, target)) {
        packing_.centres[i] = target;
        return true;
      }
    }
    return false;
  }

  /// Grains at rest press into each other and into the boundaries: an offset may keep such an
  /// overlap, and make none deeper. Spheres of Monte Carlo have none.
  bool is_free(std::uint32_t i, Vec3 target) const {
    if (!is_in_container(i, target)) return false;
    const double radius = packing_.radius(i);
    const Vec3 present = packing_.centres[i];
    bool free = true;
    grid_.for_each_near(origins_[i], radius, [&](std::uint32_t j) {
      if (j == i) return;
      const Vec3 neighbour = packing_.centres[j];
      const double touching = radius + packing_.radius(j);
      if (!overlaps(boundary_, target, neighbour, touching)) return;
      const bool keeps_overlap = overlaps(boundary_, present, neighbour, touching) &&
                                 norm_squared(separation(boundary_, target, neighbour)) >=
                                     norm_squared(separation(boundary_, present, neighbour));
      free = free && keeps_overlap;
    });
    return free;
  }

  bool is_in_container(std::uint32_t i, Vec3 target) const {
    const double radius = packing_.radius(i);
    if (clear_of_boundaries(boundary_, target, radius)) return true;
    const Vec3 present = packing_.centres[i];
    return !clear_of_boundaries(boundary_, present, radius) &&
           boundary_depth(boundary_, target) <= boundary_depth(boundary_, present);
  }

  Packing& packing_;
  Boundary boundary_;
  const Shake& shake_;
  SizedGrid grid_;
  std::vector<Vec3> origins_;
};

struct Excite {
  Packing& packing;
  RandomStream& random;

  TapReport operator()(const Dilate& tap) const {
    for (Vec3& centre : packing.centres) centre.z = centre.z * (1 + tap.epsilon);
    return {};
  }
  TapReport operator()(const DilateFloorHeld& tap) const {
    // z + (z - r) delta, so that a sphere on the floor keeps its height to the bit. In a mixture r
    // is the smallest radius for all: with each sphere's own, touching pairs would overlap.
    const double held = packing.smallest_radius();
    for (Vec3& centre : packing.centres) centre.z += (centre.z - held) * tap.delta;
    return {};
  }
  TapReport operator()(const Lift& tap) const {
    for (Vec3& centre : packing.centres) centre.z += tap.gamma;
    return {};
  }
  TapReport operator()(const Shake& tap) const {
    for (Vec3& centre : packing.centres) centre.z = centre.z * (1 + tap.lambda);
    return {LateralOffsets(packing, tap)(random)};
  }
  TapReport operator()(const FloorTap auto&) const {
    throw std::invalid_argument("only discrete elements follow a floor that moves");
  }
};

struct StrengthOf {
  double& operator()(Dilate& tap) const { return tap.epsilon; }
  double& operator()(DilateFloorHeld& tap) const { return tap.delta; }
  double& operator()(Lift& tap) const { return tap.gamma; }
  double& operator()(Shake& tap) const { return tap.lambda; }
  double& operator()(HalfSine& tap) const { return tap.strength; }
  double& operator()(Vibration& tap) const { return tap.strength; }
};

struct ControlOf {
  Control operator()(const Dilate& tap) const {
    return {"sqrt_epsilon", "1", std::sqrt(tap.epsilon)};
  }
  Control operator()(const DilateFloorHeld& tap) const {
    return {"sqrt_delta", "1", std::sqrt(tap.delta)};
  }
  Control operator()(const Lift& tap) const { return {"gamma", "diameter", tap.gamma}; }
  Control operator()(const Shake& tap) const { return {"lambda", "1", tap.lambda}; }
  Control operator()(const FloorTap auto& tap) const {
    if (tap.kind == FloorStrength::acceleration) return {"Gamma", "1", tap.strength};
    return {"amplitude", "diameter", tap.strength};
  }
};

constexpr ControlSymbol symbols_of_controls[] = {
    {"sqrt_epsilon", "√ε"}, {"epsilon", "ε"}, {"sqrt_delta", "√δ"}, {"gamma", "γ"},
    {"lambda", "λ"},        {"Gamma", "Γ"},   {"amplitude", "A"}};

/// Calls act.operator()<T>() for every tap.
template <class Act, std::size_t... k>
void for_each_tap(const Act& act, std::index_sequence<k...>) {
  (act.template operator()<std::variant_alternative_t<k, Tap>>(), ...);
}
template <class Act>
void for_each_tap(const Act& act) {
  for_each_tap(act, std::make_index_sequence<std::variant_size_v<Tap>>());
}

}  // namespace

double& strength(Tap& tap) {
  return std::visit(StrengthOf{}, tap);
}

Control control(const Tap& tap) {
  return std::visit(ControlOf{}, tap);
}

std::span<const ControlSymbol> control_symbols() {
  return symbols_of_controls;
}

std::string_view tap_symbol(std::string_view name) {
  std::string_view symbol;
  for_each_tap([&]<class T>() {
    if (T::description.name == name) symbol = T::description.symbol;
  });
  return symbol;
}

std::vector<std::string_view> displacing_taps() {
  std::vector<std::string_view> names;
  for_each_tap([&]<class T>() {
    if (!FloorTap<T>) names.push_back(T::description.name);
  });
  return names;
}

std::optional<std::string> tap_fault(const Tap& tap, const Container& container) {
  const bool idle = tap == Tap{Dilate{0}} || tap == Tap{Lift{0}};
  if (has_gravity(container) || idle) return std::nullopt;
  return "a tap has no meaning without gravity (fully_periodic): a dilate of 0 only relaxes";
}

bool moves_floor(const Tap& tap) {
  return std::visit([]<class T>(const T&) { return FloorTap<T>; }, tap);
}

TapReport excite(Packing& packing, const Tap& tap, RandomStream& random) {
  return std::visit(Excite{packing, random}, tap);
}

}  // namespace jostle::inline engine
