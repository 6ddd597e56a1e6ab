#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "engine/bed/slab.hpp"
#include "structure/density/sphere_cuts.hpp"

namespace jostle::inline structure {

namespace {

// Area that two circles share, r and s their radii, d the distance of their centres, where their
// outlines cross.
double shared_area(double r, double s, double d) {
  // Twice the area of the triangle of r, s and d.
  const double product = (d + r + s) * (d + r - s) * (d - r + s) * (r + s - d);
  const double twice = 0.5 * std::sqrt(std::max(0.0, product));
  const double at_r = std::atan2(twice, 0.5 * (d * d + r * r - s * s));
  const double at_s = std::atan2(twice, 0.5 * (d * d + s * s - r * r));
  return r * r * at_r + s * s * at_s - twice;
}

// Gauss-Legendre nodes and weights on [0, 1], by Newton's method on the Legendre polynomial.
template <int n>
struct GaussRule {
  std::array<double, n> nodes, weights;

  GaussRule() : nodes(), weights() {
    for (int i = 0; i < n; ++i) {
      double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 0;
      for (int step = 0; step < 6; ++step) {
        double p = 1, previous = 0;
        for (int k = 1; k <= n; ++k) {
          const double next = ((2 * k - 1) * x * p - (k - 1) * previous) / k;
          previous = p;
          p = next;
        }
        slope = n * (x * p - previous) / (x * x - 1);
        x -= p / slope;
      }
      nodes[static_cast<std::size_t>(i)] = 0.5 * (1 - x);
      weights[static_cast<std::size_t>(i)] = 1 / ((1 - x * x) * slope * slope);
    }
  }
};

// Integral over [from, to], at whose ends the function may go like the power 3/2 of the distance:
// as a function of t, z = from + (to - from) t^2 (3 - 2 t), it is smooth there.
template <class Function>
double integral(double lower, double upper, Function&& function) {
  static const GaussRule<24> rule;
  if (!(upper > lower)) return 0;
  double sum = 0;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double t = rule.nodes[k];
    sum +=
        rule.weights[k] * 6 * t * (1 - t) * function(lower + (upper - lower) * t * t * (3 - 2 * t));
  }
  return sum * (upper - lower);
}

}  // namespace

double sphere_volume_in_tube(double offset, double tube, double low, double high) {
  assert(offset >= 0 && tube >= 0 && low <= high);
  const double bottom = std::clamp(low, -sphere_radius, sphere_radius);
  const double top = std::clamp(high, -sphere_radius, sphere_radius);
  if (tube >= offset + sphere_radius) return sphere_volume_in_slab(0, bottom, top);
  if (tube <= offset - sphere_radius || tube == 0) return 0;

  // The outlines of disc and tube cross at heights `core` to `edge` above and below the centre;
  // nearer to it the tube lies within the disc, farther away the disc in the tube or outside.
  const auto height = [](double disc) {
    return std::sqrt(std::max(0.0, (sphere_radius - disc) * (sphere_radius + disc)));
  };
  const double core = tube + offset < sphere_radius ? height(tube + offset) : 0;
  const double edge = height(std::abs(tube - offset));
  const auto integral_between = [&](double lower, double upper) {
    return std::max(0.0, std::min(top, upper) - std::max(bottom, lower));
  };
  double volume = std::numbers::pi * tube * tube * integral_between(-core, core);
  if (tube > offset) {
    volume += sphere_volume_in_slab(0, std::max(edge, bottom), std::max(edge, top)) +
              sphere_volume_in_slab(0, std::min(-edge, bottom), std::min(-edge, top));
  }
  const auto area = [&](double z) { return shared_area(height(std::abs(z)), tube, offset); };
  if (bottom == -top) return volume + 2 * integral(core, std::min(edge, top), area);
  return volume + integral(std::max(core, bottom), std::min(edge, top), area) +
         integral(std::max(-edge, bottom), std::min(-core, top), area);
}

}  // namespace jostle::inline structure
