#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "ensemble/analysis/ordering/ordering_table.hpp"
#include "ensemble/analysis/ordering/weibull.hpp"

using namespace jostle;

namespace {

OrderingTimes ensemble_of(const std::vector<OrderingTime>& times, std::uint64_t last) {
  return {.of_realization = {times.begin(), times.end()}, .last = last};
}

std::vector<OrderingTime> ordered_at(const std::vector<std::uint64_t>& taps) {
  std::vector<OrderingTime> times;
  for (const std::uint64_t tap : taps) times.push_back({tap, true});
  return times;
}

/// The log-rank statistic of the first n times as textbooks have it: events less those expected,
/// tap by tap, with whoever is at risk counted anew.
double observed_less_expected(const std::vector<OrderingTime>& times, std::size_t n) {
  double difference = 0;
  for (std::uint64_t tap = 0; tap < 1000; ++tap) {
    double events = 0, own_events = 0, at_risk = 0, own_at_risk = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (times[i].tap < tap) continue;
      at_risk += 1;
      own_at_risk += i < n ? 1 : 0;
      if (!times[i].ordered || times[i].tap != tap) continue;
      events += 1;
      own_events += i < n ? 1 : 0;
    }
    if (events > 0) difference += own_events - events * own_at_risk / at_risk;
  }
  return difference;
}

/// By going through all subsets of n of the times.
double brute_force_p(const std::vector<OrderingTime>& times, std::size_t n) {
  const double observed = observed_less_expected(times, n);
  int all = 0, reached = 0;
  for (unsigned subset = 0; subset < 1U << times.size(); ++subset) {
    std::vector<OrderingTime> own, second;
    for (std::size_t i = 0; i < times.size(); ++i)
      ((subset >> i & 1U) != 0 ? own : second).push_back(times[i]);
    if (own.size() != n) continue;
    own.insert(own.end(), second.begin(), second.end());
    ++all;
    reached += observed_less_expected(own, n) >= observed - 1e-9 ? 1 : 0;
  }
  return static_cast<double>(reached) / all;
}

// Remission of leukaemia, weeks; "not ordered": censored. Freireich et al. 1963, Blood 21, 699.
const std::vector<OrderingTime> placebo =
    ordered_at({1, 1, 2, 2, 3, 4, 4, 5, 5, 8, 8, 8, 8, 11, 11, 12, 12, 15, 17, 22, 23});
const std::vector<OrderingTime> treated = {
    {6, true},   {6, true},   {6, true},   {6, false},  {7, true},   {9, false},  {10, true},
    {10, false}, {11, false}, {13, true},  {16, true},  {17, false}, {19, false}, {20, false},
    {22, true},  {23, true},  {25, false}, {32, false}, {32, false}, {34, false}, {35, false}};

}  // namespace

TEST_CASE("A series orders where it first stays at or above the threshold") {
  const std::vector<double> series = {0, 2, 0, 1, 1, 1, 0, 1, 1};
  CHECK(time_to_order(series, 1, 1) == OrderingTime{1, true});
  CHECK(time_to_order(series, 1, 2) == OrderingTime{3, true});
  CHECK(time_to_order(series, 1, 3) == OrderingTime{3, true});
  CHECK(time_to_order(series, 1, 4) == OrderingTime{5, false});
  CHECK(time_to_order(series, 3, 9) == OrderingTime{0, false});
  CHECK(time_to_order(series, 0, 9) == OrderingTime{0, true});
}

TEST_CASE("Limits of a share are Clopper and Pearson's") {
  CHECK(share_limits(0, 3, 0.95).low == 0);
  CHECK(share_limits(0, 3, 0.95).high == Approx(1 - std::cbrt(0.025)).epsilon(1e-9));
  CHECK(share_limits(3, 3, 0.95).high == 1);
  // 3 of 10: sums of binomial probabilities, at either limit.
  const Limits limits = share_limits(3, 10, 0.95);
  double later = 0, less = 0;
  for (int k = 0; k <= 10; ++k) {
    const double ways = std::tgamma(11) / (std::tgamma(k + 1) * std::tgamma(11 - k));
    if (k >= 3) later += ways * std::pow(limits.low, k) * std::pow(1 - limits.low, 10 - k);
    if (k <= 3) less += ways * std::pow(limits.high, k) * std::pow(1 - limits.high, 10 - k);
  }
  CHECK(later == Approx(0.025).epsilon(1e-8));
  CHECK(less == Approx(0.025).epsilon(1e-8));
}

