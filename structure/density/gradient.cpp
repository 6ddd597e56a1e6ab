#include "structure/density/gradient.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "engine/bed/boundary.hpp"

namespace jostle::inline structure {

namespace {

// For sums over the bins below each edge, the value at a place between edges.
double interpolate(const Profile& profile, const std::vector<double>& sums, double place) {
  const auto& edges = profile.edges;
  if (place <= edges.front()) return 0;
  if (place >= edges.back()) return sums.back();
  const auto next = std::ranges::upper_bound(edges, place);
  const auto k = static_cast<std::size_t>(next - edges.begin()) - 1;
  const double part = (place - edges[k]) / (edges[k + 1] - edges[k]);
  return sums[k] + part * (sums[k + 1] - sums[k]);
}

// 2<Z> of the solids in the bins: the top of the packing, if it were even.
double twice_mean_height(const Profile& vertical) {
  double solid = 0, moment = 0;
  for (std::size_t k = 0; k < vertical.size(); ++k) {
    const double in_bin = vertical.values[k] * vertical.volumes[k];
    solid += in_bin;
    moment += in_bin * vertical.middle(k);
  }
  return solid > 0 ? 2 * moment / solid : 0;
}

// A straight line by least squares, about the means.
Gradient fit_line(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0, residual = 0;
  for (const double value : x) mean_x += value / n;
  for (const double value : y) mean_y += value / n;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  const double slope = xy / xx;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double deviation = y[i] - mean_y - slope * (x[i] - mean_x);
    residual += deviation * deviation;
  }
  return {-slope, std::sqrt(residual / (n - 2) / xx), x.size(), {}};
}

std::string in_radii(double length) {
  const std::string text = std::to_string(length / sphere_radius);
  return text.substr(0, text.find('.') + 2) + " R";
}

}  // namespace

Profile smoothed(const Profile& profile, double width) {
  assert(width > 0);
  std::vector<double> solids(1, 0.0), volumes(1, 0.0);  // below each edge
  for (std::size_t k = 0; k < profile.size(); ++k) {
    solids.push_back(solids.back() + profile.values[k] * profile.volumes[k]);
    volumes.push_back(volumes.back() + profile.volumes[k]);
  }
  Profile smooth = profile;
  const double top = profile.edges.back();
  const double area = profile.volumes.back() / (top - profile.edges[profile.size() - 1]);
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const double low = profile.middle(k) - 0.5 * width, high = profile.middle(k) + 0.5 * width;
    const double empty = area * std::max(0.0, high - top);
    smooth.values[k] =
        (interpolate(profile, solids, high) - interpolate(profile, solids, low)) /
        (interpolate(profile, volumes, high) - interpolate(profile, volumes, low) + empty);
  }
  return smooth;
}

GradientRange gradient_range(const Container& container) {
  GradientRange range;
  const Boundary boundary(container);
  if (boundary.periodic_sides() && boundary.has_floor()) range.high = 26 * sphere_radius;
  return range;
}

Gradient gradient(const Profile& vertical, const GradientRange& range) {
  const double top = range.depth * twice_mean_height(vertical);
  const Profile profile = range.smoothing > 0 ? smoothed(vertical, range.smoothing) : vertical;
  std::vector<double> radii, fractions;
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const double height = profile.middle(k);
    if (height < range.low || height > std::min(range.high, top)) continue;
    if (height + 0.5 * range.smoothing > profile.edges.back()) continue;
    radii.push_back(height / sphere_radius);
    fractions.push_back(profile.values[k]);
  }
  if (radii.size() >= 3) return fit_line(radii, fractions);
  Gradient none;
  none.points = radii.size();
  none.reason = "only " + std::to_string(radii.size()) + " bins lie between " +
                in_radii(range.low) + " and " + in_radii(range.high) +
                " and below the packing's surface, taken at " + in_radii(top) +
                "; a straight line needs 3";
  return none;
}

}  // namespace jostle::inline structure
