#pragma once

#include <cmath>
#include <string>

#include "engine/bed/geometry.hpp"
#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"

namespace jostle {

/// Triangular layers of 12 x 12 touching spheres with periodic sides, one on another from the
/// floor: each letter of `stacking` is a layer's place, A, B or C.
inline Packing stacked_layers(const std::string& stacking) {
  constexpr int n = 12;
  const double rise = std::sqrt(2.0 / 3), row = std::sqrt(0.75);
  const PeriodicBox box{n, n * row};
  Packing packing{box, {}};
  for (std::size_t layer = 0; layer < stacking.size(); ++layer) {
    const int place = stacking[layer] - 'A';
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        // Each place is a third of the way up the long diagonal of the two triangles of a cell.
        const double x = i + 0.5 * (j % 2) + 0.5 * place, y = row * (j + place / 3.0);
        packing.centres.push_back(
            wrapped(box, {x, y, sphere_radius + rise * static_cast<double>(layer)}));
      }
    }
  }
  return packing;
}

/// Every coordinate displaced by up to `amplitude`, and brought into the box again.
inline Packing shaken(Packing packing, double amplitude, std::uint64_t seed = 63) {
  RandomStream random(stream_key(seed, 0, 0, Purpose::start));
  const auto shift = [&] { return amplitude * (2 * random.uniform() - 1); };
  for (Vec3& r : packing.centres) {
    const Vec3 moved{r.x + shift(), r.y + shift(), r.z + shift()};
    r = std::visit([&](const auto& box) { return wrapped(box, moved); }, packing.container);
  }
  return packing;
}

}  // namespace jostle
