#include "ensemble/statistics/mean_error.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "ensemble/moments.hpp"
#include "fitting/fit.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr double prior_of_white = 0.5;
constexpr double shortest = 0.3, longest = 0.5;  // steps; of the series
constexpr int n_times = 28;
constexpr double shares[] = {1, 0.8, 0.65, 0.5, 0.35, 0.25, 0.15, 0.1, 0.05, 0.025};
constexpr double prior_of_whole = 0.4, prior_of_other = 0.6 / 9;  // shares
constexpr double negligible = 1e-9;                               // weight of a memory

/// One memory, and the mean if it were true.
struct Candidate {
  double weight = 0;    // ln until all are known
  double error = 0;     // standard error of the mean
  double variance = 0;  // variance of the mean, in variances of a value
};

// Variance of the mean of n values of correlation share kept^lag.
double variance_of_mean(double n, double kept, double share) {
  const double pairs =
      n * (1 + kept) / (1 - kept) - 2 * kept * (1 - std::pow(kept, n)) / ((1 - kept) * (1 - kept));
  return (share * pairs / n + (1 - share)) / n;
}

// The likelihood of the series with mean and variance integrated out, by the innovations of a
// Kalman filter (Jones 1980, Technometrics 22, 389). kept: correlation of neighbours of the share.
Candidate candidate(const std::vector<double>& deviations, double kept, double share,
                    double prior) {
  double state_one = 0, state = 0, variance = share, determinant = 0;
  double ones = 0, products = 0, squares = 0;
  for (const double deviation : deviations) {
    const double spread = variance + 1 - share;
    const double surprise_one = 1 - state_one, surprise = deviation - state;
    ones += surprise_one * surprise_one / spread;
    products += surprise_one * surprise / spread;
    squares += surprise * surprise / spread;
    determinant += std::log(spread);
    const double gain = variance / spread;
    state_one = kept * (state_one + gain * surprise_one);
    state = kept * (state + gain * surprise);
    variance = kept * kept * variance * (1 - share) / spread + share * (1 - kept * kept);
  }
  const auto n = static_cast<double>(deviations.size());
  const double of_value = std::max((squares - products * products / ones) / (n - 1), 1e-300);
  const double of_mean = variance_of_mean(n, kept, share);
  return {std::log(prior) - 0.5 * (determinant + std::log(ones) + (n - 1) * std::log(of_value)),
          std::sqrt(of_value * of_mean), of_mean};
}

// The weights add up to 1; candidates of negligible weight are left out.
void normalize(std::vector<Candidate>& candidates) {
  double highest = candidates.front().weight, sum = 0;
  for (const Candidate& c : candidates) highest = std::max(highest, c.weight);
  for (Candidate& c : candidates) sum += c.weight = std::exp(c.weight - highest);
  for (Candidate& c : candidates) c.weight /= sum;
  std::erase_if(candidates, [](const Candidate& c) { return c.weight < negligible; });
}

// Where the deviation of the mean exceeds it with probability 1 - level.
double limit(const std::vector<Candidate>& candidates, double level, double dof) {
  double low = candidates.front().error, high = low;
  for (const Candidate& c : candidates) {
    low = std::min(low, c.error);
    high = std::max(high, c.error);
  }
  const double t = student_two_sided(level, dof);
  low *= t;
  high *= t;
  while (high - low > 1e-9 * high) {
    const double middle = 0.5 * (low + high);
    double beyond = 0;
    for (const Candidate& c : candidates) beyond += c.weight * student_tails(middle / c.error, dof);
    (beyond > 1 - level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Student's t with the limits of 68 and 95 %; of at least one degree of freedom.
ErrorOf student_of(double at_68, double at_95, double most) {
  double low = 1, high = most;
  const auto quantile = [](std::size_t level, double dof) {
    return student_two_sided(interval_levels[level], dof);
  };
  while (high - low > 1e-6 * high) {
    const double middle = std::sqrt(low * high);
    (quantile(1, middle) / quantile(0, middle) > at_95 / at_68 ? low : high) = middle;
  }
  const double dof = std::sqrt(low * high);
  return {std::max(at_68 / quantile(0, dof), at_95 / quantile(1, dof)), dof};
}

}  // namespace

MeanError mean_error(std::span<const double> series) {
  assert(series.size() >= 3);
  const auto n = static_cast<double>(series.size());
  Moments all;
  for (const double value : series) all.add(value);
  if (all.sigma() == 0) return {{0, n - 1}, n};
  std::vector<double> deviations;
  for (const double value : series) deviations.push_back((value - all.mean()) / all.sigma());
  std::vector<Candidate> candidates = {candidate(deviations, 0, 0, prior_of_white)};
  for (int i = 0; i < n_times; ++i) {
    const double time = shortest * std::pow(longest * n / shortest, i / (n_times - 1.0));
    for (const double share : shares) {
      const double prior = share == 1 ? prior_of_whole : prior_of_other;
      candidates.push_back(candidate(deviations, std::exp(-1 / time), share,
                                     (1 - prior_of_white) * prior / n_times));
    }
  }
  normalize(candidates);
  double of_mean = 0;
  for (const Candidate& c : candidates) of_mean += c.weight * c.variance;
  ErrorOf error = student_of(limit(candidates, interval_levels[0], n - 1),
                             limit(candidates, interval_levels[1], n - 1), n - 1);
  error.error *= all.sigma();
  return {error, 1 / of_mean};
}

}  // namespace jostle::inline ensemble
