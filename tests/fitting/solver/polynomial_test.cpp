#include "fitting/solver/polynomial.hpp"

#include <catch2/catch.hpp>

using namespace jostle;

TEST_CASE("A polynomial through as many points as coefficients passes through them") {
  const std::vector<double> x = {1e3, 1e3 + 1, 1e3 + 3}, weights = {1, 2, 3};
  const std::vector<double> y = {2 - 1 + 0.5, 2.0, 2 + 2 + 2};  // 2 + s + s^2 / 2, s = x - 1001
  const std::vector<double> c = polynomial_fit(x, y, weights, 3, 1001, 1);
  CHECK(c[0] == Approx(2).epsilon(1e-13));
  CHECK(c[1] == Approx(1).epsilon(1e-13));
  CHECK(c[2] == Approx(0.5).epsilon(1e-13));
}

TEST_CASE("A polynomial's points count by the squares of their weights") {
  const std::vector<double> x = {0, 1, 2}, y = {0, 0, 3}, weights = {1, 1, 2};
  // The constant: sum of w^2 y over sum of w^2.
  CHECK(polynomial_fit(x, y, weights, 1)[0] == Approx(2).epsilon(1e-14));
  CHECK(polynomial_fit(x, y, std::vector<double>{1, 1, 0}, 2)[1] == Approx(0).margin(1e-14));
}
