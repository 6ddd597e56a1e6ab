#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "engine/bed/elementary.hpp"

namespace jostle::inline engine {

/// The floor's height while it moves as a sin(2 pi f t), for a number of half periods. Diameters;
/// times in sqrt(diameter / gravity).
struct FloorMotion {
  double amplitude = 0;
  double frequency = 1;
  std::uint64_t half_periods = 0;

  double duration() const { return 0.5 * static_cast<double>(half_periods) / frequency; }

  struct Place {
    double height = 0, velocity = 0;
  };
  Place place_at(double time) const {
    if (!(time < duration())) return {};
    using std::numbers::pi;
    const double turns = frequency * time;
    const double quarter =
        0.5 * pi * (turns - std::floor(turns) - 0.5);  // quarter of the angle, less pi
    const SineCosine angle = doubled(doubled(sine_cosine(quarter)));
    return {-amplitude * angle.sine, -amplitude * 2 * pi * frequency * angle.cosine};
  }
};

}  // namespace jostle::inline engine
