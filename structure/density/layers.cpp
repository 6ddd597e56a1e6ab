#include "structure/density/layers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

#include "engine/bed/boundary.hpp"

namespace jostle::inline structure {

namespace {

const double spacing = std::sqrt(2.0 / 3);

// Where centres can be.
double reachable_area(const Container& container) {
  const Boundary boundary(container);
  if (boundary.sides == Sides::cylinder) {
    const double reach = boundary.axis() - sphere_radius;
    return std::numbers::pi * reach * reach;
  }
  const double margin = boundary.side_margin();
  return (boundary.width_x - 2 * margin) * (boundary.width_y - 2 * margin);
}

// Spheres of a full layer: at least one, as in a tube no wider than a sphere.
double full_layer(const Container& container) {
  return std::max(1.0, reachable_area(container) * 2 / std::numbers::sqrt3);
}

// Of ascending heights those in [low, high).
std::span<const double> between(const std::vector<double>& heights, double low, double high) {
  const auto first = std::ranges::lower_bound(heights, low);
  const auto last = std::ranges::lower_bound(heights, high);
  return {first, std::max(first, last)};
}

// The mean of the heights around a place, and once more around that mean; the place itself where
// there are none.
double height_near(const std::vector<double>& heights, double place) {
  constexpr double reach = 0.3;
  for (int turn = 0; turn < 2; ++turn) {
    const std::span<const double> near = between(heights, place - reach, place + reach);
    if (near.empty()) return place;
    double sum = 0;
    for (const double height : near) sum += height - place;
    place += sum / static_cast<double>(near.size());
  }
  return place;
}

}  // namespace

double hcp_layer_height(std::size_t k) {
  return sphere_radius + static_cast<double>(k) * spacing;
}

std::vector<Layer> layers(const Packing& packing, double tolerance) {
  if (!Boundary(packing.container).floor) {
    throw std::invalid_argument(
        "layers: a fully periodic box has no floor for layers to grow from; take another "
        "container");
  }
  std::vector<double> heights;
  for (const Vec3& centre : packing.centres) heights.push_back(centre.z);
  std::ranges::sort(heights);
  std::vector<Layer> all;
  if (heights.empty()) return all;
  double expected = sphere_radius;
  do {
    all.push_back(
        {.height = hcp_layer_height(all.size()), .found = height_near(heights, expected)});
    expected = all.back().found + spacing;
  } while (expected - 0.5 * spacing <= heights.back());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double low = k == 0 ? 0 : 0.5 * (all[k - 1].found + all[k].found);
    const double high =
        k + 1 < all.size() ? 0.5 * (all[k].found + all[k + 1].found) : heights.back() + spacing;
    const auto number = static_cast<double>(between(heights, low, high).size());
    const auto near =
        static_cast<double>(between(heights, std::max(low, all[k].found - tolerance),
                                    std::min(high, std::nextafter(all[k].found + tolerance, high)))
                                .size());
    all[k].filling = number / full_layer(packing.container);
    all[k].share = number > 0 ? near / number : 0;
  }
  return all;
}

std::size_t grown_layers(const Packing& packing, const LayerRule& rule) {
  const std::vector<Layer> all = layers(packing, rule.tolerance);
  std::size_t grown = 0;
  for (double expected = sphere_radius; grown < all.size(); ++grown) {
    const Layer& layer = all[grown];
    if (std::abs(layer.found - expected) > rule.tolerance || layer.share < rule.least_share ||
        layer.filling < rule.least_filling) {
      break;
    }
    expected = layer.found + spacing;
  }
  return grown;
}

}  // namespace jostle::inline structure