TEST_CASE("Survival is the share that has not ordered, with exact limits") {
  const std::vector<OrderingTime> times = {{5, true}, {2, true}, {9, false}, {5, true}};
  const Survival curve = survival(times, 9);
  CHECK(curve.taps == std::vector<std::uint64_t>{0, 2, 5, 9});
  CHECK(curve.ordered == std::vector<std::uint64_t>{0, 1, 3, 3});
  CHECK(curve.share == std::vector<double>{1, 0.75, 0.25, 0.25});
  CHECK(curve.error[1] == Approx(std::sqrt(0.75 * 0.25 / 4)));
  CHECK(curve.limits[2].low == Approx(1 - std::pow(0.975, 0.25)).epsilon(1e-9));
}

TEST_CASE("The median has limits where enough realizations ordered") {
  const std::vector<OrderingTime> six = ordered_at({10, 20, 30, 40, 50, 60});
  CHECK(median_time(six) == 30);
  CHECK(median_limits(six, 0.95).low == 10);
  CHECK(median_limits(six, 0.95).high == 60);
  const std::vector<OrderingTime> five(six.begin(), six.begin() + 5);
  CHECK(std::isnan(median_limits(five, 0.95).low));
  CHECK(median_limits(five, 0.68).low == 10);
  CHECK(median_limits(std::span(six).first(3), 0.68).high == 30);
  // For ten, 2nd to 9th hold it with 0.979, 3rd to 8th with 0.891.
  std::vector<OrderingTime> ten = ordered_at({1, 2, 3, 4, 5, 6, 7, 8});
  ten.resize(10, {99, false});
  CHECK(median_limits(ten, 0.95).low == 2);
  CHECK(std::isnan(median_limits(ten, 0.95).high));
  CHECK(median_limits(ten, 0.8).high == 8);
  std::vector<OrderingTime> few = ordered_at({7});
  few.resize(4, {99, false});
  CHECK(std::isnan(median_time(few)));
}

TEST_CASE("Log-rank scores add up to events less those expected") {
  std::vector<OrderingTime> times = placebo;
  times.insert(times.end(), treated.begin(), treated.end());
  const std::vector<double> scores = log_rank_scores(times);
  const double sum = std::accumulate(scores.begin(), scores.begin() + 21, 0.0);
  CHECK(sum == Approx(observed_less_expected(times, 21)).epsilon(1e-12));
  // Published of these: 21 events, 10.75 expected.
  CHECK(sum == Approx(21 - 10.75).margin(0.005).epsilon(0));
  CHECK(std::accumulate(scores.begin(), scores.end(), 0.0) == Approx(0).margin(1e-9));
}

