#include "ensemble/analysis/accuracy.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "ensemble/moments.hpp"
#include "ensemble/statistics/jackknife.hpp"
#include "ensemble/statistics/student_tests.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline ensemble {

namespace {

double variance(const Moments& moments) {
  const double error = moments.standard_error();
  return error * error * static_cast<double>(moments.count());
}

// For steps that go on to shrink alike; NaN where they do not shrink.
double rest_of_steps(double step, double step_before) {
  constexpr double slowest = 0.9;
  const double ratio = step / step_before;
  return ratio > 0 && ratio < slowest ? step * ratio / (1 - ratio)
                                      : std::numeric_limits<double>::quiet_NaN();
}

double largest_bias(const SettingCost& setting) {
  return std::abs(setting.bias) + setting.bias_error;
}

// Over the settings that are counted; NaN without any.
double root_mean_square(std::span<const SettingCost> settings,
                        std::span<const std::uint64_t> is_counted, double SettingCost::*member) {
  double squares = 0, n = 0;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const double value = settings[i].*member;
    if (!is_counted[i] || !std::isfinite(value)) continue;
    squares += value * value;
    ++n;
  }
  return std::sqrt(squares / n);
}

// For Student's t of so many pairs, exceeded once in five times.
double limit_of_t(std::size_t pairs) {
  return pairs < 2 ? std::numeric_limits<double>::infinity()
                   : student_two_sided(0.6, static_cast<double>(pairs - 1));
}

// Limit of the remaining bias of the reference; NaN where steps are not known to shrink.
double shortfall_limit(const Pilot& pilot, double least_error) {
  const auto doubt = [&](const PairedBias& step) {
    return limit_of_t(step.pairs) * std::max(step.error, least_error);
  };
  const double last = std::abs(pilot.last_step.bias) + doubt(pilot.last_step);
  if (!is_seen(pilot.last_step)) return last;
  const double previous = std::abs(pilot.step_before.bias) - doubt(pilot.step_before);
  const double rest = rest_of_steps(last, previous);
  return rest < last ? last : rest;
}

}  // namespace

PairedBias paired_bias(std::span<const double> values, std::span<const double> reference) {
  assert(values.size() == reference.size());
  Moments difference, own, other_moments;
  for (std::size_t r = 0; r < values.size(); ++r) {
    if (std::isnan(values[r]) || std::isnan(reference[r])) continue;
    difference.add(values[r] - reference[r]);
    own.add(values[r]);
    other_moments.add(reference[r]);
  }
  return {.pairs = difference.count(),
          .bias = difference.mean(),
          .error = difference.standard_error(),
          .variance_reduction = (variance(own) + variance(other_moments)) / variance(difference)};
}

Growth bias_growth(std::span<const double> values_before, std::span<const double> reference_before,
                   std::span<const double> values, std::span<const double> reference) {
  assert(values_before.size() == values.size() && reference_before.size() == values.size());
  std::vector<double> gained(values.size()), of_reference(values.size());
  for (std::size_t r = 0; r < values.size(); ++r) {
    gained[r] = values[r] - values_before[r];
    of_reference[r] = reference[r] - reference_before[r];
  }
  Growth growth{.change = paired_bias(gained, of_reference)};
  const double dof = static_cast<double>(growth.change.pairs) - 1;
  if (!(dof > 0)) {
    growth.tails = growth.detectable = std::numeric_limits<double>::quiet_NaN();
    return growth;
  }
  const PairedBias& change = growth.change;
  growth.tails = p_value(change.bias, {change.error, dof});
  growth.detectable = smallest_effect_found(significance_level, dof) * change.error;
  return growth;
}

bool is_seen(const PairedBias& bias) {
  return p_value(bias.bias, {bias.error, static_cast<double>(bias.pairs) - 1}) < significance_level;
}

