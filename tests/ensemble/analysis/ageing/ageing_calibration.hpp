#pragma once

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "ensemble/analysis/ageing/trends.hpp"
#include "tests/ensemble/analysis/ageing/ageing_paths.hpp"

// How often intervals hold the truth, and how often tests of ageing raise an alarm.
namespace jostle::ageing_paths {

inline LogCurves curves_of(std::uint64_t seed, std::uint32_t m, const Paths& paths,
                           Changes kind = Changes::mean_square) {
  std::vector<std::uint32_t> all(m);
  std::iota(all.begin(), all.end(), 0u);
  return log_curves(rows(seed, m, paths), grid, all, kind);
}

inline double deviation(double share, double n) {
  return std::sqrt(share * (1 - share) / n);
}

/// How often intervals hold the truth; `lowest`: the end of one without a limit below.
struct Held {
  double lowest = 0;
  int n = 0, at_68 = 0, at_95 = 0, limited = 0;
  template <class Estimate>
  void add(const Estimate& found, double exact) {
    ++n;
    at_68 += found.low_68 <= exact && exact <= found.high_68;
    at_95 += found.low_95 <= exact && exact <= found.high_95;
    limited += found.low_95 > lowest && std::isfinite(found.high_95);
  }
  double percent(int count) const { return 100.0 * count / n; }
  std::string text() const {
    if (n == 0) return " |                  ";
    return fmt::format(" | {:5.1f} {:5.1f} {:5.1f}", percent(at_68), percent(at_95),
                       percent(limited));
  }
  // 60 to 80 % and 90 to 100 %, and three deviations of so many independent cases.
  void check(double independent) const {
    CHECK(percent(at_68) >= 60 - 300 * deviation(0.6, independent));
    CHECK(percent(at_68) <= 80 + 300 * deviation(0.8, independent));
    CHECK(percent(at_95) >= 90 - 300 * deviation(0.9, independent));
  }
};

/// How often a test finds something, and how often it excludes it.
struct Found {
  int n = 0, alarms = 0, excluded = 0;
  void add(const AgeTrend& trend, const std::string& not_found) {
    ++n;
    alarms += trend.p < 0.05;
    excluded += trend.verdict.starts_with(not_found);
  }
  double share() const { return static_cast<double>(alarms) / n; }
  std::string text() const {
    return fmt::format(" | {:5.1f} {:5.1f}", 100 * share(), 100.0 * excluded / n);
  }
};

}  // namespace jostle::ageing_paths
