#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>
#include <vector>

// True if two samples have one law.
namespace jostle {

/// Difference of the means of two samples in its standard errors.
inline double welch(const std::vector<double>& a, const std::vector<double>& b) {
  const auto moments = [](const std::vector<double>& x) {
    double mean = 0, sum = 0;
    for (const double value : x) mean += value / static_cast<double>(x.size());
    for (const double value : x) sum += (value - mean) * (value - mean);
    const auto n = static_cast<double>(x.size());
    return std::pair{mean, sum / (n - 1) / n};
  };
  const auto [mean_a, error_a] = moments(a);
  const auto [mean_b, error_b] = moments(b);
  return std::abs(mean_a - mean_b) / std::sqrt(error_a + error_b);
}

/// Kolmogorov and Smirnov's distance of two samples over its scale sqrt(1 / n + 1 / m).
inline double kolmogorov_smirnov(std::vector<double> a, std::vector<double> b) {
  std::ranges::sort(a);
  std::ranges::sort(b);
  double distance = 0;
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    const double x = std::min(a[i], b[j]);
    while (i < a.size() && a[i] <= x) ++i;
    while (j < b.size() && b[j] <= x) ++j;
    distance = std::max(distance, std::abs(static_cast<double>(i) / static_cast<double>(a.size()) -
                                           static_cast<double>(j) / static_cast<double>(b.size())));
  }
  return distance /
         std::sqrt(1.0 / static_cast<double>(a.size()) + 1.0 / static_cast<double>(b.size()));
}

/// Both means within 3 standard errors and both laws within the distance that one pair of equal
/// laws in 1000 exceeds.
inline void check_same_law(const char* title, const std::vector<double>& a,
                           const std::vector<double>& b) {
  INFO(title);
  CHECK(welch(a, b) < 3);
  CHECK(kolmogorov_smirnov(a, b) < 1.949);
}

}  // namespace jostle
