#include "ensemble/analysis/accuracy.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "ensemble/moments.hpp"
#include "ensemble/statistics/jackknife.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline ensemble {

namespace {

double variance(const Moments& moments) {
  const double error = moments.standard_error();
  return error * error * static_cast<double>(moments.count());
}

// Of steps that go on to shrink alike; NaN where they do not shrink.
double rest_of_steps(double step, double step_before) {
  constexpr double slowest = 0.9;
  const double ratio = step / step_before;
  return ratio > 0 && ratio < slowest ? step * ratio / (1 - ratio)
                                      : std::numeric_limits<double>::quiet_NaN();
}

double largest_bias(const SettingCost& setting) {
  return std::abs(setting.bias) + setting.bias_error;
}

}  // namespace

PairedBias paired_bias(std::span<const double> values, std::span<const double> reference) {
  assert(values.size() == reference.size());
  Moments difference, own, others;
  for (std::size_t r = 0; r < values.size(); ++r) {
    if (std::isnan(values[r]) || std::isnan(reference[r])) continue;
    difference.add(values[r] - reference[r]);
    own.add(values[r]);
    others.add(reference[r]);
  }
  return {.pairs = difference.count(),
          .bias = difference.mean(),
          .error = difference.standard_error(),
          .variance_reduction = (variance(own) + variance(others)) / variance(difference)};
}

Growth bias_growth(std::span<const double> values_before, std::span<const double> reference_before,
                   std::span<const double> values, std::span<const double> reference) {
  constexpr double level = 0.95;
  assert(values_before.size() == values.size() && reference_before.size() == values.size());
  std::vector<double> gained(values.size()), of_reference(values.size());
  for (std::size_t r = 0; r < values.size(); ++r) {
    gained[r] = values[r] - values_before[r];
    of_reference[r] = reference[r] - reference_before[r];
  }
  Growth growth{.change = paired_bias(gained, of_reference)};
  const double dof = static_cast<double>(growth.change.pairs) - 1;
  if (!(dof > 0)) {
    growth.tails = growth.least_seen = std::numeric_limits<double>::quiet_NaN();
    return growth;
  }
  const PairedBias& change = growth.change;
  growth.tails = change.error > 0 ? student_tails(change.bias / change.error, dof)
                                  : (change.bias == 0 ? 1.0 : 0.0);
  growth.least_seen = student_two_sided(level, dof) * change.error;
  return growth;
}

bool is_seen(const PairedBias& bias) {
  return std::abs(bias.bias) > 2 * bias.error;
}

Remainder remainder(std::span<const double> two_before, std::span<const double> before,
                    std::span<const double> last) {
  std::vector<double> steps, steps_before;  // of realizations that all three have
  for (std::size_t r = 0; r < last.size(); ++r) {
    const double step = last[r] - before[r], step_before = before[r] - two_before[r];
    if (std::isnan(step) || std::isnan(step_before)) continue;
    steps.push_back(step);
    steps_before.push_back(step_before);
  }
  const std::size_t n = steps.size();
  const double sum = std::accumulate(steps.begin(), steps.end(), 0.0),
               sum_before = std::accumulate(steps_before.begin(), steps_before.end(), 0.0);
  std::vector<double> left_out;
  for (std::size_t r = 0; r < n; ++r) {
    const auto others = static_cast<double>(n - 1);
    left_out.push_back(
        rest_of_steps((sum - steps[r]) / others, (sum_before - steps_before[r]) / others));
  }
  const auto all = static_cast<double>(n);
  return {.value = rest_of_steps(sum / all, sum_before / all), .error = jackknife_error(left_out)};
}

double sigma_limit(std::size_t n_values) {
  if (n_values < 2) return std::numeric_limits<double>::infinity();
  constexpr double share = 0.8;  // of cases in which chi2 is above what is sought
  const auto dof = static_cast<double>(n_values - 1);
  double low = 0, high = dof;  // the median is below dof
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (chi_squared_tail(middle, dof) > share ? low : high) = middle;
  }
  return std::sqrt(dof / low);
}

std::optional<Recommendation> cheapest(std::span<const SettingCost> settings, double target,
                                       double sigma_factor) {
  std::optional<Recommendation> best;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const double bias = largest_bias(settings[i]);
    if (!(bias < target)) continue;
    const double left = target * target - bias * bias;
    const double sigma = sigma_factor * settings[i].sigma;
    const double realizations = std::max(2.0, std::ceil(sigma * sigma / left));
    const double seconds = realizations * settings[i].realization_seconds;
    if (!(realizations < 1e9) || (best && best->core_seconds <= seconds)) continue;
    best = {i, static_cast<std::uint64_t>(realizations), seconds};
  }
  return best;
}

std::vector<std::uint64_t> pareto_front(std::span<const SettingCost> settings) {
  std::vector<std::uint64_t> front;
  for (const SettingCost& one : settings) {
    const bool beaten = std::ranges::any_of(settings, [&](const SettingCost& other) {
      return largest_bias(other) < largest_bias(one) &&
             other.realization_seconds < one.realization_seconds;
    });
    front.push_back(!beaten && !std::isnan(largest_bias(one)));
  }
  return front;
}

}  // namespace jostle::inline ensemble
