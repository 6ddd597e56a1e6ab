#pragma once

#include <string>
#include <vector>

namespace jostle {

/// A measured or simulated curve X(t).
struct Curve {
  std::vector<double> t;      // [n]
  std::vector<double> x;      // [n]
  std::vector<double> sigma;  // [n], error of each x; or empty: all alike, size unknown
};

/// What makes a curve unfit for any fit: lengths that differ, values that are not finite, errors
/// that are not positive. One sentence a fault, the first place named; empty for a good curve.
std::vector<std::string> faults(const Curve& curve);

/// The points with first <= t <= last.
Curve within(const Curve& curve, double first, double last);

/// At most `n` of the points: all, or those nearest to n values equally spaced in log t (where
/// every t > 0 and they span more than a factor 100) or in rank. Deterministic.
Curve thinned(const Curve& curve, std::size_t n);

}  // namespace jostle
