#include "ensemble/target_precision.hpp"

#include <catch2/catch.hpp>
#include <limits>

namespace jostle {

namespace {

SpreadFound error_of(double value) {
  return {.spread = Spread::standard_error, .value = value, .at_most = 0.001};
}

}  // namespace

TEST_CASE("Where the spread is small, no more realizations are asked for") {
  CHECK(next_realizations(8, std::vector{error_of(0.001), error_of(0.0001)}, 100) == 8);
}

TEST_CASE("A standard error asks for what it needs, at most for twice as many") {
  CHECK(next_realizations(8, std::vector{error_of(0.0012)}, 100) == 12);  // 8 x 1.44 = 11.52
  CHECK(next_realizations(8, std::vector{error_of(0.001000001)}, 100) == 9);
  CHECK(next_realizations(8, std::vector{error_of(1)}, 100) == 16);
  CHECK(next_realizations(8, std::vector{error_of(0.0012), error_of(0.0013)}, 100) == 14);
}

TEST_CASE("Fewer than two realizations decide nothing, so they double") {
  CHECK(next_realizations(1, std::vector{error_of(std::numeric_limits<double>::quiet_NaN())},
                          100) == 2);
}

TEST_CASE("A sigma that is too large asks for a quarter more") {
  const SpreadFound sigma{.spread = Spread::sigma, .value = 0.01, .at_most = 0.001};
  CHECK(next_realizations(8, std::vector{sigma}, 100) == 10);
  CHECK(next_realizations(1, std::vector{sigma}, 100) == 2);
}

TEST_CASE("The limit ends it, wherever it is") {
  CHECK(next_realizations(8, std::vector{error_of(1)}, 10) == 10);
  CHECK(next_realizations(10, std::vector{error_of(1)}, 10) == 10);
  CHECK(next_realizations(12, std::vector{error_of(1)}, 10) == 12);
}

}  // namespace jostle
