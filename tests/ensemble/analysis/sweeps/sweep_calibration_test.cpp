#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <vector>

#include "ensemble/analysis/sweeps/sweep_curve.hpp"
#include "fitting/intervals/distributions.hpp"
#include "tests/ensemble/synthetic_series.hpp"

// Calibration of sweep curves whose truth is known: noise of M realizations on nothing, on a
// bell, on a line.

using namespace jostle;

namespace {

struct Setting {
  std::size_t points, realizations;
  Streams streams;
};

/// Curves that hold the truth, or find what there is.
struct Counts {
  double maximum_of_flat = 0, maximum_of_plateau = 0;
  double minimum_of_flat = 0, either_of_flat = 0;
  double maximum_of_bell = 0, place = 0;     // the place: of the maxima found
  double maximum_of_skewed = 0, skewed = 0;  // for bells that are no parabolas
  double unlike = 0;                         // called so where scatters are alike
  double slope_68 = 0, slope_95 = 0, straight = 0, difference = 0;
};

double abscissa_of(const Setting& setting, std::size_t point) {
  return 0.1 + 0.4 * static_cast<double>(point) / static_cast<double>(setting.points - 1);
}

/// Noise of deviation 1; with matched streams on a level of each realization that is twice as far.
template <class Law>
SweepCurve curve_of(const Setting& setting, std::size_t ensemble, const Law& law) {
  const auto code = setting.points * 100 + setting.realizations * 2;
  const bool matched = setting.streams == Streams::matched;
  synthetic::Gaussian gaussian(20261123 + ensemble, code + (matched ? 1 : 0));
  std::vector<double> x, level;
  std::vector<std::vector<double>> values(setting.points);
  for (std::size_t r = 0; r < setting.realizations; ++r)
    level.push_back(matched ? 2 * gaussian() : 0);
  for (std::size_t i = 0; i < setting.points; ++i) {
    x.push_back(abscissa_of(setting, i));
    for (const double own : level) values[i].push_back(law(x.back()) + own + gaussian());
  }
  return {x, values, setting.streams};
}

bool holds(double truth, double value, const ErrorOf& error, double level) {
  return std::abs(value - truth) <= error.error * student_two_sided(level, error.dof);
}

bool differs(const SweepCurve& curve) {
  for (const SweepDifference& difference : differences(curve, std::nullopt)) {
    if (difference.corrected < 0.05) return true;
  }
  return false;
}

Counts calibrated(const Setting& setting, std::size_t ensembles) {
  Counts counts;
  const double weight = 1 / static_cast<double>(ensembles);
  for (std::size_t e = 0; e < ensembles; ++e) {
    const SweepCurve flat = curve_of(setting, e, [](double) { return 0; });
    const bool high = maximum(flat).found(), low = minimum(flat).found();
    counts.maximum_of_flat += weight * high;
    counts.minimum_of_flat += weight * low;
    counts.either_of_flat += weight * (high || low);
    counts.difference += weight * differs(flat);
    counts.unlike += weight * (flat.p_of_equal_scatter() < 0.01);
    const SweepCurve plateau =
        curve_of(setting, e, [](double x) { return -20 * std::exp(-10 * (x - 0.1)); });
    counts.maximum_of_plateau += weight * maximum(plateau).found();
    const auto count_place = [](const SweepCurve& curve, double truth, double& found,
                                double& held) {
      const SweepExtremum top = maximum(curve);
      if (!top.found()) return;
      ++found;
      held += !(top.x_low > truth) && !(top.x_high < truth);
    };
    count_place(curve_of(setting, e, [](double x) { return -300 * (x - 0.3) * (x - 0.3); }), 0.3,
                counts.maximum_of_bell, counts.place);
    // Steep on the left, slow on the right: a parabola's top is far from theirs.
    count_place(curve_of(setting, e, [](double x) { return -20 * std::pow(std::log(x / 0.2), 2); }),
                0.2, counts.maximum_of_skewed, counts.skewed);
    count_place(curve_of(setting, e,
                         [](double x) { return x < 0.22 ? 100 * (x - 0.22) : -15 * (x - 0.22); }),
                0.22, counts.maximum_of_skewed, counts.skewed);
    const StraightLine line = straight_line(curve_of(setting, e, [](double x) { return 5 * x; }));
    counts.slope_68 += weight * holds(5, line.slope, line.slope_error, 0.6827);
    counts.slope_95 += weight * holds(5, line.slope, line.slope_error, 0.95);
    counts.straight += weight * (line.p < 0.05);
  }
  counts.place /= counts.maximum_of_bell;
  counts.skewed /= counts.maximum_of_skewed;
  counts.maximum_of_bell *= weight;
  counts.maximum_of_skewed *= 0.5 * weight;
  return counts;
}

void check(const std::vector<std::size_t>& points, const std::vector<std::size_t>& realizations,
           std::size_t ensembles) {
  fmt::print("{:>6} {:>3} {:>8} | {:^31} | {:^13} | {:^13} | {:^20} | {:>6}\n", "points", "M",
             "streams", "found: max., min., either", "bell", "skewed bells", "line", "pairs");
  fmt::print(
      "{:>19} | {:>7} {:>7} {:>7} {:>7} | {:>6} {:>6} | {:>6} {:>6} | {:>6} {:>6} {:>6} | {:>6}\n",
      "", "flat", "flat", "flat", "rising", "found", "95 %", "found", "95 %", "68 %", "95 %",
      "F 5 %", "5 %");
  for (const std::size_t n : points) {
    for (const std::size_t m : realizations) {
      for (const Streams streams : {Streams::independent, Streams::matched}) {
        const Counts counts = calibrated({n, m, streams}, ensembles);
        const bool matched = streams == Streams::matched;
        fmt::print(
            "{:>6} {:>3} {:>8} | {:>6.1f}% {:>6.1f}% {:>6.1f}% {:>6.1f}% | {:>5.1f}% {:>5.1f}% | "
            "{:>5.1f}% {:>5.1f}% | "
            "{:>5.1f}% {:>5.1f}% {:>5.1f}% | {:>5.1f}%\n",
            n, m, matched ? "matched" : "indep.", 100 * counts.maximum_of_flat,
            100 * counts.minimum_of_flat, 100 * counts.either_of_flat,
            100 * counts.maximum_of_plateau, 100 * counts.maximum_of_bell, 100 * counts.place,
            100 * counts.maximum_of_skewed, 100 * counts.skewed, 100 * counts.slope_68,
            100 * counts.slope_95, 100 * counts.straight, 100 * counts.difference);
        CAPTURE(n, m, matched);
        const double of_5 = 3 * std::sqrt(0.05 * 0.95 / static_cast<double>(ensembles));
        const double of_68 = 3 * std::sqrt(0.68 * 0.32 / static_cast<double>(ensembles));
        CHECK(counts.maximum_of_flat <= 0.05 + of_5);
        CHECK(counts.minimum_of_flat <= 0.05 + of_5);
        CHECK(counts.maximum_of_plateau <= 0.05 + of_5);
        CHECK(counts.difference <= 0.05 + of_5);
        CHECK(counts.unlike <= 0.01 + 3 * std::sqrt(0.01 / static_cast<double>(ensembles)));
        CHECK(std::abs(counts.straight - 0.05) <= of_5);
        CHECK(std::abs(counts.slope_95 - 0.95) <= of_5);
        CHECK(std::abs(counts.slope_68 - 0.6827) <= of_68);
        for (const auto& [found, held] : {std::pair{counts.maximum_of_bell, counts.place},
                                          std::pair{2 * counts.maximum_of_skewed, counts.skewed}}) {
          const double places = found * static_cast<double>(ensembles);
          if (places >= 20) CHECK(held >= 0.95 - 3 * std::sqrt(0.05 * 0.95 / places));
        }
      }
    }
  }
  std::fflush(stdout);
}

}  // namespace

