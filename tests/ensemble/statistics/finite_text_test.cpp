#include "ensemble/statistics/finite_text.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace jostle;

TEST_CASE("A text is formatted where all of its numbers are finite") {
  CHECK(finite_text("a change of {:.2g} over {} taps ({})", 0.0123, 40, "p = 0.3") ==
        "a change of 0.012 over 40 taps (p = 0.3)");
  CHECK(finite_text("{}", std::string("inf")) == "inf");  // a word of somebody else
}

TEST_CASE("No text has a number that is not finite") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {infinity, -infinity, nan, -nan}) {
    CHECK(finite_text("{:.2g} times the scatter", value) == not_stated);
    CHECK(finite_text("{} of {:.3f}", 1.0, static_cast<float>(value)) == not_stated);
  }
}
