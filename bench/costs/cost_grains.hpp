#pragma once

#include "engine/bed/packing.hpp"
#include "engine/discrete_element/reduced.hpp"

namespace jostle::bench {

/// A tap of as many steps as are asked for.
inline DiscreteElement counted_grains(double friction) {
  DiscreteElement settings;
  settings.spheres = WaltonBraun{.friction = friction};
  settings.rest = TimedRest{1e6};
  settings.most_seconds = 1e7;
  return settings;
}

/// 8 x 8 x 16 grains straight upon each other, pressed by the weight of those above: the bed is at
/// rest as it is. In a footprint 8 diameters wide neighbours in a layer just touch.
inline Packing stacked_grains(const Container& container) {
  const double stiffness = reduced(counted_grains(0)).spheres.stiffness;
  Packing bed{container, {}};
  double height = 0.5;
  for (int k = 0; k < 16; ++k) {
    height += (k > 0 ? 1 : 0) - (16 - k) / stiffness;
    for (int j = 0; j < 8; ++j)
      for (int i = 0; i < 8; ++i) bed.centres.push_back({i + 0.5, j + 0.5, height});
  }
  return bed;
}

}  // namespace jostle::bench
