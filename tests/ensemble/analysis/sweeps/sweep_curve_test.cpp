#include "ensemble/analysis/sweeps/sweep_curve.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "ensemble/moments.hpp"
#include "tests/ensemble/noise.hpp"

namespace jostle {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<ErrorOf> known(const std::vector<double>& errors) {
  std::vector<ErrorOf> all;
  for (const double error : errors) all.push_back({error, infinite});
  return all;
}

const std::vector<double> strengths = {0.05, 0.1, 0.15, 0.2, 0.25, 0.3};

// A bell with its maximum of 0.6 at 0.17.
double bell(double x) {
  return 0.6 - 2 * (x - 0.17) * (x - 0.17);
}

std::vector<std::vector<double>> noisy_bell(std::uint64_t seed, std::size_t realizations,
                                            double spread) {
  RandomStream random = test_stream(seed);
  std::vector<std::vector<double>> values;
  for (const double x : strengths) {
    values.emplace_back();
    for (std::size_t r = 0; r < realizations; ++r) {
      values.back().push_back(bell(x) + spread * noise(random));
    }
  }
  return values;
}

}  // namespace

TEST_CASE("Realizations that do not differ prove no extremum and no difference") {
  // Layers that have grown, in two realizations, against the strength.
  const std::vector<std::vector<double>> layers = {{5, 5}, {2, 2}, {1, 1}, {1, 1}, {1, 1}};
  const std::vector<double> x = {0.05, 0.1, 0.15, 0.2, 0.25};
  for (const Streams streams : {Streams::matched, Streams::independent}) {
    const SweepCurve curve(x, layers, streams);
    CHECK(maximum(curve, 5).verdict.starts_with("none found: the largest value is at an end"));
    CHECK(std::isnan(minimum(curve, 5).p));
    CHECK(minimum(curve, 5).verdict.starts_with("cannot decide"));
    const std::vector<SweepDifference> found = differences(curve, std::nullopt);
    CHECK(std::isnan(found[0].corrected));
    CHECK(found[2].corrected == 1);
    // The line's errors come from the scatter about it.
    const StraightLine line = straight_line(curve);
    CHECK(line.slope == Approx(-18));
    CHECK(line.slope_error.error == Approx(std::sqrt(3.9 / 3 / 0.025)));
    CHECK(line.slope_error.dof == 3);
    CHECK(std::isnan(line.p));
  }
}

TEST_CASE("The maximum of a parabola is found exactly, its points in any order") {
  std::vector<double> x = {0.3, 0.05, 0.1, 0.2, 0.15, 0.24}, y;
  for (const double abscissa : x) y.push_back(bell(abscissa));
  x.push_back(0.12);
  y.push_back(none);  // dropped
  const SweepCurve curve(x, y, known(std::vector<double>(x.size(), 1e-6)));
  CHECK(curve.n_points() == 6);
  for (const std::size_t points : {3, 5, 50}) {
    const SweepExtremum top = maximum(curve, points);
    CHECK(top.points == std::min<std::size_t>(points, 6));
    CHECK(top.x == Approx(0.17).epsilon(1e-11));
    CHECK(top.y == Approx(0.6).epsilon(1e-13));
    CHECK(top.p < 1e-9);
    CHECK(top.verdict.starts_with("found inside the sweep"));
  }
}

TEST_CASE("With matched streams, what shifts a packing at all points leaves its maximum") {
  std::vector<std::vector<double>> values;
  for (const double x : strengths) {
    values.emplace_back();
    for (const double shift : {-0.02, 0.01, 0.03, -0.01}) values.back().push_back(bell(x) + shift);
  }
  const SweepExtremum matched = maximum(SweepCurve(strengths, values, Streams::matched));
  CHECK(matched.x == Approx(0.17).epsilon(1e-10));
  // Without noise the highest point is known, and the maximum lies between its neighbours.
  std::vector<double> heights;
  for (const double x : strengths) heights.push_back(bell(x));
  const auto top = std::ranges::max_element(heights) - heights.begin();
  CHECK(matched.x_low == strengths[static_cast<std::size_t>(top - 1)]);
  CHECK(matched.x_high == strengths[static_cast<std::size_t>(top + 1)]);
  const SweepExtremum independent = maximum(SweepCurve(strengths, values, Streams::independent));
  CHECK_FALSE(independent.found());
  CHECK(independent.verdict.starts_with("cannot decide with 4 realizations: "));
  CHECK(std::isnan(independent.x_low));
}

