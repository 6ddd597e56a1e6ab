#include "ensemble/analysis/hysteresis.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string_view>

#include "tests/ensemble/noise.hpp"

namespace jostle {
namespace {

const Column fraction = {"bulk_fraction", "1", "bulk packing fraction", "somebody 2001"};

const Quantity& quantity(const Table& table, std::string_view name) {
  for (const Quantity& found : table.quantities) {
    if (found.name == name) return found;
  }
  FAIL("no quantity " << name);
  return table.quantities.front();
}

const std::vector<double>& numbers(const Table& table, std::string_view name) {
  return std::get<std::vector<double>>(quantity(table, name).values);
}

std::vector<Stage> dilations(const std::vector<double>& roots, std::uint64_t count) {
  std::vector<Stage> protocol;
  for (const double root : roots) protocol.push_back({Dilate{root * root}, count});
  return protocol;
}

}  // namespace

TEST_CASE("Branches end where the strength turns, and share the step at the turn") {
  using Branches = std::vector<std::vector<std::size_t>>;
  CHECK(branches({}) == Branches{});
  CHECK(branches(std::vector{1.0}) == Branches{{0}});
  CHECK(branches(std::vector{1.0, 2.0, 4.0}) == Branches{{0, 1, 2}});
  CHECK(branches(std::vector{1.0, 2.0, 3.0, 2.0, 1.0, 2.0}) ==
        Branches{{0, 1, 2}, {2, 3, 4}, {4, 5}});
  // A ramp up to 2 and another down from it: each has a step of its own at the turn.
  CHECK(branches(std::vector{1.0, 1.0, 2.0, 2.0, 1.0}) == Branches{{0, 1, 2}, {3, 4}});
  CHECK(branches(std::vector{1.0, 2.0, 2.0, 1.0, 1.0, 2.0}) == Branches{{0, 1}, {2, 3}, {4, 5}});
  CHECK(branches(std::vector{3.0, 1.0, 1.0, 0.5}) == Branches{{0, 1, 2, 3}});
}

TEST_CASE("The area of a loop is that between straight lines, for each realization") {
  const std::vector<double> strengths = {0, 1, 2, 3, 2, 1, 0};
  std::vector<double> values;
  const std::vector<double> sizes = {1, 2, 6};
  for (std::size_t step = 0; step < strengths.size(); ++step) {
    for (const double size : sizes) values.push_back(step > 3 ? size : 0);
  }
  const std::vector<Loop> found = loops(strengths, values, 3);
  REQUIRE(found.size() == 1);
  // A triangle from 3 to 2, then two squares; the jackknife of a mean of three.
  CHECK(found[0].area == Approx(2.5 * 3).epsilon(1e-14));
  CHECK(found[0].error.error == Approx(2.5 * std::sqrt(7.0 / 3)).epsilon(1e-14));
  CHECK(found[0].error.dof == 2);
  CHECK(found[0].lowest == 0);
  CHECK(found[0].highest == 3);
  CHECK(found[0].realizations == 3);
}

TEST_CASE("Branches on one line enclose nothing, whatever their steps") {
  const std::vector<double> strengths = {0, 1, 4, 2.5, 1.5, 1.75, 6};
  std::vector<double> values;
  for (const double x : strengths) values.push_back(2 * x + 1);
  const std::vector<Loop> found = loops(strengths, values, 1);
  REQUIRE(found.size() == 2);
  CHECK(found[0].lowest == 1.5);
  CHECK(found[0].highest == 4);
  CHECK(found[1].highest == 4);
  for (const Loop& loop : found) {
    CHECK(std::abs(loop.area) < 1e-14);
    CHECK_FALSE(loop.error.known());
    CHECK(loop.statement().starts_with("cannot decide with 1 realization: "));
  }
}

TEST_CASE("Branches of equal values are equal, in words without a number") {
  const Loop found = loops(std::vector{1.0, 2.0, 1.0}, std::vector<double>(6, 0.5), 2).at(0);
  CHECK(found.statement() == "the branches are equal in every realization, 2 realizations");
}

TEST_CASE("An area without scatter has no p-value") {
  const std::vector<double> strengths = {1, 2, 1}, values = {0, 0, 1, 1, 2, 2};
  const Loop found = loops(strengths, values, 2).at(0);
  CHECK(std::isnan(found.p));
  CHECK(found.detectable == std::numeric_limits<double>::infinity());
  CHECK(found.statement() ==
        "cannot decide with 2 realizations: the area is +1 in each, and without scatter it has no "
        "error");
}

TEST_CASE("Two realizations cannot decide on an area of eleven errors") {
  const std::vector<double> strengths = {1, 2, 1};
  const std::vector<double> values = {0, 0, 1, 1, 2, 2.4};
  const Loop found = loops(strengths, values, 2).at(0);
  CHECK(found.area / found.error.error == Approx(11));
  CHECK(found.p == Approx(0.0577).epsilon(1e-3));
  CHECK(found.statement().starts_with(
      "cannot decide with 2 realizations: p = 0.058 at the 5 % level, only"));
  CHECK(found.detectable == Approx(16.334 * found.error.error).epsilon(1e-3));
  const Loop clear = loops(strengths, std::vector{0.0, 0.0, 1.0, 1.0, 2.0, 2.1}, 2).at(0);
  CHECK(clear.statement().starts_with("the branches differ"));
}

TEST_CASE("Branches that do not differ are called different at the level of the test",
          "[statistics]") {
  for (const std::uint32_t realizations : {2, 3, 10}) {
    constexpr int ensembles = 1000;
    RandomStream random = test_stream(20261124 + realizations);
    int different = 0;
    for (int e = 0; e < ensembles; ++e) {
      std::vector<double> values;
      for (std::uint32_t i = 0; i < 5 * realizations; ++i) values.push_back(noise(random));
      bool any = false;
      for (const Loop& loop : loops(std::vector{1.0, 2.0, 1.0, 2.0, 1.0}, values, realizations)) {
        any = any || loop.corrected < Loop::level;
      }
      different += any;
    }
    CAPTURE(realizations, different);
    // The limit is 3 deviations of 5 %.
    CHECK(different <= 0.05 * ensembles + 3 * std::sqrt(0.05 * 0.95 * ensembles));
  }
}

TEST_CASE("Realizations that miss a step of a branch are no part of its loops") {
  const std::vector<double> strengths = {1, 2, 1, 2};
  const std::vector<double> values = {0, 0, 0, 0, 1, 3, 0.8, std::nan("")};
  const std::vector<Loop> found = loops(strengths, values, 2);
  CHECK(found[0].realizations == 2);
  CHECK(found[0].area == Approx(1));
  CHECK(found[1].realizations == 1);
  CHECK(found[1].area == Approx(0.4));
}

TEST_CASE("A protocol's steps are its stages, with their last taps") {
  auto protocol = dilations({0.1, 0.2, 0.1}, 100);
  protocol[1].count = 20;
  const auto steps = std::get<ProtocolSteps>(protocol_steps(protocol, 30));
  CHECK(steps.control == "sqrt_epsilon");
  CHECK(steps.strengths[1] == Approx(0.2).epsilon(1e-15));
  CHECK(steps.windows == std::vector<StepTaps>{{71, 100}, {101, 120}, {191, 220}});
  CHECK(std::get<std::string>(protocol_steps(dilations({0.1, 0.1}, 5), 5))
            .starts_with("The protocol has taps of one strength only"));
  protocol.push_back({Lift{0.25}, 10});
  CHECK(std::get<std::string>(protocol_steps(protocol, 30)) ==
        "The protocol taps in different ways (sqrt_epsilon, gamma), whose strengths cannot be "
        "compared: use one kind of tap.");
}

TEST_CASE("Step values are means of the windows, and absent beyond the series") {
  const auto steps = std::get<ProtocolSteps>(protocol_steps(dilations({0.1, 0.2}, 2), 2));
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> whole = {9, 9, 1, 10, 3, 20, 5, none, 7, 30};
  const std::vector<double> values = step_values(steps, whole, 2);
  CHECK(values[0] == 2);
  CHECK(values[1] == 15);
  CHECK(values[2] == 6);
  CHECK(std::isnan(values[3]));
  const std::vector<double> shorter(whole.begin(), whole.end() - 2);
  CHECK(std::isnan(step_values(steps, shorter, 2)[2]));
}

TEST_CASE("A table of hysteresis holds values, branches and loops", "[statistics]") {
  // Up, down, up: the way up begins 0.1 lower, and the rest is reversible.
  const std::vector<double> roots = {0.1, 0.2, 0.3, 0.2, 0.1, 0.2, 0.3};
  const auto steps = std::get<ProtocolSteps>(protocol_steps(dilations(roots, 10), 5));
  const std::uint32_t realizations = 50;
  RandomStream random = test_stream(1);
  std::vector<double> series(realizations, 0.5);
  for (std::size_t step = 0; step < roots.size(); ++step) {
    for (int tap = 0; tap < 10; ++tap) {
      for (std::uint32_t r = 0; r < realizations; ++r) {
        const double level = 0.6 - 0.2 * roots[step] - (step < 2 ? 0.1 : 0);
        series.push_back(level + 0.01 * noise(random));
      }
    }
  }
  const Table table = hysteresis_table("hysteresis/bulk_fraction", fraction, steps,
                                       step_values(steps, series, realizations), realizations);
  CHECK(std::get<std::vector<std::uint64_t>>(quantity(table, "branch").values) ==
        std::vector<std::uint64_t>{0, 0, 0, 1, 1, 2, 2});
  const std::vector<double>&value = numbers(table, "bulk_fraction"),
        &error = numbers(table, "bulk_fraction_error");
  for (std::size_t step = 0; step < roots.size(); ++step) {
    const double level = 0.6 - 0.2 * roots[step] - (step < 2 ? 0.1 : 0);
    CHECK(std::abs(value[step] - level) <= 3 * error[step]);
    // 5 taps of 50 realizations; the error's own error is 1/sqrt(2 * 49) = 10 %.
    CHECK(error[step] == Approx(0.01 / std::sqrt(250.0)).epsilon(0.35));
  }
  const std::vector<double>&area = numbers(table, "area"),
        &area_error = numbers(table, "area_error");
  // 0.1 at strengths 0.1 and 0.2, 0 at 0.3: 0.01 + 0.005.
  CHECK(std::abs(area[0] - 0.015) <= 3 * area_error[0]);
  CHECK(area[0] > 10 * area_error[0]);
  CHECK(std::abs(area[1]) <= 3 * area_error[1]);
}

TEST_CASE("Without a turn there is no loop") {
  const auto steps = std::get<ProtocolSteps>(protocol_steps(dilations({0.1, 0.2}, 2), 2));
  const Table table =
      hysteresis_table("hysteresis", fraction, steps, std::vector<double>{1, 2, 3, 4}, 2);
  CHECK(table.axes.size() == 1);
  CHECK(table.notes.back().second == "one: the strength does not turn, so there is no loop");
}

}  // namespace jostle
