#include "ensemble/analysis/ageing/tap_rows.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

namespace jostle {

TEST_CASE("Chosen taps are those rows of a series, as far as it goes") {
  const std::vector<double> series = {0, 1, 10, 11, 20, 21};
  const TapRows rows = choose_taps(series, 2, std::vector<std::uint64_t>{0, 2, 3});
  CHECK(rows.taps == std::vector<std::uint64_t>{0, 2});
  CHECK(rows.values == std::vector<double>{0, 1, 20, 21});
  CHECK(rows.row(2)[1] == 21);
  CHECK(rows.row(1).empty());
  CHECK(rows.row(3).empty());
}

TEST_CASE("Logarithmic taps are whole, ascend, and keep both ends") {
  for (const std::uint64_t last : {1, 2, 9, 1000, 54321}) {
    const std::vector<std::uint64_t> taps = logarithmic_taps(1, last, 10);
    CHECK(taps.front() == 1);
    CHECK(taps.back() == last);
    CHECK(std::ranges::is_sorted(taps, std::ranges::less_equal{}));
  }
  CHECK(logarithmic_taps(10, 1000, 1) == std::vector<std::uint64_t>{10, 100, 1000});
  // Above 100 taps nothing is rounded together: ten per decade.
  const std::vector<std::uint64_t> taps = logarithmic_taps(100, 100000, 10);
  CHECK(taps.size() == 31);
  for (std::size_t i = 1; i < taps.size(); ++i) {
    const double ratio = static_cast<double>(taps[i]) / static_cast<double>(taps[i - 1]);
    CHECK(ratio == Approx(std::pow(10, 0.1)).epsilon(0.01));
  }
}

}  // namespace jostle