Remainder remainder(std::span<const double> two_before, std::span<const double> previous,
                    std::span<const double> last) {
  std::vector<double> steps, steps_before;  // from realizations that all three have
  for (std::size_t r = 0; r < last.size(); ++r) {
    const double step = last[r] - previous[r], step_before = previous[r] - two_before[r];
    if (std::isnan(step) || std::isnan(step_before)) continue;
    steps.push_back(step);
    steps_before.push_back(step_before);
  }
  const std::size_t n = steps.size();
  const double sum = std::accumulate(steps.begin(), steps.end(), 0.0),
               sum_before = std::accumulate(steps_before.begin(), steps_before.end(), 0.0);
  std::vector<double> left_out;
  for (std::size_t r = 0; r < n; ++r) {
    const auto n_others = static_cast<double>(n - 1);
    left_out.push_back(
        rest_of_steps((sum - steps[r]) / n_others, (sum_before - steps_before[r]) / n_others));
  }
  const auto all = static_cast<double>(n);
  return {.realizations = n,
          .value = rest_of_steps(sum / all, sum_before / all),
          .error = jackknife_error(left_out)};
}

double sigma_limit(std::size_t n_values) {
  if (n_values < 2) return std::numeric_limits<double>::infinity();
  constexpr double share = 0.8;  // share of cases in which chi2 is above what is sought
  const auto dof = static_cast<double>(n_values - 1);
  double low = 0, high = dof;  // the median is below dof
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (chi_squared_tail(middle, dof) > share ? low : high) = middle;
  }
  return std::sqrt(dof / low);
}

std::optional<Recommendation> cheapest(std::span<const SettingCost> settings, double target) {
  std::optional<Recommendation> best;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const double bias = largest_bias(settings[i]);
    if (!(bias < target)) continue;
    const double left = target * target - bias * bias;
    const double sigma = settings[i].sigma;
    const double realizations = std::max(2.0, std::ceil(sigma * sigma / left));
    const double seconds = realizations * settings[i].realization_seconds;
    if (!(realizations < 1e9) || (best && best->core_seconds <= seconds)) continue;
    best = {i, static_cast<std::uint64_t>(realizations), seconds};
  }
  return best;
}

void pool_sigma(std::span<SettingCost> settings, const Pilot& pilot) {
  double squares = 0, dof = 0;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const SettingCost& setting = settings[i];
    if (!pilot.has_beds[i] || setting.values < 2 || !std::isfinite(setting.sigma)) continue;
    squares += static_cast<double>(setting.values - 1) * setting.sigma * setting.sigma;
    dof += static_cast<double>(setting.values - 1);
  }
  const double pooled = std::sqrt(squares / dof);
  for (std::size_t i = 0; i < settings.size(); ++i)
    if (pilot.has_beds[i] && std::isfinite(settings[i].sigma)) settings[i].sigma = pooled;
}

std::vector<SettingCost> at_limits(std::span<const SettingCost> settings, const Pilot& pilot) {
  std::vector<std::uint64_t> other_beds = pilot.has_beds;
  other_beds[pilot.reference] = 0;
  const double least_error = root_mean_square(settings, other_beds, &SettingCost::bias_error);
  const double lacking = shortfall_limit(pilot, least_error);
  std::vector<SettingCost> limits(settings.begin(), settings.end());
  for (std::size_t i = 0; i < limits.size(); ++i) {
    SettingCost& setting = limits[i];
    const double error =
        pilot.has_beds[i] ? std::max(setting.bias_error, least_error) : setting.bias_error;
    setting.bias = i == pilot.reference
                       ? lacking
                       : std::abs(setting.bias) + limit_of_t(setting.pairs) * error + lacking;
    setting.bias_error = 0;
    setting.sigma *= sigma_limit(setting.values);
  }
  return limits;
}

std::vector<std::uint64_t> pareto_front(std::span<const SettingCost> settings) {
  std::vector<std::uint64_t> front;
  for (const SettingCost& setting : settings) {
    const bool beaten = std::ranges::any_of(settings, [&](const SettingCost& rival) {
      return largest_bias(rival) < largest_bias(setting) &&
             rival.realization_seconds < setting.realization_seconds;
    });
    front.push_back(!beaten && !std::isnan(largest_bias(setting)));
  }
  return front;
}

}  // namespace jostle::inline ensemble
