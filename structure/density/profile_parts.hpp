#pragma once

#include <algorithm>
#include <functional>

#include "structure/density/profiles.hpp"

// Common parts of the profiles: checked bins, and spheres divided among them.
namespace jostle::inline structure {

/// Throws std::invalid_argument for a fully periodic box.
void require_floor(const Packing& packing);

/// Throws std::invalid_argument for an empty window.
void require_window(HeightWindow window);

/// Bins without solids. `volume_below` gives the volume of the container below an edge. Throws
/// std::invalid_argument for edges that do not ascend, or reach out of [low, high] by more than
/// rounding.
Profile empty_profile(std::span<const double> edges, double low, double high,
                      const std::function<double(double)>& volume_below);

/// Adds a sphere that reaches from `low` to `high` to the solid volumes that `values` hold until
/// they are divided. `volume_below` gives the volume of the sphere below an edge.
template <class VolumeBelow>
void share_out(Profile& profile, double low, double high, VolumeBelow&& volume_below) {
  const auto& edges = profile.edges;
  const auto first = std::ranges::upper_bound(edges, low);
  std::size_t k = first == edges.begin() ? 0 : static_cast<std::size_t>(first - edges.begin()) - 1;
  if (k >= profile.size() || edges[k] >= high) return;
  double volume_before = volume_below(edges[k]);
  for (; k < profile.size() && edges[k] < high; ++k) {
    const double next = volume_below(edges[k + 1]);
    profile.values[k] += next - volume_before;
    volume_before = next;
  }
}

/// Turns solid volumes into packing fractions.
void divide_by_volumes(Profile& profile);

}  // namespace jostle::inline structure