TEST_CASE("The test of earlier times goes through all ways of sharing them out") {
  const std::vector<OrderingTime> early = {{3, true}, {5, true}, {9, true}, {40, false}};
  const std::vector<OrderingTime> late = {{5, true}, {30, true}, {40, false}, {40, false}};
  std::vector<OrderingTime> all_times = early;
  all_times.insert(all_times.end(), late.begin(), late.end());
  const EarlierTest test =
      earlier(ensemble_of(early, 40), ensemble_of(late, 40), Streams::independent);
  CHECK(test.p == Approx(brute_force_p(all_times, 4)).epsilon(1e-12));
  CHECK(test.least == Approx(1.0 / 70));

  SECTION("ends of two lengths are cut to the shorter") {
    std::vector<OrderingTime> cut = all_times;
    for (OrderingTime& time : cut)
      if (time.tap > 20) time = {20, false};
    CHECK(earlier(ensemble_of(early, 40), ensemble_of({cut.begin() + 4, cut.end()}, 20),
                  Streams::independent)
              .p == Approx(brute_force_p(cut, 4)).epsilon(1e-12));
  }
  SECTION("pairs change places, and a realization that failed leaves its pair out") {
    OrderingTimes first = ensemble_of(ordered_at({1, 2, 3, 4, 5}), 40);
    const OrderingTimes second = ensemble_of(ordered_at({11, 12, 13, 14, 15}), 40);
    CHECK(earlier(first, second, Streams::matched).p == Approx(1.0 / 32));
    CHECK(earlier(second, first, Streams::matched).p == 1);
    first.of_realization[2].reset();
    CHECK(earlier(first, second, Streams::matched).p == Approx(1.0 / 16));
  }
  SECTION("random ways agree with all of them, and are always the same") {
    const std::vector<OrderingTime> ten = ordered_at({3, 4, 6, 8, 9, 12, 15, 21, 30, 31});
    const std::vector<OrderingTime> second = ordered_at({5, 7, 10, 14, 18, 20, 25, 33, 35, 38});
    const auto p = [&] {
      return earlier(ensemble_of(ten, 40), ensemble_of(second, 40), Streams::independent).p;
    };
    std::vector<OrderingTime> pooled = ten;
    pooled.insert(pooled.end(), second.begin(), second.end());
    const std::vector<double> scores = log_rank_scores(pooled);
    double variance = 0;  // variance of the sum of half of them
    for (const double score : scores) variance += score * score * 10 / (20 - 1.0) * 0.5;
    const double z =
        std::accumulate(scores.begin(), scores.begin() + 10, 0.0) / std::sqrt(variance);
    CHECK(p() == Approx(0.5 * std::erfc(z / std::sqrt(2.0))).margin(0.01).epsilon(0));
    CHECK(p() == p());
  }
}

TEST_CASE("Limits of Weibull's shape come from enough samples") {
  const auto fit = weibull(ordered_at({3, 9, 14, 22, 31, 55}), 1000);
  REQUIRE(fit);
  // Quantiles of (best)/(true) shape of six complete times, from 400 000 samples; within 3 standard
  // errors of 20 000 samples.
  CHECK(fit->shape / fit->shape_95.low == Approx(2.8776).epsilon(3 * 0.0108));
  CHECK(fit->shape / fit->shape_95.high == Approx(0.6368).epsilon(3 * 0.0051));
  CHECK(fit->shape / fit->shape_68.low == Approx(1.7895).epsilon(0.016));
  CHECK(fit->shape / fit->shape_68.high == Approx(0.8481).epsilon(0.009));
}

TEST_CASE("Weibull's law is the one of the largest likelihood") {
  const std::vector<OrderingTime> times = {{12, true}, {30, true},  {31, true}, {50, true},
                                           {55, true}, {60, false}, {60, false}};
  const auto fit = weibull(times, 60);
  REQUIRE(fit);
  const auto likelihood = [&](double shape, double scale) {
    double sum = 0;
    for (const auto& [tap, ordered] : times) {
      const double t = static_cast<double>(tap) - (ordered ? 0.5 : 0), x = t / scale;
      sum -= std::pow(x, shape);
      if (ordered) sum += std::log(shape / t) + shape * std::log(x);
    }
    return sum;
  };
  const double best = likelihood(fit->shape, fit->scale);
  for (const double a : {0.99, 1.0, 1.01}) {
    for (const double b : {0.99, 1.0, 1.01}) {
      if (a != 1 || b != 1) CHECK(likelihood(a * fit->shape, b * fit->scale) < best);
    }
  }
  CHECK(fit->shape_95.low < fit->shape_68.low);
  CHECK(fit->shape_68.high < fit->shape_95.high);
  CHECK_FALSE(weibull(ordered_at({0, 3, 5, 6, 8, 9}), 9));
  CHECK_FALSE(weibull(ordered_at({3, 5, 6, 9}), 9));
  CHECK_FALSE(weibull(ordered_at({3, 3, 5, 5, 5}), 9));
}

