#include "ensemble/analysis/accuracy.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "ensemble/moments.hpp"
#include "ensemble/statistics/student_tests.hpp"
#include "tests/ensemble/noise.hpp"

namespace jostle {

TEST_CASE("A bias is the mean of the pairs' differences") {
  const std::vector<double> values = {1, 2, 4, std::nan("")}, reference = {0.5, 1.5, 2.5, 7};
  const PairedBias found = paired_bias(values, reference);
  CHECK(found.pairs == 3);
  CHECK(found.bias == Approx(2.5 / 3));
  // Differences 0.5, 0.5, 1.5: variance 1/3.
  CHECK(found.error == Approx(std::sqrt(1.0 / 3 / 3)));
  // Variances of 1, 2, 4 and of 0.5, 1.5, 2.5.
  CHECK(found.variance_reduction == Approx((7.0 / 3 + 1) / (1.0 / 3)));
}

TEST_CASE("Without two pairs there is no error, and equal differences need no others") {
  const std::vector<double> first = {1}, second = {3};
  CHECK(paired_bias(first, second).bias == -2);
  CHECK(std::isnan(paired_bias(first, second).error));
  const std::vector<double> a = {1, 2}, b = {2, 3};
  CHECK(std::isinf(paired_bias(a, b).variance_reduction));
}

TEST_CASE("A growth is the change of the pairs' differences, judged by Student's t") {
  const std::vector<double> previous{1, 2, 4}, reference_before{0.5, 1.5, 3.5},
      final_values{1.5, 2.5, 5}, reference{0.5, 1.6, 3.4};
  const Growth growth = bias_growth(previous, reference_before, final_values, reference);
  // Differences of 0.5 each before; of 1, 0.9 and 1.6 after.
  CHECK(growth.change.bias == Approx(2.0 / 3));
  CHECK(growth.change.pairs == 3);
  CHECK(growth.detectable == Approx(smallest_effect_found(0.05, 2) * growth.change.error));
  CHECK(growth.is_seen() == (growth.change.bias > 4.302653 * growth.change.error));
  const std::vector<double> first{1}, second{2};
  CHECK_FALSE(bias_growth(first, first, second, first).is_seen());
  CHECK(std::isnan(bias_growth(first, first, second, first).detectable));
  // The reference against itself.
  CHECK_FALSE(bias_growth(previous, previous, final_values, final_values).is_seen());
}

TEST_CASE("A bias that does not grow is called growing one time in twenty, with any replicates") {
  RandomStream random = test_stream(23);
  constexpr int repetitions = 1500;
  for (const std::size_t replicates : {2u, 3u, 4u, 10u}) {
    int alarms = 0, missed = 0;
    for (int k = 0; k < repetitions; ++k) {
      // Beds differ more than settings; a bias of 0.3 from the first tap on.
      std::vector<double> early, early_reference, late, late_reference, grown;
      for (std::size_t r = 0; r < replicates; ++r) {
        const double bed = 10 * noise(random);
        early_reference.push_back(bed + noise(random));
        late_reference.push_back(bed + 2 + noise(random));
        early.push_back(bed - 0.3 + noise(random));
        late.push_back(bed + 2 - 0.3 + noise(random));
        grown.push_back(late.back() - 30);
      }
      alarms += bias_growth(early, early_reference, late, late_reference).is_seen();
      missed += !bias_growth(early, early_reference, grown, late_reference).is_seen();
    }
    const double rate = static_cast<double>(alarms) / repetitions;
    CAPTURE(replicates, rate, missed);
    CHECK(std::abs(rate - 0.05) <= 3 * std::sqrt(0.05 * 0.95 / repetitions));
    // A difference of 15 deviations is detected even with three replicates.
    if (replicates > 2) CHECK(missed < repetitions / 100);
  }
}

TEST_CASE("The bias of a geometric ladder is the rest of the series") {
  // 1 - 2^-k at k = 1, 2, 3: to 1 are missing 1/8.
  const auto remainder_of = [](std::vector<double> two_before, std::vector<double> previous,
                               std::vector<double> last) {
    return remainder(two_before, previous, last);
  };
  CHECK(remainder_of({0.5, 1.5}, {0.75, 1.75}, {0.875, 1.875}).value == Approx(0.125));
  CHECK(remainder_of({0.5, 1.5}, {0.75, 1.75}, {0.875, 1.875}).error == 0);
  CHECK(std::isnan(remainder_of({0}, {1}, {2}).value));    // steps that do not shrink
  CHECK(std::isnan(remainder_of({0}, {1}, {0.5}).value));  // steps of changing sign
  CHECK(std::isnan(remainder_of({}, {}, {}).value));
  const double missing = std::numeric_limits<double>::quiet_NaN();
  CHECK(remainder_of({0.5, 9, 1.5}, {0.75, missing, 1.75}, {0.875, 9, 1.875}).value ==
        Approx(0.125));
}

TEST_CASE("The error of a ladder's bias is its deviation between ensembles") {
  RandomStream random = test_stream(7);
  const auto scatter = [&] { return 0.02 * noise(random); };
  constexpr int n = 40, repetitions = 400;
  Moments values, errors;
  for (int k = 0; k < repetitions; ++k) {
    std::vector<double> two_before, previous, last;
    for (int r = 0; r < n; ++r) {
      const double bed = 10 * scatter();
      two_before.push_back(bed + scatter());
      previous.push_back(bed + 0.5 + scatter());
      last.push_back(bed + 0.7 + scatter());
    }
    const Remainder found = remainder(two_before, previous, last);
    values.add(found.value);
    errors.add(found.error);
  }
  CHECK(values.mean() == Approx(0.2 * 0.4 / 0.6).epsilon(0.05));
  CHECK(errors.mean() == Approx(values.sigma()).epsilon(0.15));
}

TEST_CASE("The cheapest setting trades bias against realizations") {
  const std::vector<SettingCost> settings = {
      {.bias = 0.003, .bias_error = 0, .sigma = 0.01, .realization_seconds = 1},
      {.bias = 0, .bias_error = 0, .sigma = 0.01, .realization_seconds = 3},
      {.bias = 0.02, .bias_error = 0, .sigma = 0.01, .realization_seconds = 0.1}};
  // 0.005: 1e-4 / (25e-6 - 9e-6) = 6.25 -> 7 realizations of a second, or 4 of three.
  const auto rough = cheapest(settings, 0.005);
  REQUIRE(rough);
  CHECK(rough->setting == 0);
  CHECK(rough->realizations == 7);
  CHECK(rough->core_seconds == 7);
  // Close to the bias only the complete one is left.
  const auto fine = cheapest(settings, 0.0031);
  REQUIRE(fine);
  CHECK(fine->setting == 1);
  CHECK(fine->realizations == 11);
  CHECK_FALSE(cheapest(std::vector<SettingCost>{settings[2]}, 0.02));
}

TEST_CASE("A limit of a deviation is exceeded once in five times") {
  std::mt19937_64 random(12);
  std::normal_distribution<double> gaussian(3, 0.7);
  CHECK(sigma_limit(8) == Approx(1.353).margin(1e-3));  // chi2 of 7 at 20 %: 3.822
  CHECK(std::isinf(sigma_limit(1)));
  for (const std::size_t n : {2, 3, 8, 30}) {
    constexpr int n_trials = 20000;
    int exceeded = 0;
    for (int trial = 0; trial < n_trials; ++trial) {
      Moments values;
      for (std::size_t i = 0; i < n; ++i) values.add(gaussian(random));
      if (values.standard_error() * std::sqrt(static_cast<double>(n)) * sigma_limit(n) < 0.7)
        ++exceeded;
    }
    CAPTURE(n);
    CHECK(exceeded == Approx(0.2 * n_trials).margin(4 * std::sqrt(0.16 * n_trials)));
  }
}

namespace {

/// Stops of five grades, the last the reference and the third the scene's own, and six other
/// settings about as complete as these, all from the same beds.
struct MadeLadder {
  double roughest = 0.01, ratio = 0.45;        // largest ratio of biases, from stop to stop
  double beds = 0.001, noise_of_a_tap = 5e-4;  // deviations
  static constexpr std::size_t previous = 3, reference = 4, own = 2;