TEST_CASE("Realizations that scatter the more the farther on are not pooled in silence",
          "[statistics]") {
  std::size_t found = 0;
  constexpr std::size_t ensembles = 100;
  for (std::size_t e = 0; e < ensembles; ++e) {
    synthetic::Gaussian gaussian(20261126 + e);
    std::vector<double> x;
    std::vector<std::vector<double>> values(8);
    for (std::size_t i = 0; i < 8; ++i) {
      x.push_back(static_cast<double>(i));
      for (int r = 0; r < 4; ++r) values[i].push_back(static_cast<double>(i + 1) * gaussian());
    }
    found += SweepCurve(x, values, Streams::independent).p_of_equal_scatter() < 0.01;
  }
  CHECK(found >= 50);
}

TEST_CASE("Unequal scatter is found at the level of the test where scatters are equal",
          "[statistics]") {
  constexpr std::size_t ensembles = 600;
  for (const Streams streams : {Streams::independent, Streams::matched}) {
    for (const std::size_t points : {3, 5, 7}) {
      for (const std::size_t realizations : {4, 6, 9}) {
        const Setting setting{points, realizations, streams};
        std::size_t found = 0;
        for (std::size_t e = 0; e < ensembles; ++e) {
          found += curve_of(setting, e, [](double) { return 0; }).p_of_equal_scatter() < 0.05;
        }
        CAPTURE(points, realizations, streams == Streams::matched);
        const double share = static_cast<double>(found) / ensembles;
        CHECK(std::abs(share - 0.05) <= 3 * std::sqrt(0.05 * 0.95 / ensembles));
      }
    }
  }
}

TEST_CASE("Maxima are found and lines hold the truth at their stated rate", "[statistics]") {
  check({5, 7}, {2, 3, 10}, 200);
}

TEST_CASE("Maxima, lines and differences are calibrated for every ensemble", "[nightly]") {
  check({5, 7, 9}, {2, 3, 4, 10, 20}, 1000);
}
