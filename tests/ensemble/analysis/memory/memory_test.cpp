#include "ensemble/analysis/memory/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "tests/ensemble/synthetic_series.hpp"

using namespace jostle;

namespace {

struct Setting {
  std::size_t realizations;
  double rho;     // memory of what is added to the response from lag to lag
  double shared;  // part of it that matched streams share
};

constexpr double typical = 0.02;  // deviation of the noise after the switch
const std::vector<LagWindow> windows = lag_windows(100);

/// Phi approaches 1, the faster the farther it is, alike for all histories but for `offset` of the
/// second, which fades with the lag; at the switch histories are off by a little.
std::vector<History> histories(const Setting& setting, double offset, std::uint64_t seed) {
  const std::size_t m = setting.realizations;
  std::vector<History> all(3);
  std::vector<std::vector<double>> common;
  for (std::size_t r = 0; r < m; ++r)
    common.push_back(synthetic::autoregressive(setting.rho, 101, seed, 100 + r));
  for (std::size_t i = 0; i < 3; ++i) {
    History& history = all[i];
    history.responses.assign(windows.size() * m, 0);
    synthetic::Gaussian gaussian(seed, i);
    for (std::size_t r = 0; r < m; ++r) {
      const double x = 0.01 * static_cast<double>(i) + 0.1 * gaussian();
      history.at_switch.push_back(x);
      const std::vector<double> own =
          synthetic::autoregressive(setting.rho, 101, seed, 1000 + 100 * i + r);
      const double scale = typical * std::sqrt(1 - setting.rho * setting.rho);
      for (std::size_t w = 0; w < windows.size(); ++w) {
        double sum = 0;
        for (std::uint64_t lag = windows[w].first; lag <= windows[w].last; ++lag) {
          const double fade = std::exp(-static_cast<double>(lag) / 30);
          const double noise = setting.shared * common[r][lag] + (1 - setting.shared) * own[lag];
          sum += 1 - (1 - x) * fade + scale * noise + (i == 1 ? offset * fade : 0);
        }
        history.responses[w * m + r] =
            sum / static_cast<double>(windows[w].last + 1 - windows[w].first);
      }
    }
  }
  return all;
}

}  // namespace

TEST_CASE("Windows of lags are two per decade and end at the last") {
  const auto ends = [](const std::vector<LagWindow>& all) {
    std::vector<std::uint64_t> last;
    for (const LagWindow& window : all) last.push_back(window.last);
    return last;
  };
  CHECK(ends(lag_windows(1)) == std::vector<std::uint64_t>{1});
  CHECK(ends(lag_windows(100)) == std::vector<std::uint64_t>{1, 3, 10, 30, 100});
  CHECK(ends(lag_windows(25)) == std::vector<std::uint64_t>{1, 3, 10, 25});
  CHECK(lag_windows(100)[3].first == 11);
}

TEST_CASE("Histories are compared at equal values at the switch") {
  // After the switch 2 x + 1 exactly: what differs is the value at the switch alone.
  std::vector<History> all = {{0.1, 10, {0.50, 0.52, 0.57}, {}}, {0.2, 20, {0.60, 0.61, 0.64}, {}}};
  for (History& history : all) {
    for (const double x : history.at_switch) history.responses.push_back(2 * x + 1);
  }
  const MemoryTest equal_test = memory_test(all, lag_windows(1));
  REQUIRE(equal_test.differences.size() == 1);
  CHECK(std::abs(equal_test.differences[0].value) < 1e-12);
  for (double& response : all[1].responses) response += 0.125;
  const MemoryTest shifted = memory_test(all, lag_windows(1));
  CHECK(shifted.differences[0].value == Approx(0.125).epsilon(1e-10));
  CHECK(shifted.differences[0].error.dof == 1);
  CHECK(
      shifted.statement("phi", "1", "dilate")
          .starts_with("phi alone is not the state: after dilate 0.1 and 0.2 responses differ by"));
  const std::string in_diameters = shifted.statement("height", "d", "dilate");
  CHECK(in_diameters.find("responses differ by +0.125 +- ") != std::string::npos);
  CHECK(in_diameters.find(" d (68 %) at lags 1 to 1 taps (p ") != std::string::npos);
  CHECK(shifted.statement("phi", "1", "dilate").find(" 1 (68 %)") == std::string::npos);
  // One strength reached in two ways: by number.
  all[1].strength = 0.1;
  CHECK(memory_test(all, lag_windows(1))
            .statement("phi", "1", "dilate")
            .starts_with(
                "phi alone is not the state: after dilate 0.1 (number 0) and 0.1 (number 1) "));
}

TEST_CASE("Differences and their errors are those of a straight line, sum by sum") {
  const std::size_t m = 7;
  const std::vector<History> all = histories({m, 0.9, 0.5}, 0.03, 11);
  for (const AlignedDifference& found : memory_test(all, windows).differences) {
    const History &first = all[found.first], &second = all[found.second];
    double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    for (std::size_t r = 0; r < m; ++r) {
      const double x = second.at_switch[r] - first.at_switch[r];
      const double y =
          second.responses[found.window * m + r] - first.responses[found.window * m + r] - x;
      sx += x;
      sy += y;
      sxx += x * x;
      sxy += x * y;
      syy += y * y;
    }
    const auto n = static_cast<double>(m);
    const double determinant = n * sxx - sx * sx;
    const double slope = (n * sxy - sx * sy) / determinant;
    const double value = (sy - slope * sx) / n;
    const double residual_sum = syy - value * sy - slope * sxy;
    CHECK(found.value == Approx(value).epsilon(1e-9));
    CHECK(found.error.error ==
          Approx(std::sqrt(residual_sum / (n - 2) * sxx / determinant)).epsilon(1e-6));
    CHECK(found.error.dof == n - 2);
  }
}