  double bias(std::size_t setting) const {
    constexpr double like_stop[] = {0, 1, 2, 3, 4, 1, 3, 2, 2, 2.5, 1.8};
    return -roughest * std::pow(ratio, like_stop[setting]);
  }
  static double seconds(std::size_t setting) {
    constexpr double remainder_of[] = {0.12, 0.3,  0.55, 0.85, 1.37, 0.29,
                                       0.91, 0.51, 0.63, 0.7,  1.1};
    return remainder_of[setting];
  }
  static constexpr std::size_t n_settings = 11;
};

std::vector<SettingCost> limits_of_a_pilot(const MadeLadder& made, std::size_t replicates,
                                           RandomStream& random) {
  std::vector<std::vector<double>> values(made.n_settings);
  for (std::size_t r = 0; r < replicates; ++r) {
    const double bed = made.beds * noise(random);
    for (std::size_t s = 0; s < made.n_settings; ++s)
      values[s].push_back(bed + made.bias(s) + made.noise_of_a_tap * noise(random));
  }
  std::vector<SettingCost> settings;
  for (std::size_t s = 0; s < made.n_settings; ++s) {
    Moments moments;
    for (const double value : values[s]) moments.add(value);
    const PairedBias bias = paired_bias(values[s], values[made.reference]);
    settings.push_back({.bias = bias.bias,
                        .bias_error = bias.error,
                        .sigma = moments.sigma(),
                        .realization_seconds = made.seconds(s),
                        .values = replicates,
                        .pairs = replicates});
  }
  const Pilot pilot{.reference = made.reference,
                    .last_step = paired_bias(values[made.reference], values[made.previous]),
                    .step_before = paired_bias(values[made.previous], values[made.own]),
                    .has_beds = std::vector<std::uint64_t>(made.n_settings, 1)};
  pool_sigma(settings, pilot);
  return at_limits(settings, pilot);
}

}  // namespace

TEST_CASE("Recommendations reach their target in four of five cases") {
  RandomStream random = test_stream(31);
  const std::vector<MadeLadder> ladders = {
      {},
      {.beds = 0.003, .noise_of_a_tap = 1e-3},
      {.beds = 0, .noise_of_a_tap = 2e-3},
      {.roughest = 0.02, .ratio = 0.2, .beds = 1e-3, .noise_of_a_tap = 1e-3},
      {.roughest = 0.003, .ratio = 0.5, .beds = 1e-3, .noise_of_a_tap = 1e-3}};
  constexpr int repetitions = 400;
  for (const MadeLadder& made : ladders) {
    for (const std::size_t replicates : {2u, 3u, 4u, 8u, 30u}) {
      for (const double target : {0.001, 0.002, 0.005}) {
        int recommended = 0, reached = 0;
        for (int k = 0; k < repetitions; ++k) {
          const auto choice = cheapest(limits_of_a_pilot(made, replicates, random), target);
          if (!choice) continue;
          ++recommended;
          const double variance = made.beds * made.beds + made.noise_of_a_tap * made.noise_of_a_tap;
          reached +=
              std::hypot(made.bias(choice->setting),
                         std::sqrt(variance / static_cast<double>(choice->realizations))) <= target;
        }
        CAPTURE(made.roughest, made.beds, made.noise_of_a_tap, replicates, target, recommended,
                reached);
        CHECK(reached >= 0.8 * recommended - 3 * std::sqrt(0.16 * recommended));
        // Eight replicates suffice: a rule that never recommends would reach any target.
        if (replicates >= 8 && target == 0.005) CHECK(recommended > repetitions / 2);
      }
    }
  }
}

TEST_CASE("Steps of a ladder that are not known to shrink recommend nothing") {
  const std::vector<SettingCost> settings(
      3, {.sigma = 0.01, .realization_seconds = 1, .values = 30, .pairs = 30});
  Pilot pilot{.reference = 2,
              .last_step = {.pairs = 30, .bias = 0.002, .error = 1e-4},
              .step_before = {.pairs = 30, .bias = 0.002, .error = 1e-4},
              .has_beds = {1, 1, 1}};
  CHECK_FALSE(cheapest(at_limits(settings, pilot), 1));
  pilot.step_before.bias = 0.01;
  const double t = 0.854192;  // Student's t for 29 degrees of freedom, once in five times
  const double step = 0.002 + t * 1e-4, ratio = step / (0.01 - t * 1e-4);
  CHECK(at_limits(settings, pilot)[2].bias == Approx(step));  // ratios below a half
  pilot.step_before.bias = 0.003;
  const double slower = step / (0.003 - t * 1e-4);
  CHECK(at_limits(settings, pilot)[0].bias == Approx(step * slower / (1 - slower)));
  CHECK(ratio < 0.5);
  const std::vector<SettingCost> alone(
      3, {.sigma = 0.01, .realization_seconds = 1, .values = 1, .pairs = 1});
  CHECK_FALSE(cheapest(at_limits(alone, pilot), 1));
}

TEST_CASE("Limits are by the pairs that a setting has, not by those that were planned") {
  std::vector<SettingCost> settings(
      3, {.bias = 0.01, .bias_error = 0.004, .sigma = 0.02, .values = 6, .pairs = 6});
  settings[1].pairs = 3;  // two replicates failed
  settings[1].values = 4;
  const Pilot pilot{.reference = 2,
                    .last_step = {.pairs = 2, .bias = 0.001, .error = 0.001},
                    .step_before = {.pairs = 6, .bias = 0.01, .error = 0.001},
                    .has_beds = {0, 0, 0}};
  const std::vector<SettingCost> limits = at_limits(settings, pilot);
  const double of_6 = 0.919544, of_3 = 1.060660, of_2 = 1.376382;  // Student's t, tables
  const double lacking = 0.001 + of_2 * 0.001;
  CHECK(limits[0].bias == Approx(0.01 + of_6 * 0.004 + lacking).epsilon(1e-5));
  CHECK(limits[1].bias == Approx(0.01 + of_3 * 0.004 + lacking).epsilon(1e-5));
  CHECK(limits[2].bias == Approx(lacking).epsilon(1e-5));
  CHECK(limits[0].sigma == Approx(0.02 * std::sqrt(5 / 2.342534)).epsilon(1e-4));  // chi2, tables
  CHECK(limits[1].sigma == Approx(0.02 * std::sqrt(3 / 1.005174)).epsilon(1e-4));
  // Deviations count by their degrees of freedom.
  settings[1].sigma = 0.04;
  Pilot pooling = pilot;
  pooling.has_beds = {1, 1, 0};
  pool_sigma(settings, pooling);
  const double pooled = std::sqrt((5 * 0.02 * 0.02 + 3 * 0.04 * 0.04) / 8);
  CHECK(settings[0].sigma == Approx(pooled));
  CHECK(settings[1].sigma == Approx(pooled));
  CHECK(settings[2].sigma == 0.02);
}

TEST_CASE("A bias that is not known is no choice, and its error counts as bias") {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const std::vector<SettingCost> settings = {
      {.bias = 0.001, .bias_error = unknown, .sigma = 0.01, .realization_seconds = 1},
      {.bias = 0.001, .bias_error = 0.002, .sigma = 0, .realization_seconds = 1}};
  CHECK_FALSE(cheapest(settings, 0.003));
  CHECK(cheapest(settings, 0.0031)->setting == 1);
  CHECK(pareto_front(settings) == std::vector<std::uint64_t>{0, 1});
}

TEST_CASE("The front holds what is neither slower nor worse") {
  const std::vector<SettingCost> settings = {{.bias = 0.01, .realization_seconds = 1},
                                             {.bias = -0.02, .realization_seconds = 2},
                                             {.bias = 0.001, .realization_seconds = 5},
                                             {.bias = 0, .realization_seconds = 9}};
  CHECK(pareto_front(settings) == std::vector<std::uint64_t>{1, 0, 1, 1});
}

}  // namespace jostle
