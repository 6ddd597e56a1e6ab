#include "structure/layers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace jostle {

namespace {

const double spacing = std::sqrt(2.0 / 3);

// Where centres can be.
double reachable_area(const Container& container) {
  if (std::holds_alternative<WalledBox>(container)) {
    return (width_x(container) - 1) * (width_y(container) - 1);
  }
  if (const auto* tube = std::get_if<Cylinder>(&container)) {
    const double reach = 0.5 * tube->diameter - sphere_radius;
    return std::numbers::pi * reach * reach;
  }
  return footprint_area(container);
}

// Spheres of a full layer: at least one, as in a tube no wider than a sphere.
double full_layer(const Container& container) {
  return std::max(1.0, reachable_area(container) * 2 / std::numbers::sqrt3);
}

}  // namespace

double hcp_layer_height(std::size_t k) {
  return sphere_radius + static_cast<double>(k) * spacing;
}

std::vector<Layer> layers(const Packing& packing, double tolerance) {
  if (!has_gravity(packing.container)) {
    throw std::invalid_argument(
        "layers: a fully periodic box has no floor for layers to grow from; take another "
        "container");
  }
  const auto layer_of = [](double z) {
    return static_cast<std::size_t>(std::max(0.0, (z - sphere_radius) / spacing + 0.5));
  };
  if (packing.centres.empty()) return {};
  std::vector<Layer> all(layer_of(top_height(packing)) + 1);
  std::vector<std::size_t> numbers(all.size(), 0), near(all.size(), 0);
  for (const Vec3& centre : packing.centres) {
    const std::size_t k = layer_of(centre.z);
    ++numbers[k];
    if (std::abs(centre.z - hcp_layer_height(k)) <= tolerance) ++near[k];
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto number = static_cast<double>(numbers[k]);
    all[k] = {hcp_layer_height(k), number / full_layer(packing.container),
              numbers[k] > 0 ? static_cast<double>(near[k]) / number : 0};
  }
  return all;
}

std::size_t grown_layers(const Packing& packing, const LayerRule& rule) {
  const std::vector<Layer> all = layers(packing, rule.tolerance);
  const auto refused = [&](const Layer& layer) {
    return layer.share < rule.least_share || layer.filling < rule.least_filling;
  };
  return static_cast<std::size_t>(std::ranges::find_if(all, refused) - all.begin());
}

}  // namespace jostle