TEST_CASE("Growth rates are slopes on t and on its logarithm") {
  GrowthOfSeries on_t, on_decades;
  for (const double slope : {0.5, 1.0, 1.5}) {
    std::vector<double> line = {99}, decades = {-99};
    for (int t = 1; t < 50; ++t) {
      line.push_back(2 + slope * t);
      decades.push_back(2 + slope * std::log10(t));
    }
    on_t.add(line);
    on_decades.add(decades);
  }
  const RealizationMean a = on_t.result().per_tap, b = on_decades.result().per_decade;
  CHECK(a.value == Approx(1).epsilon(1e-10));
  CHECK(a.error.error == Approx(0.5 / std::sqrt(3.0)).epsilon(1e-10));
  CHECK(a.error.dof == 2);
  CHECK(b.value == Approx(1).epsilon(1e-10));
}

TEST_CASE("A comparison names the point that orders first and the one that ends highest") {
  const auto point = [](const char* label, std::uint64_t tap, double value) {
    OrderingPoint result{label, ensemble_of({}, 400), {}, Verdict::reached};
    for (std::uint64_t r = 0; r < 6; ++r) {
      result.times.of_realization.push_back(OrderingTime{tap + r, true});
      result.last_values.push_back(value + 0.001 * static_cast<double>(r));
    }
    return result;
  };
  std::vector<OrderingPoint> points = {point("lift=0.2", 300, 0.66), point("lift=0.3", 40, 0.64),
                                       point("lift=0.4", 150, 0.62)};
  const auto note = [](const Table& table, const std::string& name) {
    for (const auto& [key, text] : table.notes) {
      if (key == name) return text;
    }
    return std::string();
  };
  const ComparedValue value{"bulk_fraction", "1", "301 to 400"};
  const OrderingSettings settings{.threshold = 0.2, .equilibrium = "bulk_fraction"};
  const auto compare = [&] {
    return ordering_comparison("crystalline_fraction", settings, value, points,
                               Streams::independent);
  };
  const Table table = compare();
  CHECK_THAT(note(table, "orders_first"), Catch::StartsWith("lift=0.3; may be first: lift=0.3 ("));
  CHECK_THAT(note(table, "largest_value"), Catch::StartsWith("lift=0.2; may be largest: lift=0.2"));
  CHECK(note(table, "verdict") ==
        "the point that orders first is not the one with the largest value over the last taps (p < "
        "0.05)");

  SECTION("the steadiness of the last taps is reported") {
    points[0].steady = Verdict::cannot_decide;
    points[2].steady = Verdict::cannot_decide;
    CHECK_THAT(note(compare(), "verdict"),
               Catch::EndsWith("; that these are steady is not shown at lift=0.2, lift=0.4"));
  }
  SECTION("one that still drifts may yet become the largest") {
    points[1].steady = Verdict::not_reached;
    CHECK(note(compare(), "verdict") ==
          "undecided whether one point orders first and has the largest value over the last taps: "
          "only this point may, lift=0.3");
  }
  SECTION("one point that does both is named") {
    points[1].last_values = {0.7, 0.701, 0.702, 0.703, 0.704, 0.705};
    CHECK(
        note(compare(), "verdict") ==
        "lift=0.3 orders first and has the largest value over the last taps (no other point may)");
  }
  SECTION("points that order at the same taps are a tie") {
    points[0].times = points[1].times;
    CHECK_THAT(
        note(compare(), "orders_first"),
        Catch::StartsWith("exact tie of lift=0.2, lift=0.3; may be first: lift=0.2, lift=0.3"));
    for (OrderingPoint& ordering_point : points)
      for (auto& time : ordering_point.times.of_realization) time = OrderingTime{0, true};
    CHECK_THAT(note(compare(), "orders_first"),
               Catch::StartsWith("exact tie of lift=0.2, lift=0.3, lift=0.4; "));
  }
  SECTION("three realizations cannot exclude a point") {
    for (OrderingPoint& ordering_point : points) {
      ordering_point.times.of_realization.resize(3);
      ordering_point.last_values.resize(3);
    }
    CHECK_THAT(note(compare(), "orders_first"), Catch::StartsWith("cannot decide"));
    CHECK_THAT(note(compare(), "verdict"), Catch::StartsWith("cannot decide"));
  }
}
