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
  const double from = std::clamp(low, 0.0, 1.0), to = std::clamp(high, 0.0, 1.0);
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  const double offset = half / std::sqrt(3.0);
  return half * (cap_volume(middle - offset) + cap_volume(middle + offset)) +
         sphere_volume * (std::max(high, 1.0) - std::max(low, 1.0));
}

double quantile(std::vector<double>& heights, double q) {
  const double position = q * static_cast<double>(heights.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(position);
  const auto nth = heights.begin() + below;
  std::nth_element(heights.begin(), nth, heights.end());
  const double low = *nth;
  if (nth + 1 == heights.end()) return low;
  const double high = *std::min_element(nth + 1, heights.end());
  return low + (position - static_cast<double>(below)) * (high - low);
}

// Area of the cut through a sphere centred at height z.
double cut_area(double z, double height) {
  constexpr double pi = 6 * sphere_volume;
  const double squared = 0.25 - (height - z) * (height - z);
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

double sphere_volume_in_slab(double z, double low, double high) {
  const double bottom = z - sphere_radius;
  return cap_volume(high - bottom) - cap_volume(low - bottom);
}

double solids_fraction(const Packing& packing, HeightWindow window) {
  assert(window.low <= window.high);
  constexpr double thin = 1e-5;  // the mean over so thin a slab is that of its middle to 1e-10
  const bool is_cut = window.high - window.low < thin;
  const double middle = 0.5 * (window.low + window.high);
  double solid = 0;
  const auto add = [&](double shift) {
    for (const Vec3& centre : packing.centres) {
      const double z = centre.z + shift;
      solid += is_cut ? cut_area(z, middle) : sphere_volume_in_slab(z, window.low, window.high);
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
  if (depth < taper) {  // the same weight of heights, from taper and depth exchanged
    const double middle = 0.5 * (window.low + window.high);
    return tapered_solids_fraction(packing, {middle - 0.5 * taper, middle + 0.5 * taper}, depth);
  }
  double solid = 0;
  for (const Vec3& centre : packing.centres) {
    const double low = window.low - (centre.z - sphere_radius);
    const double high = window.high - (centre.z - sphere_radius);
    if (low - 0.5 * taper > 1 || high + 0.5 * taper < 0) continue;
    solid += cap_integral(high - 0.5 * taper, high + 0.5 * taper) -
             cap_integral(low - 0.5 * taper, low + 0.5 * taper);
  }
  return fraction_of(solid / taper, footprint_area(packing.container) * depth);
}

HeightWindow resolve(const Window& window, const Packing& packing) {
  if (const auto* heights = std::get_if<HeightWindow>(&window)) return *heights;
  assert(!packing.centres.empty());
  const auto& quantiles = std::get<QuantileWindow>(window);
  std::vector<double> heights(packing.centres.size());
  std::ranges::transform(packing.centres, heights.begin(), &Vec3::z);
  const double low = quantile(heights, quantiles.low);
  const double high = quantile(heights, quantiles.high);
  return {low, high};
}

}  // namespace jostle::inline engine
