#include "ensemble/statistics/student_tests.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <vector>

#include "fitting/fit.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle {

TEST_CASE("Ends of an interval are where a straight t crosses Student's") {
  std::vector<double> values;
  for (int i = -50; i <= 50; ++i) values.push_back(0.1 * i);
  const auto t_of = [](double value) { return (value - 0.33) / 0.5; };
  const TestedEnds ends = tested_ends(values, 0.33, 9, t_of);
  for (const int level : {0, 1}) {
    const double reach = 0.5 * student_two_sided(interval_levels[level], 9);
    CHECK(ends.low[level] == Approx(0.33 - reach));
    CHECK(ends.high[level] == Approx(0.33 + reach));
  }
  // A side on which nothing is refuted is open.
  const TestedEnds open =
      tested_ends(values, 0.33, 9, [&](double value) { return value > 0.33 ? 0 : t_of(value); });
  CHECK(open.high[1] == std::numeric_limits<double>::infinity());
  CHECK(open.low[1] == ends.low[1]);
}

TEST_CASE("A search that ended at its last value leaves the interval open there") {
  std::vector<double> values;
  for (int i = -50; i <= 0; ++i) values.push_back(0.1 * i);
  const double last = values.back() - 1e-15;
  // The best value of all would be 0.1: t at the last one is 0.2.
  const auto t_of = [](double value) { return (value - 0.1) / 0.5; };
  const TestedEnds ends = tested_ends(values, last, 9, t_of);
  for (const int level : {0, 1}) {
    CHECK(ends.low[level] == Approx(0.1 - 0.5 * student_two_sided(interval_levels[level], 9)));
    CHECK(ends.high[level] == std::numeric_limits<double>::infinity());
  }
  // At 68 % the last value is refuted itself, at 95 % it is not.
  const TestedEnds refuted = tested_ends(values, last, 9, [&](double v) { return t_of(v) - 1; });
  CHECK(refuted.low[0] == -std::numeric_limits<double>::infinity());
  CHECK(refuted.low[1] == Approx(0.6 - 0.5 * student_two_sided(interval_levels[1], 9)));
  CHECK(refuted.high[0] == std::numeric_limits<double>::infinity());
}

}  // namespace jostle