TEST_CASE("A point with one realization has the error that is pooled over the others") {
  auto values = noisy_bell(11, 8, 0.002);
  values.front().resize(1);
  const SweepCurve curve(strengths, values, Streams::independent);
  CHECK(curve.pooled().dof == 5 * 7);
  CHECK_FALSE(curve.error().front().known());
  CHECK(straight_line(curve).slope_error.dof == 35);
  // One packing alone is common to all points of matched streams: nothing is known of its scatter.
  const SweepExtremum extremum = maximum(SweepCurve(strengths, values, Streams::matched), 6);
  CHECK(std::isfinite(extremum.x));
  CHECK(std::isnan(extremum.p));
  for (auto& realizations : values) realizations.resize(1);
  const SweepCurve lone(strengths, values, Streams::independent);
  CHECK(maximum(lone).verdict == "cannot decide: there are no errors to test a maximum by");
  CHECK(straight_line(lone).slope_error.dof == 4);  // from the scatter about the line
}

TEST_CASE("No point counts more because its realizations agree by accident") {
  auto values = noisy_bell(12, 2, 0.002);
  values[0][1] = values[0][0] + 1e-12;
  const SweepCurve curve(strengths, values, Streams::independent);
  CHECK(curve.weights() == std::vector<double>(6, std::sqrt(2.0)));
  const ErrorOf first = curve.error_of(std::vector<double>{1, 0, 0, 0, 0, 0});
  CHECK(first.error > 1e-4);
  CHECK(first.dof == 6);
}

TEST_CASE("A maximum whose place may be the sweep's end is marked") {
  const auto verdict = [](double last) {
    std::vector<std::vector<double>> values;
    for (const double y : {0.0, 0.04, last}) {
      std::vector<double>& point = values.emplace_back();
      for (int r = 0; r < 6; ++r) point.push_back(y + (r % 2 == 0 ? 0.0171 : -0.0171));
    }
    return maximum(SweepCurve({0.15, 0.25, 0.4}, values, Streams::independent), 3);
  };
  const SweepExtremum near = verdict(0.02);  // 1.85 errors below the highest point
  CHECK(near.found());
  CHECK(std::isnan(near.x_high));
  CHECK(near.verdict.ends_with("reaches an end of the sweep"));
  const SweepExtremum far = verdict(-0.02);
  CHECK(far.x_high == 0.4);
  CHECK(far.verdict.ends_with("two-lines test)"));
}

TEST_CASE("A curve without a maximum has none") {
  const std::vector<double> x = {1, 2, 3, 4, 5};
  const std::vector<ErrorOf> error = known(std::vector<double>(5, 0.1));
  const SweepExtremum rising = maximum(SweepCurve(x, {1, 2, 3, 4, 5}, error));
  CHECK(std::isnan(rising.x));
  CHECK(std::isnan(rising.x_high));
  CHECK(rising.verdict.starts_with("none found: the largest value is at an end of the sweep"));
  CHECK(rising.verdict.ends_with(")"));
  CHECK(maximum(SweepCurve(x, {3, 2, 1, 1.5, 2}, error)).verdict.ends_with("two-lines test)"));
  const SweepExtremum flat = maximum(SweepCurve(x, {1, 1.01, 1.02, 1.01, 1}, error));
  CHECK(flat.p > 0.1);
  CHECK(flat.verdict.starts_with("cannot decide: no maximum is established, chance alone"));
  CHECK(maximum(SweepCurve({1, 2}, {1, 2}, known({1, 1}))).verdict ==
        "cannot decide: fewer than three different strengths have a value");
  // Inside the sweep or at its end, nothing is tested without errors.
  for (const std::vector<double>& y : {std::vector<double>{1, 2, 3, 2, 1}, {5, 4, 3, 2, 1}}) {
    const SweepExtremum untested = maximum(SweepCurve(x, y, std::vector<ErrorOf>(5)));
    CHECK(std::isnan(untested.p));
    CHECK(untested.verdict == "cannot decide: there are no errors to test a maximum by");
  }
}

