#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace jostle::inline fitting {

/// A measured or simulated curve X(t).
struct Curve {
  std::vector<double> t;           // [n]
  std::vector<double> x;           // [n]
  std::vector<double> sigma = {};  // [n], error of each x; or empty: all alike, size unknown
  /// The independent realizations that x is the mean of, [n, n_realizations], or empty. Errors of
  /// a fit then come from how they scatter as whole curves, whatever the memory of each.
  std::vector<double> values = {};
  std::size_t n_realizations = 0;  // 0, or at least 2
  /// The realizations that had a value, [n, n_realizations], or empty: all. Where one had none,
  /// `values` are the pseudo-values of mean_of_present(), and `offsets` [n_realizations] its
  /// offsets.
  std::vector<std::uint8_t> present = {};
  std::vector<double> offsets = {};
};

/// The mean of realizations, in their order. values: [n, n_realizations], n_realizations >= 1; one
/// alone is the curve itself, without realizations behind it.
Curve mean_curve(std::vector<double> t, std::vector<double> values, std::size_t n_realizations);

/// The curve with errors of its means over realizations, where it has realizations and no errors of
/// its own: their variance pooled over all points, of x or, where `relative`, of ln x. The scatter
/// of a few values at one point would be no weight: fits would follow the points where realizations
/// agree by accident. Where realizations are missing it grows as one over the number present.
Curve with_pooled_errors(Curve curve, bool relative = false);

/// Faults that make a curve unfit for any fit: lengths that differ, values that are not finite,
/// errors that are not positive, a lone realization. One sentence per fault, with its first place;
/// empty for a good curve.
std::vector<std::string> faults(const Curve& curve);

/// The points with first <= t <= last.
Curve restricted(const Curve& curve, double first, double last);

/// At most `n` of the points: all, or those nearest to n values equally spaced in log t (where
/// every t > 0 and they span more than a factor 100) or in rank. Deterministic.
Curve thinned(const Curve& curve, std::size_t n);

}  // namespace jostle::inline fitting
