#pragma once

#include <array>
#include <numbers>

namespace jostle {

inline constexpr int n_contact_bins = 20;

/// The value at contact of a pair distribution: least squares of a cubic through its values in
/// n_contact_bins equal bins from contact on, the constant term of the normal equations solved by
/// elimination.
inline double extrapolated_to_contact(const std::array<double, n_contact_bins>& g) {
  std::array<std::array<double, 5>, 4> rows{};
  for (int bin = 0; bin < n_contact_bins; ++bin) {
    const double x = (bin + 0.5) / n_contact_bins;
    const std::array<double, 4> powers = {1, x, x * x, x * x * x};
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) rows[a][b] += powers[a] * powers[b];
      rows[a][4] += powers[a] * g[bin];
    }
  }
  for (int pivot = 3; pivot > 0; --pivot) {
    for (int row = 0; row < pivot; ++row) {
      const double factor = rows[row][pivot] / rows[pivot][pivot];
      for (int k = 0; k < 5; ++k) rows[row][k] -= factor * rows[pivot][k];
    }
  }
  return rows[0][4] / rows[0][0];
}

/// Volume between two spheres.
inline double shell_volume(double low, double high) {
  return 4.0 / 3 * std::numbers::pi * (high * high * high - low * low * low);
}

}  // namespace jostle
