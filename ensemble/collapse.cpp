#include "ensemble/collapse.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace jostle {

namespace {

struct Value {
  double y, error;
};

std::optional<Value> interpolated(const ScaledCurve& curve, double x) {
  if (curve.x.empty() || x < curve.x.front() || x > curve.x.back()) return std::nullopt;
  const auto above =
      static_cast<std::size_t>(std::ranges::lower_bound(curve.x, x) - curve.x.begin());
  if (curve.x[above] == x) return Value{curve.y[above], curve.error[above]};
  const std::size_t below = above - 1;
  const double share = std::log(x / curve.x[below]) / std::log(curve.x[above] / curve.x[below]);
  return Value{std::lerp(curve.y[below], curve.y[above], share),
               std::lerp(curve.error[below], curve.error[above], share)};
}

}  // namespace

Collapse collapse(std::span<const ScaledCurve> curves) {
  double over_error = 0, differences = 0, squares = 0;
  std::size_t n = 0;
  for (const ScaledCurve& curve : curves) {
    for (const ScaledCurve& other : curves) {
      if (&curve == &other) continue;
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const std::optional<Value> there = interpolated(other, curve.x[i]);
        if (!there) continue;
        const double difference = curve.y[i] - there->y;
        const double variance = curve.error[i] * curve.error[i] + there->error * there->error;
        over_error += difference * difference / variance;
        differences += difference * difference;
        squares += 0.5 * (curve.y[i] * curve.y[i] + there->y * there->y);
        ++n;
      }
    }
  }
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  if (n == 0) return {not_a_number, not_a_number, 0};
  return {std::sqrt(over_error / static_cast<double>(n)), std::sqrt(differences / squares), n};
}

}  // namespace jostle
