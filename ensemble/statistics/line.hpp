#pragma once

#include <span>

namespace jostle::inline ensemble {

/// Least squares over the indices 0 .. n - 1, n >= 1: middle + slope (i - center).
struct Line {
  double center = 0;  // (n - 1) / 2
  double middle = 0;  // the mean
  double slope = 0;   // 0 for one value
};
Line fit_line(std::span<const double> series);

}  // namespace jostle::inline ensemble
