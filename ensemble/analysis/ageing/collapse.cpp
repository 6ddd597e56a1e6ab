#include "ensemble/analysis/ageing/collapse.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/numbers.hpp"

namespace jostle::inline ensemble {

namespace {

std::optional<double> interpolated(const ScaledCurve& curve, double x) {
  if (curve.x.empty() || x < curve.x.front() || x > curve.x.back()) return std::nullopt;
  const auto above =
      static_cast<std::size_t>(std::ranges::lower_bound(curve.x, x) - curve.x.begin());
  if (curve.x[above] == x) return curve.y[above];
  const std::size_t below = above - 1;
  const double share = std::log(x / curve.x[below]) / std::log(curve.x[above] / curve.x[below]);
  return std::lerp(curve.y[below], curve.y[above], share);
}

}  // namespace

Collapse collapse(std::span<const ScaledCurve> curves) {
  double differences = 0, squares = 0;
  std::size_t n = 0;
  for (const ScaledCurve& curve : curves) {
    for (const ScaledCurve& other : curves) {
      if (&curve == &other) continue;
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const std::optional<double> there = interpolated(other, curve.x[i]);
        if (!there) continue;
        const double difference = curve.y[i] - *there;
        differences += difference * difference;
        squares += 0.5 * (curve.y[i] * curve.y[i] + *there * *there);
        ++n;
      }
    }
  }
  if (n == 0) return {not_a_number, 0};
  return {std::sqrt(differences / squares), n};
}

}  // namespace jostle::inline ensemble
