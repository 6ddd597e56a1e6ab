#include "ensemble/analysis/ordering/times.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/numbers.hpp"
#include "ensemble/moments.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline ensemble {

namespace {

// For at least k of n, each with probability p: the incomplete beta function I_p(k, n - k + 1).
double at_least(std::uint64_t k, std::uint64_t n, double p) {
  if (k == 0) return 1;
  if (p <= 0) return 0;
  const auto a = static_cast<double>(k), b = static_cast<double>(n - k + 1);
  return fisher_tail(a * (1 - p) / (b * p), 2 * b, 2 * a);
}

// Where a rising function of p in (0, 1) reaches a value.
template <class Function>
double inverse(const Function& rising, double value) {
  double low = 0, high = 1;
  for (int turn = 0; turn < 60; ++turn) {
    const double middle = 0.5 * (low + high);
    (rising(middle) < value ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Those that ordered, ascending.
std::vector<std::uint64_t> ordered_taps(std::span<const OrderingTime> times) {
  std::vector<std::uint64_t> taps;
  for (const OrderingTime& time : times) {
    if (time.ordered) taps.push_back(time.tap);
  }
  std::ranges::sort(taps);
  return taps;
}

// Slope by least squares with weights.
template <class Place, class Weight>
double slope(std::span<const double> series, const Place& place, const Weight& weight) {
  double sum = 0, mean_x = 0, mean_y = 0, xx = 0, xy = 0;
  for (std::size_t t = 1; t < series.size(); ++t) {
    const double w = weight(static_cast<double>(t)), x = place(static_cast<double>(t));
    sum += w;
    const double dx = x - mean_x, dy = series[t] - mean_y;
    mean_x += dx * w / sum;
    mean_y += dy * w / sum;
    xx += w * dx * (x - mean_x);
    xy += w * dx * (series[t] - mean_y);
  }
  return xy / xx;
}

}  // namespace

OrderingTime time_to_order(std::span<const double> series, double threshold, std::uint64_t hold) {
  assert(hold >= 1 && hold <= series.size());
  std::uint64_t n_above = 0;
  for (std::size_t t = 0; t < series.size(); ++t) {
    n_above = series[t] >= threshold ? n_above + 1 : 0;
    if (n_above == hold) return {t + 1 - hold, true};
  }
  return {series.size() - hold, false};
}

Limits share_limits(std::uint64_t k, std::uint64_t n, double level) {
  const double tail = 0.5 * (1 - level);
  const auto greater = [&](double p) { return at_least(k, n, p); };
  const auto less = [&](double p) { return at_least(k + 1, n, p); };
  return {k == 0 ? 0 : inverse(greater, tail), k == n ? 1 : inverse(less, 1 - tail)};
}

Survival survival(std::span<const OrderingTime> times, std::uint64_t last) {
  const std::vector<std::uint64_t> events = ordered_taps(times);
  const auto n = static_cast<double>(times.size());
  Survival curve;
  curve.taps = events;
  curve.taps.insert(curve.taps.end(), {0, last});
  std::ranges::sort(curve.taps);
  const auto repeated = std::ranges::unique(curve.taps);
  curve.taps.erase(repeated.begin(), repeated.end());
  for (const std::uint64_t tap : curve.taps) {
    const auto so_far =
        static_cast<std::uint64_t>(std::ranges::upper_bound(events, tap) - events.begin());
    const double share = 1 - static_cast<double>(so_far) / n;
    curve.ordered.push_back(so_far);
    curve.share.push_back(share);
    curve.error.push_back(std::sqrt(share * (1 - share) / n));
    curve.limits.push_back(share_limits(times.size() - so_far, times.size(), 0.95));
  }
  return curve;
}

double median_time(std::span<const OrderingTime> times) {
  const std::vector<std::uint64_t> events = ordered_taps(times);
  const std::size_t half = (times.size() + 1) / 2;
  return events.size() < half ? not_a_number : static_cast<double>(events[half - 1]);
}

Limits median_limits(std::span<const OrderingTime> times, double level) {
  const std::vector<std::uint64_t> events = ordered_taps(times);
  const std::uint64_t n = times.size();
  // The rank-th time is above the median where fewer than `rank` are at or below it.
  std::uint64_t rank = 0;
  while (rank < n / 2 && 1 - at_least(rank + 1, n, 0.5) <= 0.5 * (1 - level)) ++rank;
  const auto time = [&](std::uint64_t order_index) {
    return order_index >= 1 && order_index <= events.size()
               ? static_cast<double>(events[order_index - 1])
               : not_a_number;
  };
  if (rank == 0) return {not_a_number, not_a_number};
  return {time(rank), time(n + 1 - rank)};
}

void GrowthOfSeries::add(std::span<const double> series) {
  assert(series.size() >= 4);
  decades_.push_back(slope(
      series, [](double t) { return std::log10(t); }, [](double t) { return 1 / t; }));
  taps_.push_back(slope(
      series, [](double t) { return t; }, [](double) { return 1.0; }));
}

GrowthRates GrowthOfSeries::result() const {
  return {mean_of(decades_), mean_of(taps_)};
}

RealizationMean mean_of(std::span<const double> values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  if (moments.count() < 2) return {moments.mean(), {}};
  return {moments.mean(), {moments.standard_error(), static_cast<double>(moments.count() - 1)}};
}

}  // namespace jostle::inline ensemble
