#include "fitting/binned_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace jostle::inline fitting {

namespace {

constexpr double widest = 1.01;  // last over first t of a bin
constexpr double least_span = 100;

}  // namespace

Curve binned(const Curve& curve, std::size_t most) {
  if (curve.t.size() <= most) return curve;
  std::vector<std::size_t> order(curve.t.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return curve.t[a] < curve.t[b]; });
  const auto t = [&](std::size_t rank) { return curve.t[order[rank]]; };
  const auto positive = static_cast<std::size_t>(
      std::partition_point(order.begin(), order.end(),
                           [&](std::size_t i) { return !(curve.t[i] > 0); }) -
      order.begin());
  if (t(0) < 0 || positive == order.size() || t(order.size() - 1) < least_span * t(positive)) {
    return curve;
  }
  Curve bins;
  for (std::size_t first = 0, end; first < order.size(); first = end) {
    double weights = 0, mean_t = 0, mean_x = 0;
    for (end = first; end < order.size() && t(end) <= widest * t(first); ++end) {
      const std::size_t i = order[end];
      const double weight = curve.sigma.empty() ? 1 : 1 / (curve.sigma[i] * curve.sigma[i]);
      weights += weight;
      mean_t += weight / weights * (curve.t[i] - mean_t);
      mean_x += weight / weights * (curve.x[i] - mean_x);
    }
    bins.t.push_back(mean_t);
    bins.x.push_back(mean_x);
    bins.sigma.push_back(1 / std::sqrt(weights));
  }
  return bins;
}

}  // namespace jostle::inline fitting
