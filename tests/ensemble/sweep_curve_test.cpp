#include "ensemble/sweep_curve.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "ensemble/moments.hpp"
#include "noise.hpp"

namespace jostle {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

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

TEST_CASE("The maximum of a parabola is found exactly, its points in any order") {
  std::vector<double> x = {0.3, 0.05, 0.1, 0.2, 0.15, 0.24}, y;
  for (const double at : x) y.push_back(bell(at));
  x.push_back(0.12);
  y.push_back(none);  // dropped
  const SweepCurve curve(x, y, std::vector<double>(x.size(), 1e-6));
  CHECK(curve.n_points() == 6);
  for (const std::size_t points : {3, 5, 50}) {
    const SweepMaximum top = maximum(curve, points);
    CHECK(top.points == std::min<std::size_t>(points, 6));
    CHECK(top.x == Approx(0.17).epsilon(1e-11));
    CHECK(top.y == Approx(0.6).epsilon(1e-13));
    CHECK(top.resolved == 1);
    CHECK(top.verdict == "maximum");
  }
}

TEST_CASE("Errors of a maximum are the scatter of maxima", "[statistics]") {
  constexpr int ensembles = 300;
  const double spread = 0.002;
  const std::size_t realizations = 20;
  Moments at, height;
  double jackknife_at = 0, jackknife_height = 0, drawn_at = 0, drawn_height = 0;
  for (int i = 0; i < ensembles; ++i) {
    const SweepCurve curve(strengths,
                           noisy_bell(static_cast<std::uint64_t>(100 + i), realizations, spread),
                           Streams::independent);
    const SweepMaximum top = maximum(curve);
    const SweepMaximum drawn = maximum(SweepCurve(curve.x(), curve.y(), curve.error()));
    at.add(top.x);
    height.add(top.y);
    jackknife_at += top.x_error / ensembles;
    jackknife_height += top.y_error / ensembles;
    drawn_at += drawn.x_error / ensembles;
    drawn_height += drawn.y_error / ensembles;
  }
  // Scatter is known to 1/sqrt(2 * 300) = 4 %; weights that scatter too add some per cent to it.
  for (const double error : {jackknife_at, drawn_at}) {
    CHECK(error / at.sigma() > 0.8);
    CHECK(error / at.sigma() < 1.2);
  }
  for (const double error : {jackknife_height, drawn_height}) {
    CHECK(error / height.sigma() > 0.8);
    CHECK(error / height.sigma() < 1.2);
  }
  CHECK(std::abs(at.mean() - 0.17) <= 3 * at.standard_error());
}

TEST_CASE("With matched streams, what shifts a packing at all points leaves its maximum") {
  std::vector<std::vector<double>> values;
  for (const double x : strengths) {
    values.emplace_back();
    for (const double shift : {-0.02, 0.01, 0.03, -0.01}) values.back().push_back(bell(x) + shift);
  }
  const SweepMaximum matched = maximum(SweepCurve(strengths, values, Streams::matched));
  CHECK(matched.x == Approx(0.17).epsilon(1e-10));
  CHECK(matched.x_error < 1e-12);
  Moments shifts;
  for (const double shift : {-0.02, 0.01, 0.03, -0.01}) shifts.add(shift);
  CHECK(matched.y_error == Approx(shifts.standard_error()).epsilon(1e-10));
  CHECK(maximum(SweepCurve(strengths, values, Streams::independent)).x_error > 1e-3);
}

TEST_CASE("A lone realization that an estimate uses leaves it without an error") {
  auto values = noisy_bell(11, 8, 0.002);
  values.front().resize(1);  // at 0.05, outside the three points about the largest
  const SweepCurve curve(strengths, values, Streams::independent);
  CHECK(maximum(curve, 3).x_error > 0);
  CHECK(std::isnan(maximum(curve, 6).x_error));
  CHECK(std::isfinite(maximum(curve, 6).x));
  CHECK(std::isnan(straight_line(curve).slope_error));
  CHECK(std::isnan(maximum(SweepCurve(strengths, values, Streams::matched), 6).x_error));
}

TEST_CASE("What is no maximum is not called one") {
  const std::vector<double> x = {1, 2, 3, 4, 5}, error(5, 0.1);
  const SweepMaximum rising = maximum(SweepCurve(x, {1, 2, 3, 4, 5}, error));
  CHECK(std::isnan(rising.x));
  CHECK(std::isnan(rising.x_error));
  CHECK(rising.verdict == "no maximum inside: the largest value is at an end of the sweep");
  const SweepMaximum flat = maximum(SweepCurve(x, {1, 1.01, 1.02, 1.01, 1}, error));
  CHECK(flat.resolved < 0.95);
  CHECK(flat.verdict.substr(0, 8) == "doubtful");
  CHECK(maximum(SweepCurve({1, 2}, {1, 2}, {1, 1})).verdict ==
        "fewer than three different strengths");
  CHECK(maximum(SweepCurve(x, {1, 2, 3, 2, 1}, std::vector<double>(5, none))).verdict ==
        "maximum, without errors");
}

TEST_CASE("A straight line is that of least squares, with the textbook's errors") {
  const std::vector<double> x = {1, 2, 4, 5};
  const StraightLine exact = straight_line(SweepCurve(x, {5, 8, 14, 17}, {0.5, 0.5, 0.5, 0.5}));
  CHECK(exact.intercept == Approx(2).epsilon(1e-13));
  CHECK(exact.slope == Approx(3).epsilon(1e-13));
  // Sum of (x - 3)^2 is 10.
  CHECK(exact.slope_error == Approx(0.5 / std::sqrt(10.0)).epsilon(1e-13));
  CHECK(exact.intercept_error == Approx(0.5 * std::sqrt(0.25 + 0.9)).epsilon(1e-13));
  CHECK(exact.reduced_chi2 < 1e-25);
  // Residuals 1, -1, -1, 1 are orthogonal to 1 and x: the variance is 4/2.
  const StraightLine rough =
      straight_line(SweepCurve(x, {6, 7, 13, 18}, std::vector<double>(4, none)));
  CHECK(rough.slope == Approx(3).epsilon(1e-13));
  CHECK(rough.slope_error == Approx(std::sqrt(0.2)).epsilon(1e-13));
  CHECK(std::isnan(rough.reduced_chi2));
  CHECK(std::isnan(straight_line(SweepCurve({1, 1}, {1, 2}, {1, 1})).slope));
}

TEST_CASE("Points count by their errors") {
  // The third point hardly counts: the line goes through the other two.
  const StraightLine line = straight_line(SweepCurve({0, 1, 2}, {0, 1, 9}, {1e-6, 1e-6, 1e6}));
  CHECK(line.slope == Approx(1).epsilon(1e-9));
}

TEST_CASE("Realizations give a line the errors of its points", "[statistics]") {
  const SweepCurve curve(strengths, noisy_bell(7, 200, 0.01), Streams::independent);
  const StraightLine jackknife = straight_line(curve);
  const StraightLine points = straight_line(SweepCurve(curve.x(), curve.y(), curve.error()));
  CHECK(jackknife.slope == points.slope);
  // The jackknife of a weighted mean of independent means is its error, weights being kept.
  CHECK(jackknife.slope_error == Approx(points.slope_error).epsilon(1e-9));
  CHECK(jackknife.intercept_error == Approx(points.intercept_error).epsilon(1e-9));
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
    const std::size_t n = quantity.axes.empty() ? 1 : strengths.size();
    CHECK(std::visit([](const auto& values) { return values.size(); }, quantity.values) == n);
    CHECK(!quantity.long_name.empty());
  }
}

}  // namespace jostle
