#include "ensemble/analysis/ageing/collapse.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace jostle {
namespace {

// y = slope ln x at `n` points from x = first on, a factor 2 apart.
ScaledCurve logarithm(double slope, double first, int n) {
  ScaledCurve curve;
  for (int i = 0; i < n; ++i) {
    curve.x.push_back(first * std::exp2(i));
    curve.y.push_back(slope * std::log(curve.x.back()));
  }
  return curve;
}

}  // namespace

TEST_CASE("Curves on one law collapse, wherever their points are") {
  const Collapse found = collapse(std::vector{logarithm(1, 1, 6), logarithm(1, 1.5, 6)});
  CHECK(found.comparisons == 10);
  CHECK(found.relative < 1e-13);
}

TEST_CASE("A constant distance counts by the size of the values") {
  ScaledCurve low = logarithm(0, 1, 5), high = logarithm(0, 1, 5);
  for (double& y : low.y) y += 1;
  for (double& y : high.y) y += 2;
  const Collapse found = collapse(std::vector{low, high});
  CHECK(found.comparisons == 10);
  CHECK(found.relative == Approx(1 / std::sqrt(2.5)).epsilon(1e-14));
}

TEST_CASE("Curves that share no x cannot be compared") {
  const Collapse found = collapse(std::vector{logarithm(1, 1, 3), logarithm(1, 100, 3)});
  CHECK(found.comparisons == 0);
  CHECK(std::isnan(found.relative));
}

}  // namespace jostle
