#include "engine/bed/slab.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/bed/boundary.hpp"

namespace jostle::inline engine {

namespace {

// Volume of a unit-diameter sphere below height h above its lowest point: pi h^2 (3 R - h) / 3.
double cap_volume(double h) {
  constexpr double pi = 6 * sphere_volume;
  if (h <= 0) return 0;
  if (h >= 1) return sphere_volume;
  return pi * h * h * (1.5 - h) / 3;
}

// Integral of cap_volume(h) over h from low to high: a cubic where the sphere is cut, of which
// Gauss's rule of two points is exact, and the whole sphere above.
double cap_integral(double low, double high) {
  const double begin = std::clamp(low, 0.0, 1.0), end = std::clamp(high, 0.0, 1.0);
  const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
  const double offset = half / std::sqrt(3.0);
  return half * (cap_volume(middle - offset) + cap_volume(middle + offset)) +
         sphere_volume * (std::max(high, 1.0) - std::max(low, 1.0));
}

double whole_volume(double diameter) {
  return diameter * diameter * diameter * sphere_volume;
}

double quantile(std::vector<double>& heights, double q) {
  const double position = q * static_cast<double>(heights.size() - 1);
  const auto rank = static_cast<std::ptrdiff_t>(position);
  const auto nth = heights.begin() + rank;
  std::nth_element(heights.begin(), nth, heights.end());
  const double low = *nth;
  if (nth + 1 == heights.end()) return low;
  const double high = *std::min_element(nth + 1, heights.end());
  return low + (position - static_cast<double>(rank)) * (high - low);
}

struct Weighted {
  double height, weight;
};

// Equal weights give quantile(). The spheres' middles, in order of height, lie at the sums of
// weights up to them; between two of them heights are interpolated.
HeightWindow weighted_quantiles(const Packing& packing, QuantileWindow quantiles) {
  std::vector<Weighted> spheres;
  for (std::size_t i = 0; i < packing.centres.size(); ++i)
    spheres.push_back({packing.centres[i].z, whole_volume(2 * packing.radius(i))});
  std::ranges::sort(spheres, {}, &Weighted::height);
  double span = 0;
  for (std::size_t k = 1; k < spheres.size(); ++k)
    span += 0.5 * (spheres[k - 1].weight + spheres[k].weight);
  const auto height_at = [&](double q) {
    double cumulated = 0;
    for (std::size_t k = 1; k < spheres.size(); ++k) {
      const Weighted &low = spheres[k - 1], &high = spheres[k];
      const double step = 0.5 * (low.weight + high.weight), beyond = q * span - cumulated;
      if (beyond <= step)
        return low.height + std::max(0.0, beyond / step) * (high.height - low.height);
      cumulated += step;
    }
    return spheres.back().height;
  };
  return {height_at(quantiles.low), height_at(quantiles.high)};
}

// Area of the cut through a sphere centred at height z.
double cut_area(double z, double height, double radius) {
  constexpr double pi = 6 * sphere_volume;
  const double squared = radius * radius - (height - z) * (height - z);
  return squared > 0 ? pi * squared : 0;
}

// Spheres that fill all of a slab, as one does at its equator in a tube as wide, exceed it by
// rounding alone. Spheres that overlap may exceed it by more, and that is shown.
double fraction_of(double solid, double volume) {
  constexpr double rounding = 1e-9;
  const double fraction = solid / volume;
  return fraction > 1 && fraction < 1 + rounding ? 1 : fraction;
}

}  // namespace

double sphere_volume_in_slab(double z, double low, double high, double diameter) {
  const double bottom = z - 0.5 * diameter;
  if (diameter == 1) return cap_volume(high - bottom) - cap_volume(low - bottom);
  const double scale = 1 / diameter;
  return diameter * diameter * diameter *
         (cap_volume((high - bottom) * scale) - cap_volume((low - bottom) * scale));
}

double solids_fraction(const Packing& packing, HeightWindow window) {
  assert(window.low <= window.high);
  constexpr double thin = 1e-5;  // the mean over so thin a slab is that of its middle to 1e-10
  const bool is_cut = window.high - window.low < thin;
  const double middle = 0.5 * (window.low + window.high);
  double solid = 0;
  const auto add = [&](double shift) {
    for (std::size_t i = 0; i < packing.centres.size(); ++i) {
      const double z = packing.centres[i].z + shift, radius = packing.radius(i);
      solid += is_cut ? cut_area(z, middle, radius)
                      : sphere_volume_in_slab(z, window.low, window.high, 2 * radius);
    }
  };
  add(0);
  if (const Boundary boundary(packing.container); boundary.periodic_z) {
    add(boundary.height);
    add(-boundary.height);
  }
  const double depth = is_cut ? 1 : window.high - window.low;
  return fraction_of(solid, footprint_area(packing.container) * depth);
}

double tapered_solids_fraction(const Packing& packing, HeightWindow window, double taper) {
  assert(window.low <= window.high && taper >= 0);
  constexpr double thin = 1e-5;  // the mean over so small a shift is that without, to 1e-11
  if (taper < thin) return solids_fraction(packing, window);
  assert(!Boundary(packing.container).periodic_z);
  const double depth = window.high - window.low;
  if (depth < taper) {  // this weight of heights, with taper and depth exchanged
    const double middle = 0.5 * (window.low + window.high);
    return tapered_solids_fraction(packing, {middle - 0.5 * taper, middle + 0.5 * taper}, depth);
  }
  double solid = 0;
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    // In diameters of the sphere, whose integral has the dimension of a length to the fourth.
    const double diameter = 2 * packing.radius(i), bottom = packing.centres[i].z - 0.5 * diameter;
    const double low = (window.low - bottom) / diameter, high = (window.high - bottom) / diameter;
    const double half = 0.5 * taper / diameter;
    if (low - half > 1 || high + half < 0) continue;
    const double integral =
        cap_integral(high - half, high + half) - cap_integral(low - half, low + half);
    solid += packing.sizes ? diameter * diameter * diameter * diameter * integral : integral;
  }
  return fraction_of(solid / taper, footprint_area(packing.container) * depth);
}

HeightWindow resolve(const Window& window, const Packing& packing) {
  if (const auto* heights = std::get_if<HeightWindow>(&window)) return *heights;
  assert(!packing.centres.empty());
  const auto& quantiles = std::get<QuantileWindow>(window);
  if (packing.sizes) return weighted_quantiles(packing, quantiles);
  std::vector<double> heights(packing.centres.size());
  std::ranges::transform(packing.centres, heights.begin(), &Vec3::z);
  const double low = quantile(heights, quantiles.low);
  const double high = quantile(heights, quantiles.high);
  return {low, high};
}

}  // namespace jostle::inline engine
