#include "structure/density/layers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

#include "engine/bed/boundary.hpp"

namespace jostle::inline structure {

namespace {

const double spacing = std::sqrt(2.0 / 3);   // spacing of layers
const double row = std::numbers::sqrt3 / 2;  // spacing of the rows of a layer

constexpr double rounding = 1e-9;

// Places a unit apart on a line of some length, the first `first` from its beginning.
double places_on(double length, double first) {
  return std::max(0.0, std::floor(length - first + rounding) + 1);
}

// Places of a close-packed layer on a rectangle, with a row along its side of length
// `longitudinal`.
double places_in_rectangle(double longitudinal, double across) {
  const double rows = std::floor(across / row + rounding) + 1;
  const double shifted = std::floor(rows / 2);
  return (rows - shifted) * places_on(longitudinal, 0) + shifted * places_on(longitudinal, 0.5);
}

// Places of a close-packed layer in a disc whose middle is at (x, y), a place being at (0, 0).
double places_around(double x, double y, double radius) {
  double places = 0;
  const double reach = radius * (1 + rounding);
  const auto first = static_cast<long>(std::ceil((y - reach) / row));
  const auto last = static_cast<long>(std::floor((y + reach) / row));
  for (long j = first; j <= last; ++j) {
    const double height = static_cast<double>(j) * row - y;
    const double half = std::sqrt(std::max(0.0, reach * reach - height * height));
    const double middle = x - (j % 2 != 0 ? 0.5 : 0);
    places += std::floor(middle + half) - std::ceil(middle - half) + 1;
  }
  return places;
}

// The most places of a close-packed layer in a disc, over places of its middle in a cell of the
// layer. The middle is at a place, between two or among three of them, or somewhere else.
double places_in_disc(double radius) {
  constexpr int steps = 24;  // a multiple of 6
  double most = 0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double a = static_cast<double>(i) / steps, b = static_cast<double>(j) / steps;
      most = std::max(most, places_around(a + 0.5 * b, b * row, radius));
    }
  }
  return most;
}

// Places of a close-packed layer between two planes, per period: rows lie along the planes or
// across them.
double places_between_planes(double period, double across) {
  const double along_planes = (std::floor(across / row + rounding) + 1) * period;
  const double row_across = 0.5 * (places_on(across, 0) + places_on(across, 0.5));
  return std::max(along_planes, row_across * period / row);
}

// Spheres of a full layer. Between walls whole rows fit, and the area of a footprint counts too
// few, as places at its edge have half of their cells outside.
double full_layer(const Container& container) {
  const Boundary boundary(container);
  if (boundary.tube) return places_in_disc(boundary.axis() - sphere_radius);
  if (!boundary.has_walls()) return boundary.width_x * boundary.width_y / row;
  const double along_x = boundary.width_x - 2 * boundary.margin_x();
  const double along_y = boundary.width_y - 2 * boundary.margin_y();
  if (boundary.periodic_x) return places_between_planes(along_x, along_y);
  if (boundary.periodic_y) return places_between_planes(along_y, along_x);
  return std::max(places_in_rectangle(along_x, along_y), places_in_rectangle(along_y, along_x));
}

// Spheres of a close-packed layer by the area that centres can reach. A layer in the holes of a
// full one has fewer places: in a tube of 5 d 12 after 19, where this is 14.5.
double layer_by_area(const Container& container) {
  return std::max(1.0, footprint_area(Boundary(container), sphere_radius) / row);
}

// For ascending heights those in [low, high).
std::span<const double> heights_between(const std::vector<double>& heights, double low,
                                        double high) {
  const auto first = std::ranges::lower_bound(heights, low);
  const auto last = std::ranges::lower_bound(heights, high);
  return {first, std::max(first, last)};
}

// The mean of the heights around a place, and once more around that mean; the place itself where
// there are none.
double height_near(const std::vector<double>& heights, double place) {
  constexpr double reach = 0.3;
  for (int turn = 0; turn < 2; ++turn) {
    const std::span<const double> near = heights_between(heights, place - reach, place + reach);
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

std::vector<Layer> layers(const Packing& packing, double tolerance, std::size_t most) {
  if (!Boundary(packing.container).has_floor()) {
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
  } while (expected - 0.5 * spacing <= heights.back() && all.size() < most);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double low = k == 0 ? 0 : 0.5 * (all[k - 1].found + all[k].found);
    const double high =
        k + 1 < all.size() ? 0.5 * (all[k].found + all[k + 1].found) : heights.back() + spacing;
    const auto number = static_cast<double>(heights_between(heights, low, high).size());
    const auto near = static_cast<double>(
        heights_between(heights, std::max(low, all[k].found - tolerance),
                        std::min(high, std::nextafter(all[k].found + tolerance, high)))
            .size());
    all[k].filling = number / full_layer(packing.container);
    all[k].share = number > 0 ? near / number : 0;
  }
  return all;
}

std::size_t grown_layers(const Packing& packing, const LayerRule& rule) {
  // If there are more layers than spheres, one is empty and ends the grown ones.
  const std::vector<Layer> all = layers(packing, rule.tolerance, packing.centres.size() + 2);
  const double by_area = full_layer(packing.container) / layer_by_area(packing.container);
  std::size_t grown = 0;
  for (double expected = sphere_radius; grown < all.size(); ++grown) {
    const Layer& layer = all[grown];
    if (std::abs(layer.found - expected) > rule.tolerance || layer.share < rule.least_share ||
        layer.filling * by_area < rule.least_filling) {
      break;
    }
    expected = layer.found + spacing;
  }
  return grown;
}

}  // namespace jostle::inline structure