TEST_CASE("Histories that differ by the same amount in every realization cannot be compared") {
  std::vector<History> all = {{0.1, 10, {0.5, 0.5, 0.5}, {1, 1, 1}},
                              {0.2, 20, {0.6, 0.6, 0.6}, {1, 1, 1}}};
  const std::string still = memory_test(all, lag_windows(1)).statement("phi", "1", "dilate");
  CHECK(still ==
        "cannot decide: phi at the switch differs by the same amount in every realization between "
        "dilate 0.1 and 0.2, so that the difference at equal value has no error");
  // Beside a pair that can be compared.
  all.push_back({0.3, 5, {0.61, 0.58, 0.62}, {1.1, 1.3, 1.25}});
  const std::string mixed = memory_test(all, lag_windows(1)).statement("phi", "1", "dilate");
  CHECK(mixed.starts_with("cannot decide: phi at the switch differs by the same amount"));
}

TEST_CASE("Tables name histories by their strengths") {
  const std::vector<History> all = {{0.1, 10, {0.50, 0.52, 0.57}, {2, 2, 3}},
                                    {0.2, 20, {0.60, 0.61, 0.64}, {3, 3, 1}}};
  const Table table = memory_table("", {"phi", "1", "fraction", ""}, "dilate", "1", all,
                                   memory_test(all, lag_windows(1)));
  const auto column = [&](const std::string& name) {
    const auto found = std::ranges::find(table.quantities, name, &Quantity::name);
    REQUIRE(found != table.quantities.end());
    return std::get<std::vector<double>>(found->values);
  };
  CHECK(column("first_dilate") == std::vector{0.1});
  CHECK(column("second_dilate") == std::vector{0.2});
}

TEST_CASE("An observable that never changes has no test of memory") {
  std::vector<History> histories;
  for (const double strength : {0.1, 0.2})
    histories.push_back({strength, 0, std::vector<double>(4, 0.5), std::vector<double>(8, 0.5)});
  const std::uint64_t ends[] = {1, 10};
  const MemoryTest test = memory_test(histories, lag_windows(ends));
  CHECK(test.statement("x", "1", "gamma") ==
        "cannot decide: x does not change after the switch of gamma");
}

TEST_CASE("Two realizations cannot test memory") {
  std::vector<History> all = {{0.1, 10, {0.5, 0.6}, {1, 2}}, {0.2, 20, {0.5, 0.61}, {3, 5}}};
  CHECK(memory_test(all, lag_windows(1))
            .statement("phi", "1", "dilate")
            .starts_with("cannot decide"));
}

namespace {

void check_rates(const std::vector<std::size_t>& all_realizations) {
  constexpr std::size_t ensembles = 200;
  const auto deviation = [](double share) {
    return std::sqrt(share * (1 - share) / static_cast<double>(ensembles));
  };
  fmt::print("{:>3} {:>5} {:>6} | false alarms  no memory | detectable  found  \"no memory\"\n",
             "M", "rho", "shared");
  for (const std::size_t m : all_realizations) {
    for (const auto& [rho, shared] : {std::pair{0.0, 0.0}, {0.9, 0.5}, {0.99, 0.9}}) {
      const Setting setting{m, rho, shared};
      std::size_t alarms = 0, none = 0, found = 0, missed = 0;
      double detectable = 0;
      for (std::size_t e = 0; e < ensembles; ++e) {
        const std::uint64_t seed = 20003632 + e;
        const MemoryTest still = memory_test(histories(setting, 0, seed), windows);
        const std::string statement = still.statement("phi", "1", "dilate");
        alarms += statement.starts_with("phi alone is not");
        none += statement.starts_with("no memory");
        const double size = still.detectable();
        detectable += size / ensembles;
        // The offset fades: as large at the first lag, and seen by pairs 0-1 and 1-2.
        const std::string text_with =
            memory_test(histories(setting, size * std::exp(1.0 / 30), seed), windows)
                .statement("phi", "1", "dilate");
        found += text_with.starts_with("phi alone is not");
        missed += text_with.starts_with("no memory");
      }
      const auto percent = [&](std::size_t n) {
        return 100.0 * static_cast<double>(n) / ensembles;
      };
      fmt::print("{:>3} {:>5} {:>6} | {:11.1f}% {:9.1f}% | {:10.3g} {:5.1f}% {:10.1f}%\n", m, rho,
                 shared, percent(alarms), percent(none), detectable, percent(found),
                 percent(missed));
      CAPTURE(m, rho, shared);
      CHECK(percent(alarms) <= 100 * (MemoryTest::level + 3 * deviation(MemoryTest::level)));
      CHECK(percent(found) >= 100 * (0.8 - 3 * deviation(0.8)));
      CHECK(percent(missed) <= 100 * (0.2 + 3 * deviation(0.2)));
    }
  }
  std::fflush(stdout);
}

}  // namespace

TEST_CASE("Memory that is not there is seldom found, and what is detectable is found",
          "[statistics]") {
  check_rates({4});
}

TEST_CASE("Memory is found at the stated rate, 3 to 20 realizations", "[slow]") {
  check_rates({3, 10, 20});
}
