#pragma once

#include <cstddef>
#include <vector>

namespace jostle::inline fitting {

/// Wald-Wolfowitz test: whether the signs of residuals in order of t change as often as they would
/// if they were independent.
struct RunsTest {
  std::size_t runs = 0;
  double expected = 0;
  double z = 0;  // deviation in standard errors; negative where residuals are correlated
  double p = 1;  // p-value of |z|; 1 where all signs are alike and there is no test
};
RunsTest runs_test(const std::vector<double>& residuals);

/// How many independent points are worth as much as these residuals in order of t: n / (1 + 2 times
/// the sum of autocorrelations), the sum ended where a pair of neighbouring ones is no longer
/// positive (Geyer 1992). In [1, n]; n where they are independent, or all zero.
double effective_sample_size(const std::vector<double>& residuals);

}  // namespace jostle::inline fitting
