#include "ensemble/analysis/ordering/weibull.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "engine/bed/random.hpp"

namespace jostle::inline ensemble {

namespace {

/// Logarithms of the times that ended, and of those that did not.
struct LogTimes {
  std::vector<double> ended, censored;
};

/// For the largest t^shape as unit: sums of t^shape, t^shape ln t and t^shape (ln t)^2 over all.
struct PowerSums {
  double power = 0, with_log = 0, with_square = 0, unit = 0;
};
PowerSums power_sums(const LogTimes& times, double shape) {
  PowerSums sums;
  for (const auto* list : {&times.ended, &times.censored}) {
    for (const double log : *list) sums.unit = std::max(sums.unit, shape * log);
  }
  for (const auto* list : {&times.ended, &times.censored}) {
    for (const double log : *list) {
      const double power = std::exp(shape * log - sums.unit);
      sums.power += power;
      sums.with_log += power * log;
      sums.with_square += power * log * log;
    }
  }
  return sums;
}

/// The shape that maximizes the likelihood: where the mean of ln t weighted by t^shape, less
/// 1/shape, which rises with it, is the mean of ln t over those that ended. By Newton's steps in ln
/// shape, and by bisection where a step leaves the bracket.
double best_shape(const LogTimes& times) {
  double mean = 0;
  for (const double log : times.ended) mean += log;
  mean /= static_cast<double>(times.ended.size());
  constexpr double tolerance = 1e-10;
  double low = std::log(1e-3), high = std::log(1e4), place = 0;
  for (int turn = 0; turn < 50 && high - low > tolerance; ++turn) {
    const double shape = std::exp(place);
    const PowerSums sums = power_sums(times, shape);
    const double weighted = sums.with_log / sums.power;
    const double excess = weighted - 1 / shape - mean;
    const double slope = shape * (sums.with_square / sums.power - weighted * weighted) + 1 / shape;
    (excess < 0 ? low : high) = place;
    const double next = place - excess / slope;
    if (std::abs(next - place) < tolerance) return std::exp(next);
    place = next > low && next < high ? next : 0.5 * (low + high);
  }
  return std::exp(place);
}

constexpr std::size_t fewest = 5, fewest_different = 3;  // times that ended

/// Best shapes of samples of n times whose true one and scale are 1, censored at `end`; ascending.
std::vector<double> shapes_of_samples(std::size_t n, double end) {
  // 20 000 samples give the probability beyond a 95 % limit to 0.0011, 2000 to 0.0035.
  const std::size_t wanted = std::clamp<std::size_t>(2'000'000 / n, 2000, 20'000);
  RandomStream random(stream_key(1, 0, 0, Purpose::resampling));
  std::vector<double> shapes;
  while (shapes.size() < wanted) {
    LogTimes times;
    for (std::size_t i = 0; i < n; ++i) {
      const double t = -std::log(random.uniform());
      (t <= end ? times.ended : times.censored).push_back(std::log(std::min(t, end)));
    }
    if (times.ended.size() >= fewest) shapes.push_back(best_shape(times));
  }
  std::ranges::sort(shapes);
  return shapes;
}

double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size()) - 0.5;
  const double inside = std::clamp(place, 0.0, static_cast<double>(sorted.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(inside), sorted.size() - 2);
  return sorted[i] + (inside - static_cast<double>(i)) * (sorted[i + 1] - sorted[i]);
}

}  // namespace

std::optional<WeibullFit> weibull(std::span<const OrderingTime> times, std::uint64_t last) {
  LogTimes logs;
  std::set<std::uint64_t> different;
  for (const OrderingTime& time : times) {
    if (time.ordered && time.tap == 0) return std::nullopt;
    const auto tap = static_cast<double>(time.tap);
    if (time.ordered) {
      different.insert(time.tap);
      logs.ended.push_back(std::log(tap - 0.5));
    } else if (time.tap > 0) {
      logs.censored.push_back(std::log(tap));
    }
  }
  if (logs.ended.size() < fewest || different.size() < fewest_different) return std::nullopt;
  WeibullFit fit;
  fit.shape = best_shape(logs);
  const PowerSums sums = power_sums(logs, fit.shape);
  const auto seen = static_cast<double>(logs.ended.size());
  fit.scale = std::exp((std::log(sums.power / seen) + sums.unit) / fit.shape);
  const std::vector<double> ratios =
      shapes_of_samples(times.size(), std::pow(static_cast<double>(last) / fit.scale, fit.shape));
  const auto limits = [&](double level) {
    const double tail = 0.5 * (1 - level);
    return Limits{fit.shape / quantile(ratios, 1 - tail), fit.shape / quantile(ratios, tail)};
  };
  fit.shape_68 = limits(0.6827);
  fit.shape_95 = limits(0.95);
  const auto rank = std::ranges::lower_bound(ratios, fit.shape) - ratios.begin();
  const double share = (static_cast<double>(rank) + 0.5) / static_cast<double>(ratios.size() + 1);
  fit.memoryless_p = std::min(1.0, 2 * std::min(share, 1 - share));
  return fit;
}

}  // namespace jostle::inline ensemble