TEST_CASE("A minimum is the maximum of the reflected curve, in words of its own") {
  for (const Streams streams : {Streams::independent, Streams::matched}) {
    for (const std::size_t realizations : {3, 12}) {
      const auto bell = noisy_bell(21, realizations, 0.003);
      auto valley = bell;
      for (auto& values : valley) {
        for (double& value : values) value = 1 - value;
      }
      const SweepExtremum top = maximum(SweepCurve(strengths, bell, streams));
      const SweepExtremum bottom = minimum(SweepCurve(strengths, valley, streams));
      REQUIRE(top.found());
      CHECK(bottom.x == Approx(top.x).epsilon(1e-9));
      CHECK(bottom.y == Approx(1 - top.y).epsilon(1e-9));
      CHECK(bottom.p == Approx(top.p).epsilon(1e-6));
      CHECK(bottom.x_low == top.x_low);
      CHECK(bottom.x_high == top.x_high);
      CHECK(bottom.verdict.starts_with("found inside the sweep: the curve falls to it and rises"));
      CHECK_FALSE(maximum(SweepCurve(strengths, valley, streams)).found());
      CHECK_FALSE(minimum(SweepCurve(strengths, bell, streams)).found());
    }
  }
  const std::vector<double> x = {1, 2, 3, 4, 5};
  const std::vector<ErrorOf> error = known(std::vector<double>(5, 0.1));
  CHECK(minimum(SweepCurve(x, {1, 2, 3, 4, 5}, error))
            .verdict.starts_with("none found: the least value is at an end of the sweep"));
  CHECK(minimum(SweepCurve(x, {1, 0.99, 0.98, 0.99, 1}, error))
            .verdict.starts_with(
                "cannot decide: no minimum is established, chance alone often gives one"));
}

TEST_CASE("A curve whose extreme value is at an end has no extremum inside, whatever a parabola") {
  // Values that rise ever faster: a parabola's lowest point is inside.
  const std::vector<double> x = {1, 2, 3, 4, 5};
  const SweepExtremum bottom =
      minimum(SweepCurve(x, {1, 1.01, 1.2, 2, 4}, known(std::vector<double>(5, 0.01))));
  CHECK_FALSE(std::isnan(bottom.x));
  CHECK(bottom.verdict.starts_with("none found: the least value is at an end of the sweep"));
}

TEST_CASE("Errors of few degrees of freedom are pooled, and count points alike") {
  std::vector<ErrorOf> error(5, {0.1, 2});
  error[1].error = 1e-9;
  const SweepCurve curve({1, 2, 3, 4, 5}, {1, 2, 3, 2, 1}, error);
  CHECK(curve.weights() == std::vector<double>(5, 1.0));
  CHECK(curve.pooled().dof == 10);
  CHECK(curve.pooled().error == Approx(0.1 * std::sqrt(0.8)).epsilon(1e-12));
}

