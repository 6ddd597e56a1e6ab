#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace jostle::inline ensemble {

/// A curve y(x), x > 0 ascending.
struct ScaledCurve {
  std::vector<double> x, y;  // [n] each
};

/// How well curves lie on one another. Every point of every curve is compared with every other
/// curve that spans its x (linear between points, in ln x).
struct Collapse {
  /// Root mean square of the differences over that of the compared y.
  double relative;
  std::size_t comparisons;
};

/// NaN and no comparisons where no curve spans a point of another.
Collapse collapse(std::span<const ScaledCurve> curves);

}  // namespace jostle::inline ensemble
