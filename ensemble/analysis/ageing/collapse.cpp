#include "ensemble/analysis/ageing/collapse.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/numbers.hpp"

namespace jostle::inline ensemble {

namespace {

std::optional<double> interpolated(const ScaledCurve& curve, double x) {
  if (curve.x.empty() || x < curve.x.front() || x > curve.x.back()) return std::nullopt;
  const auto upper =
      static_cast<std::size_t>(std::ranges::lower_bound(curve.x, x) - curve.x.begin());
  if (curve.x[upper] == x) return curve.y[upper];
  const std::size_t lower = upper - 1;
  const double share = std::log(x / curve.x[lower]) / std::log(curve.x[upper] / curve.x[lower]);
  return std::lerp(curve.y[lower], curve.y[upper], share);
}

}  // namespace

Collapse collapse(std::span<const ScaledCurve> curves) {
  double differences = 0, squares = 0;
  std::size_t n = 0;
  for (const ScaledCurve& curve : curves) {
    for (const ScaledCurve& curve_seen : curves) {
      if (&curve == &curve_seen) continue;
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const std::optional<double> interpolated_value = interpolated(curve_seen, curve.x[i]);
        if (!interpolated_value) continue;
        const double difference = curve.y[i] - *interpolated_value;
        differences += difference * difference;
        squares += 0.5 * (curve.y[i] * curve.y[i] + *interpolated_value * *interpolated_value);
        ++n;
      }
    }
  }
  if (n == 0) return {not_a_number, 0};
  return {std::sqrt(differences / squares), n};
}

}  // namespace jostle::inline ensemble
