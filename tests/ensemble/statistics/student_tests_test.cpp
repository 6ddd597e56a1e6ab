#include "ensemble/statistics/student_tests.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "fitting/intervals/distributions.hpp"

using namespace jostle;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("p-values are those of Student's t and of a normal variable") {
  // Area of a loop, two realizations: eleven times its error.
  CHECK(p_value(11, {1, 1}) == Approx(0.0577).epsilon(1e-3));
  CHECK(p_value(-2.2281388520, {1, 10}) == Approx(0.05).epsilon(1e-9));
  CHECK(p_value(1.959963985, {1, infinite}) == Approx(0.05).epsilon(1e-8));
  CHECK(p_value(0, {0, 3}) == 1);
  CHECK(std::isnan(p_value(1, {0, 3})));
  CHECK(std::isnan(p_value(1, {})));
}

TEST_CASE("The power of Student's test is the tail of the noncentral t distribution") {
  // From the level where there is no effect, to certainty.
  for (const double dof : {1.0, 2.5, 30.0, 100.0, 1e3, 1e4, 1e6, 9e6, infinite}) {
    CAPTURE(dof);
    CHECK(student_power(0, 0.05, dof) == Approx(0.05).epsilon(1e-6));
    CHECK(student_power(1000, 0.05, dof) == Approx(1).epsilon(1e-6));
    const double effect = smallest_effect_found(0.01, dof);
    CHECK(student_power(effect, 0.01, dof) == Approx(0.8).epsilon(1e-4));
    CHECK(student_power(-effect, 0.01, dof) == Approx(0.8).epsilon(1e-4));
  }
  // Normal: the quantiles of 0.975 and 0.8 added up.
  CHECK(smallest_effect_found(0.05, infinite) == Approx(1.959964 + 0.841621).epsilon(1e-5));
  // Nearly normal, first in 1 / dof.
  const double normal = smallest_effect_found(0.05, infinite);
  for (const double dof : {1e3, 1e4, 1e5, 1e6}) {
    CAPTURE(dof);
    CHECK(smallest_effect_found(0.05, dof) - normal < 4 / dof);
    CHECK(smallest_effect_found(0.05, dof) > normal - 1e-5);
  }
  // One degree of freedom: |N| below effect / 12.706 with probability 0.8 for a large effect.
  CHECK(smallest_effect_found(0.05, 1) == Approx(12.7062 * 1.281552).epsilon(0.01));
}

TEST_CASE("Errors of sums have the degrees of freedom of Satterthwaite and Welch") {
  const ErrorOf pair = combined({3, 4}, {4, 9});
  CHECK(pair.error == 5);
  CHECK(pair.dof == Approx(625 / (81.0 / 4 + 256.0 / 9)).epsilon(1e-14));
  CHECK(combined({3, 4}, {0, 9}).dof == Approx(4));
  CHECK(combined({1, 4}, {1, infinite}).dof == Approx(16));
  CHECK_FALSE(combined({1, 4}, {}).known());
}

TEST_CASE("Holm's p-values for several tests") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> corrected =
      corrected_for_number(std::vector{0.01, none, 0.04, 0.03, 0.005});
  CHECK(corrected[4] == Approx(0.02));
  CHECK(corrected[0] == Approx(0.03));
  CHECK(corrected[3] == Approx(0.06));
  CHECK(corrected[2] == Approx(0.06));
  CHECK(std::isnan(corrected[1]));
}

TEST_CASE("Fisher's F of one degree of freedom is the square of Student's t") {
  for (const double t : {0.1, 1.0, 5.0}) {
    CHECK(fisher_tail(t * t, 1, 7) == Approx(student_tails(t, 7)).epsilon(1e-12));
  }
  // F(2, n): (1 + 2 f / n)^(-n / 2).
  CHECK(fisher_tail(3, 2, 8) == Approx(std::pow(1 + 6.0 / 8, -4)).epsilon(1e-12));
}
