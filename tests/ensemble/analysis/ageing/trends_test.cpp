#include "ensemble/analysis/ageing/trends.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "ensemble/analysis/ageing/log_curves.hpp"

namespace jostle {
namespace {

const TestedChange words{"A", "A changes", "no change of A found"};

// The test of a logarithm with this error, from three realizations.
AgeTrend tested(double logarithm, double error) {
  LogCurves curves;
  curves.influences.resize(1, 3);
  curves.influences << -1, 0, 1;
  curves.influences *= error * std::sqrt(3.0);  // the sum of squares over 3 x 2 is its square
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(1);
  return tested_change(curves, weights, logarithm * weights, words);
}

}  // namespace

TEST_CASE("A small p does not count where the uncertainty is too large to detect any change") {
  const AgeTrend found = tested(100, 10);
  CHECK(found.p < 0.05);
  CHECK(std::isnan(found.detectable));
  CHECK(found.verdict ==
        "cannot decide with 3 realizations (change of A from the first waiting time to the last: "
        "p = 0.0099 at the 5 % level, which does not count because the uncertainty is too large "
        "to detect any change)");
  CHECK(tested(10, 10).verdict.find("does not count") == std::string::npos);
  CHECK(tested(10, 0.1).verdict.starts_with("A changes"));
}

TEST_CASE("A change without an error is neither found nor excluded") {
  const AgeTrend found = tested(2, 0);
  CHECK(std::isnan(found.p));
  CHECK(std::isnan(found.detectable));
  CHECK(found.verdict ==
        "cannot decide with 3 realizations (change of A from the first waiting time to the last: "
        "no test, its error is not known)");
}

TEST_CASE("Two tests that contradict each other decide nothing, and both are named") {
  const AgeTrend rejects = tested(2, 0.1), accepts = tested(0.05, 0.1);
  const AgeTrend found = agreed(rejects, accepts, 3, words);
  CHECK(found.p == accepts.p);
  CHECK(found.verdict.starts_with("cannot decide with 3 realizations"));
  CHECK(found.verdict.ends_with(
      "; only one of the two tests rejects the null hypothesis of no change, p = 0.0025"));
  CHECK(agreed(accepts, accepts, 3, words).verdict.find("rejects") == std::string::npos);
  CHECK(agreed(rejects, rejects, 3, words).verdict.starts_with("A changes"));
}

}  // namespace jostle