TEST_CASE("Differences of matched streams are taken realization by realization") {
  const std::vector<double> shifts = {-0.02, 0.01, 0.03};
  std::vector<std::vector<double>> values(3);
  for (std::size_t r = 0; r < 3; ++r) {
    values[0].push_back(0.5 + shifts[r]);
    values[1].push_back(0.51 + shifts[r] + 0.001 * static_cast<double>(r));
    values[2].push_back(0.52 + shifts[r]);
  }
  values[2].push_back(0.9);  // value of a realization that the other points have not
  const SweepCurve matched({1, 2, 3}, values, Streams::matched);
  const auto neighbours = differences(matched, std::nullopt);
  REQUIRE(neighbours.size() == 2);
  CHECK(neighbours[0].value == Approx(0.011));
  CHECK(neighbours[0].error.error == Approx(0.001 / std::sqrt(3.0)));
  CHECK(neighbours[0].error.dof == 2);
  CHECK(neighbours[1].value == Approx(0.009));
  CHECK(neighbours[1].pairs == 3);
  CHECK(neighbours[0].p == Approx(p_value(0.011, {0.001 / std::sqrt(3.0), 2})).epsilon(1e-9));
  CHECK(neighbours[0].corrected == Approx(2 * neighbours[0].p));
  CHECK(neighbours[1].p < neighbours[0].corrected);  // Holm's p-values keep the order
  CHECK(neighbours[1].corrected == neighbours[0].corrected);

  const auto of_last = differences(SweepCurve({1, 2, 3}, values, Streams::independent), 2);
  REQUIRE(of_last.size() == 2);
  CHECK(of_last[1].start == 2);
  CHECK(of_last[1].end == 1);
  // Welch's test, of three and of four.
  Moments few, large;
  for (const double value : values[1]) few.add(value);
  for (const double value : values[2]) large.add(value);
  CHECK(of_last[1].value == Approx(few.mean() - large.mean()));
  CHECK(of_last[1].error.error ==
        Approx(std::hypot(few.standard_error(), large.standard_error())).epsilon(1e-12));
  CHECK(of_last[1].error.dof > 2);
  CHECK(of_last[1].error.dof < 5);
}

TEST_CASE("Equal scatter is tested as scipy's bartlett does, matched streams by their residuals") {
  const std::vector<double> x = {1, 2, 3, 4};
  const std::vector<std::vector<double>> values = {{0.601, 0.605, 0.598, 0.603},
                                                   {0.611, 0.607, 0.614, 0.609},
                                                   {0.620, 0.627, 0.611, 0.631},
                                                   {0.618, 0.613, 0.619, 0.625}};
  // scipy.stats.bartlett(*values)
  CHECK(SweepCurve(x, values, Streams::independent).p_of_equal_scatter() ==
        Approx(0.22286454278597298).epsilon(1e-10));
  // r = values - their means over realizations and over points + the mean of all:
  // scipy.stats.chi2.sf(scipy.stats.bartlett(*r).statistic / (1 - 1 / 3**2), 3)
  CHECK(SweepCurve(x, values, Streams::matched).p_of_equal_scatter() ==
        Approx(0.47549572907886883).epsilon(1e-10));
  const SweepCurve two({1, 2}, {values[0], values[1]}, Streams::matched);
  CHECK(std::isnan(two.p_of_equal_scatter()));  // two points always have equal residuals
}

TEST_CASE("A straight line is that of least squares, with the textbook's errors") {
  const std::vector<double> x = {1, 2, 4, 5};
  const StraightLine exact =
      straight_line(SweepCurve(x, {5, 8, 14, 17}, known({0.5, 0.5, 0.5, 0.5})));
  CHECK(exact.intercept == Approx(2).epsilon(1e-13));
  CHECK(exact.slope == Approx(3).epsilon(1e-13));
  // Sum of (x - 3)^2 is 10.
  CHECK(exact.slope_error.error == Approx(0.5 / std::sqrt(10.0)).epsilon(1e-13));
  CHECK(exact.intercept_error.error == Approx(0.5 * std::sqrt(0.25 + 0.9)).epsilon(1e-13));
  CHECK(exact.reduced_chi2 < 1e-25);
  // Residuals 1, -1, -1, 1 are orthogonal to 1 and x: the variance is 4/2.
  const StraightLine rough = straight_line(SweepCurve(x, {6, 7, 13, 18}, std::vector<ErrorOf>(4)));
  CHECK(rough.slope == Approx(3).epsilon(1e-13));
  CHECK(rough.slope_error.error == Approx(std::sqrt(0.2)).epsilon(1e-13));
  CHECK(std::isnan(rough.reduced_chi2));
  CHECK(std::isnan(straight_line(SweepCurve({1, 1}, {1, 2}, known({1, 1}))).slope));
}

TEST_CASE("Points count by their errors") {
  // The third point hardly counts: the line goes through the other two.
  const StraightLine line =
      straight_line(SweepCurve({0, 1, 2}, {0, 1, 9}, known({1e-6, 1e-6, 1e6})));
  CHECK(line.slope == Approx(1).epsilon(1e-9));
}

