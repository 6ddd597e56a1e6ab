#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "ensemble/analysis/ordering/log_rank.hpp"
#include "ensemble/analysis/ordering/times.hpp"
#include "ensemble/analysis/ordering/weibull.hpp"
#include "fitting/intervals/distributions.hpp"
#include "tests/ensemble/synthetic_series.hpp"

// Calibration of times to order whose law is known, for the smallest ensembles: Weibull times of
// median 100, censored at 150, of M realizations.

using namespace jostle;

namespace {

constexpr std::uint64_t last = 150;
constexpr double median = 100;

OrderingTime drawn(RandomStream& random, double shape, double middle = median) {
  const double scale = middle / std::pow(std::log(2.0), 1 / shape);
  const double t = std::ceil(scale * std::pow(-std::log(random.uniform()), 1 / shape));
  if (t > static_cast<double>(last)) return {last, false};
  return {static_cast<std::uint64_t>(t), true};
}

RandomStream stream(std::uint64_t ensemble, std::uint64_t code) {
  return RandomStream(stream_key(20261124 + ensemble, code, 0, Purpose::resampling));
}

/// Without a limit it is not outside.
bool holds(const Limits& limits, double truth) {
  return !(truth < limits.low) && !(truth > limits.high);
}

struct Shares {
  double median_68 = 0, median_95 = 0, survival_95 = 0, fitted = 0, shape_68 = 0, shape_95 = 0,
         not_memoryless = 0, decade_68 = 0, decade_95 = 0;
};

Shares shares(std::size_t realizations, double shape, int ensembles) {
  Shares found;
  for (int e = 0; e < ensembles; ++e) {
    RandomStream random = stream(e, realizations * 10 + static_cast<std::uint64_t>(shape));
    std::vector<OrderingTime> times;
    GrowthOfSeries growth;
    for (std::size_t r = 0; r < realizations; ++r) {
      times.push_back(drawn(random, shape));
      std::vector<double> series =
          synthetic::autoregressive(0.98, 300, 20261124 + e, realizations * 100 + r);
      for (std::size_t t = 1; t < series.size(); ++t)
        series[t] += 2 * std::log10(static_cast<double>(t));
      growth.add(series);
    }
    found.median_68 += holds(median_limits(times, 0.6827), median) ? 1 : 0;
    found.median_95 += holds(median_limits(times, 0.95), median) ? 1 : 0;
    std::uint64_t early = 0;
    for (const OrderingTime& time : times) early += time.ordered && time.tap <= 60 ? 1 : 0;
    const double truth = std::exp2(-std::pow(0.6, shape));
    found.survival_95 +=
        holds(share_limits(realizations - early, realizations, 0.95), truth) ? 1 : 0;
    const auto [slope, error] = growth.result().per_decade;
    found.decade_68 += std::abs(slope - 2) <= error.error * two_sided(0.6827, error.dof) ? 1 : 0;
    found.decade_95 += std::abs(slope - 2) <= error.error * two_sided(0.95, error.dof) ? 1 : 0;
    if (const auto fit = weibull(times, last)) {
      found.fitted += 1;
      found.shape_68 += holds(fit->shape_68, shape) ? 1 : 0;
      found.shape_95 += holds(fit->shape_95, shape) ? 1 : 0;
      found.not_memoryless += fit->memoryless_p < 0.05 ? 1 : 0;
    }
  }
  for (double* share : {&found.shape_68, &found.shape_95, &found.not_memoryless})
    *share /= std::max(1.0, found.fitted);
  for (double* share : {&found.median_68, &found.median_95, &found.survival_95, &found.fitted,
                        &found.decade_68, &found.decade_95})
    *share /= ensembles;
  return found;
}

struct Verdicts {
  double first_excluded = 0, largest_excluded = 0, separated = 0;
};

/// Five points of deviation 1. The fastest is `first`, by a factor; the largest `largest`, by
/// `higher` deviations. Matched: a realization is fast or slow, high or low, at all points.
Verdicts verdicts(std::size_t realizations, Streams streams, double factor, double higher,
                  std::size_t first, std::size_t largest, int ensembles) {
  const bool matched = streams == Streams::matched;
  Verdicts found;
  for (int e = 0; e < ensembles; ++e) {
    RandomStream random = stream(e, 7000 + realizations * 4 + (matched ? 1 : 0) + first * 1000);
    synthetic::Gaussian gaussian(20261124 + e, 7000 + realizations * 2 + (matched ? 1 : 0));
    std::vector<OrderingTimes> times(5);
    std::vector<std::vector<double>> values(5);
    for (std::size_t r = 0; r < realizations; ++r) {
      const double own_speed = matched ? std::exp(0.5 * gaussian()) : 1;
      const double own_value = matched ? 2 * gaussian() : 0;
      for (std::size_t k = 0; k < 5; ++k) {
        const double middle = median * own_speed / (k == first ? factor : 1);
        times[k].of_realization.push_back(drawn(random, 3, middle));
        times[k].last = last;
        values[k].push_back(own_value + gaussian() + (k == largest ? higher : 0));
      }
    }
    const Candidates early = may_order_first(times, streams);
    const Candidates high = may_be_largest(values, streams, std::vector<bool>(5, false));
    found.first_excluded += early.may_be[first] ? 0 : 1;
    found.largest_excluded += high.may_be[largest] ? 0 : 1;
    bool is_reached = false;
    for (std::size_t k = 0; k < 5; ++k)
      is_reached = is_reached || (early.may_be[k] && high.may_be[k]);
    found.separated += is_reached ? 0 : 1;
  }
  for (double* share : {&found.first_excluded, &found.largest_excluded, &found.separated})
    *share /= ensembles;
  return found;
}

/// Rates over so many ensembles of three and four realizations, and a third of them beyond.
void check_verdicts(const std::vector<std::size_t>& all_realizations, int ensembles_of_few) {
  fmt::print("  M streams     | alike: first, largest excluded | one: apart | two: apart\n");
  for (const std::size_t realizations : all_realizations) {
    const int ensembles = realizations < 10 ? ensembles_of_few : ensembles_of_few / 3;
    for (const Streams streams : {Streams::independent, Streams::matched}) {
      const Verdicts alike = verdicts(realizations, streams, 1, 0, 1, 1, ensembles);
      const Verdicts outcome = verdicts(realizations, streams, 2.5, 3, 1, 1, ensembles);
      const Verdicts two = verdicts(realizations, streams, 2.5, 3, 1, 3, ensembles);
      fmt::print("{:3} {:11} | {:13.3f} {:16.3f} | {:10.3f} | {:10.3f}\n", realizations,
                 streams == Streams::matched ? "matched" : "independent", alike.first_excluded,
                 alike.largest_excluded, outcome.separated, two.separated);
      // 2.5 % each, 5 % together; three standard errors.
      const double margin = 3 * std::sqrt(0.05 * 0.95 / ensembles);
      CHECK(alike.first_excluded <= 0.025 + margin);
      CHECK(alike.largest_excluded <= 0.025 + margin);
      CHECK(outcome.separated <= 0.05 + margin);
      if (realizations >= 10) CHECK(two.separated > 0.8);
    }
  }
}

/// Rates over 200 ensembles, for times without memory (shape 1) and of shape 3.
void check_intervals(const std::vector<std::size_t>& all_realizations) {
  constexpr int ensembles = 200;
  fmt::print(
      "  M shape | median 68 %   95 %  S(60) 95 % | fitted  shape 68 %   95 %  not memoryless "
      "| per decade 68 %   95 %\n");
  for (const std::size_t realizations : all_realizations) {
    for (const double shape : {1.0, 3.0}) {
      const Shares found = shares(realizations, shape, ensembles);
      fmt::print(
          "{:3} {:5} | {:11.3f} {:6.3f} {:11.3f} | {:6.3f} {:11.3f} {:6.3f} {:15.3f} | "
          "{:13.3f} {:6.3f}\n",
          realizations, shape, found.median_68, found.median_95, found.survival_95, found.fitted,
          found.shape_68, found.shape_95, found.not_memoryless, found.decade_68, found.decade_95);
      // Three standard errors. The exact intervals may hold more.
      const double of_68 = 3 * std::sqrt(0.6827 * 0.3173 / ensembles);
      const double of_95 = 3 * std::sqrt(0.95 * 0.05 / ensembles);
      CHECK(found.median_68 > 0.6827 - of_68);
      CHECK(found.median_95 > 0.95 - of_95);
      CHECK(found.survival_95 > 0.95 - of_95);
      CHECK(found.decade_68 == Approx(0.6827).margin(of_68).epsilon(0));
      CHECK(found.decade_95 == Approx(0.95).margin(of_95).epsilon(0));
      if (found.fitted < 0.2) continue;  // too few that ordered
      const double fitted = std::sqrt(found.fitted);
      CHECK(found.shape_68 == Approx(0.6827).margin(of_68 / fitted).epsilon(0));
      CHECK(found.shape_95 == Approx(0.95).margin(of_95 / fitted).epsilon(0));
      if (shape == 1) CHECK(found.not_memoryless < 0.05 + of_95 / fitted);
    }
  }
}

}  // namespace

TEST_CASE("Intervals of times to order hold the truth at their stated rate", "[statistics]") {
  check_intervals({3, 6});
}

TEST_CASE("Intervals of times to order hold the truth, 4 to 20 realizations", "[slow]") {
  check_intervals({4, 10, 20});
}

TEST_CASE("The best point for order and the largest value differ at the stated rate",
          "[statistics]") {
  check_verdicts({4, 10}, 60);
}

TEST_CASE("The best point for order and the largest value differ, 3 to 20 realizations",
          "[nightly]") {
  check_verdicts({3, 4, 10, 20}, 300);
}
