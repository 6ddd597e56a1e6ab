#include "structure/density/profiles.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

#include "engine/bed/boundary.hpp"
#include "engine/bed/slab.hpp"
#include "structure/density/profile_parts.hpp"
#include "structure/density/sphere_cuts.hpp"

namespace jostle::inline structure {

std::vector<double> even_edges(double low, double high, double width) {
  if (!(width > 0 && low < high)) {
    throw std::invalid_argument("profile: bins need a width above 0 and a range that ascends");
  }
  std::vector<double> edges;
  const auto whole = static_cast<std::size_t>(std::floor((high - low) / width + 1e-9));
  for (std::size_t k = 0; k <= whole; ++k) edges.push_back(low + static_cast<double>(k) * width);
  if (whole > 0 && high - edges.back() < 1e-9 * width) {
    edges.back() = high;
  } else {
    edges.push_back(high);
  }
  return edges;
}

std::vector<double> height_edges(const Packing& packing, double width) {
  const double top = packing.sizes ? surface_height(packing) : top_height(packing) + sphere_radius;
  return even_edges(0, std::max(1.0, std::ceil(top / width)) * width, width);
}

HeightWindow transverse_window(const Packing& packing) {
  require_floor(packing);
  return {4 * sphere_radius, 0.8 * 2 * mean_height(packing)};
}

void require_floor(const Packing& packing) {
  if (!Boundary(packing.container).has_floor()) {
    throw std::invalid_argument(
        "profile: a fully periodic box has no floor, top or walls to measure from; take another "
        "container");
  }
}

void require_window(HeightWindow window) {
  if (!(window.low < window.high)) {
    throw std::invalid_argument("profile: the height window from " + std::to_string(window.low) +
                                " to " + std::to_string(window.high) +
                                " d is empty; the packing may be too low for it");
  }
}

Profile empty_profile(std::span<const double> edges, double low, double high,
                      const std::function<double(double)>& volume_below) {
  constexpr double rounding = 1e-9;
  const auto ascends = [](double a, double b) { return !(a < b); };
  if (edges.size() < 2 || std::ranges::adjacent_find(edges, ascends) != edges.end()) {
    throw std::invalid_argument("profile: the edges of bins must ascend, and be at least two");
  }
  if (edges.front() < low - rounding || edges.back() > high + rounding) {
    throw std::invalid_argument("profile: bins from " + std::to_string(edges.front()) + " to " +
                                std::to_string(edges.back()) + " reach out of the container, " +
                                std::to_string(low) + " to " + std::to_string(high));
  }
  Profile profile{{edges.begin(), edges.end()}, {}, std::vector<double>(edges.size() - 1, 0.0)};
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    profile.volumes.push_back(volume_below(edges[k + 1]) - volume_below(edges[k]));
  }
  return profile;
}

void divide_by_volumes(Profile& profile) {
  for (std::size_t k = 0; k < profile.size(); ++k) profile.values[k] /= profile.volumes[k];
}

Profile vertical_profile(const Packing& packing, std::span<const double> edges) {
  require_floor(packing);
  const double footprint = footprint_area(packing.container);
  Profile profile =
      empty_profile(edges, 0, HUGE_VAL, [&](double height) { return footprint * height; });
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const double z = packing.centres[i].z, diameter = 2 * packing.radius(i);
    const double bottom = z - packing.radius(i);
    share_out(profile, bottom, bottom + diameter, [&](double height) {
      return sphere_volume_in_slab(z, bottom, std::max(bottom, height), diameter);
    });
  }
  divide_by_volumes(profile);
  return profile;
}

std::vector<double> vertical_cuts(const Packing& packing, std::span<const double> heights) {
  require_floor(packing);
  std::vector<double> fractions;
  fractions.reserve(heights.size());
  for (const double height : heights)
    fractions.push_back(solids_fraction(packing, {height, height}));
  return fractions;
}

}  // namespace jostle::inline structure