TEST_CASE("Many realizations give a line the errors of its points", "[statistics]") {
  const SweepCurve curve(strengths, noisy_bell(7, 200, 0.01), Streams::independent);
  const StraightLine line = straight_line(curve);
  double squares = 0, sum = 0;
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    const double from_middle = strengths[i] - 0.175;
    squares += from_middle * from_middle;
    sum += std::pow(from_middle * curve.error()[i].error, 2);
  }
  CHECK(line.slope_error.error == Approx(std::sqrt(sum) / squares).epsilon(1e-9));
  CHECK(line.slope_error.dof > 200);
  CHECK(line.p < 1e-6);  // a bell is no line
}

TEST_CASE("A table of a sweep holds the curve, its maximum and its line") {
  const SweepCurve curve(strengths, noisy_bell(8, 5, 0.001), Streams::independent);
  const Table table =
      sweep_table("sweep/bulk_fraction", {"sqrt_epsilon", "1", "square root of the dilation"},
                  {"bulk_fraction", "1", "bulk packing fraction", ""}, curve);
  CHECK(table.axes.at(0).name == "sqrt_epsilon");
  CHECK(std::get<std::vector<double>>(table.axes[0].values) == strengths);
  for (const Quantity& quantity : table.quantities) {
    CAPTURE(quantity.name);
    const std::size_t pairs = strengths.size() - 1;
    const bool along_pairs = !quantity.axes.empty() && quantity.axes[0] == "pair";
    const std::size_t n = quantity.axes.empty() ? 1 : along_pairs ? pairs : strengths.size();
    CHECK(std::visit([](const auto& values) { return values.size(); }, quantity.values) == n);
    CHECK(!quantity.long_name.empty());
  }
}

TEST_CASE("Errors of values without realizations are tested for being equal, as they are pooled") {
  std::vector<std::vector<double>> values;
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    synthetic::Gaussian gaussian(20261128 + i);
    values.emplace_back();
    for (int r = 0; r < 5; ++r)
      values.back().push_back(static_cast<double>(i * i + 1) * gaussian());
  }
  const SweepCurve by_realizations(strengths, values, Streams::independent);
  const SweepCurve by_errors(strengths, by_realizations.y(), by_realizations.error());
  CHECK(by_errors.p_of_equal_scatter() ==
        Approx(by_realizations.p_of_equal_scatter()).epsilon(1e-9));
  const Table table = sweep_table("sweep/sigma", {"gamma", "1", "lift"},
                                  {"sigma", "1", "deviation", ""}, by_errors);
  REQUIRE(by_errors.p_of_equal_scatter() < 0.05);
  const auto note =
      std::ranges::find(table.notes, "scatter", [](const auto& n) { return n.first; });
  REQUIRE(note != table.notes.end());
  CHECK(note->second.starts_with("the errors of the points differ"));
}

TEST_CASE("Points of few realizations have errors by the pooled variance beside their own") {
  const auto table_of = [](std::size_t realizations, Streams streams) {
    return sweep_table("sweep/phi", {"gamma", "1", "lift"}, {"phi", "1", "fraction", ""},
                       SweepCurve(strengths, noisy_bell(9, realizations, 0.01), streams));
  };
  const auto values = [](const Table& table, const std::string& name) {
    const auto found = std::ranges::find(table.quantities, name, &Quantity::name);
    REQUIRE(found != table.quantities.end());
    return std::get<std::vector<double>>(found->values);
  };
  const Table few = table_of(4, Streams::independent);
  for (const double error : values(few, "phi_pooled_error")) {
    CHECK(error == Approx(values(few, "pooled_sigma")[0] / 2).epsilon(1e-12));
  }
  // Matched streams: what realizations share counts in the error of a point.
  const Table matched = table_of(4, Streams::matched);
  CHECK(values(matched, "phi_pooled_error")[0] > 0);
  const Table large_table = table_of(10, Streams::independent);
  CHECK(std::ranges::find(large_table.quantities, std::string("phi_pooled_error"),
                          &Quantity::name) == large_table.quantities.end());
}

}  // namespace jostle
