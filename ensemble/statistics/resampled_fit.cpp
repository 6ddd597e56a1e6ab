#include "ensemble/statistics/resampled_fit.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/bed/random.hpp"
#include "ensemble/parallel.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline ensemble {

namespace {

// How often each realization counts in resample number `index`, [n_realizations].
std::vector<double> multiplicities(const RealizationCurves& curves, std::uint32_t index,
                                   const ResamplingOptions& options) {
  if (options.kind == Resampling::jackknife) {
    std::vector<double> weights(curves.realizations, 1.0);
    weights[index] = 0;
    return weights;
  }
  std::vector<double> weights(curves.realizations, 0.0);
  RandomStream random(stream_key(options.seed, 0, index, Purpose::resampling));
  for (std::uint32_t i = 0; i < curves.realizations; ++i) {
    weights[random.integer_below(curves.realizations)] += 1;
  }
  return weights;
}

// Differences from the first realization keep the digits of small fluctuations.
std::vector<double> weighted_means(const RealizationCurves& curves,
                                   const std::vector<double>& weights) {
  double total = 0;
  for (double weight : weights) total += weight;
  std::vector<double> means;
  means.reserve(curves.t.size());
  for (std::size_t i = 0; i < curves.t.size(); ++i) {
    const double* row = curves.values.data() + i * curves.realizations;
    double sum = 0;
    for (std::uint32_t r = 0; r < curves.realizations; ++r) sum += weights[r] * (row[r] - row[0]);
    means.push_back(row[0] + sum / total);
  }
  return means;
}

FitOptions refit_options(const Fit& fit) {
  FitOptions options;
  options.start = fit.values();
  options.multi_start = false;
  options.profiles = false;
  options.memory = false;
  for (const Estimate& estimate : fit.estimates) {
    if (estimate.identifiability == Identifiability::fixed) {
      options.fixed[estimate.parameter.name] = estimate.value;
    }
  }
  // Far below the errors sought.
  options.solver.cost_tolerance = 1e-10;
  options.solver.polish = false;
  return options;
}

double standard_deviation(const std::vector<double>& values, double divisor) {
  double mean = 0, sum = 0;
  for (double value : values) mean += value / static_cast<double>(values.size());
  for (double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / divisor);
}

// Linear between order statistics.
double quantile(const std::vector<double>& sorted, double share) {
  const double rank = share * static_cast<double>(sorted.size() - 1);
  const auto lower = static_cast<std::size_t>(rank);
  const std::size_t upper = std::min(lower + 1, sorted.size() - 1);
  return sorted[lower] + (rank - static_cast<double>(lower)) * (sorted[upper] - sorted[lower]);
}

Interval central_interval(const std::vector<double>& sorted, double level) {
  return {quantile(sorted, 0.5 * (1 - level)), quantile(sorted, 0.5 * (1 + level))};
}

/// The interval of a bootstrap about the value of all realizations, as much longer as Student's t
/// exceeds the normal quantile, and times `widening`; of a positive parameter on a logarithmic
/// scale.
Interval stretched(const Interval& interval, const Estimate& estimate, double widening,
                   double level, double dof) {
  const double factor = widening * student_two_sided(level, dof) / normal_two_sided(level);
  const double value = estimate.value;
  if (estimate.parameter.lower >= 0 && interval.lower > 0 && value > 0)
    return {value * std::pow(interval.lower / value, factor),
            value * std::pow(interval.upper / value, factor)};
  return {value - factor * (value - interval.lower), value + factor * (interval.upper - value)};
}

void add_parameter(std::vector<double> values, const Estimate& estimate, Resampling kind,
                   std::uint32_t realizations, ResampledErrors& errors) {
  const auto n = static_cast<double>(values.size());
  if (values.size() < 2) {
    errors.errors.push_back(std::numeric_limits<double>::infinity());
    return;
  }
  // Tukey 1958: leaving one out moves an estimate by 1/(n - 1) of what redrawing it would.
  const double divisor = kind == Resampling::jackknife ? n / (n - 1) : n - 1;
  const double error = standard_deviation(values, divisor);
  if (kind == Resampling::jackknife) return errors.errors.push_back(error);
  // Means of M realizations drawn from M have (M - 1)/M of the variance of the mean.
  const double dof = realizations - 1, widening = std::sqrt(realizations / dof);
  errors.errors.push_back(error * widening);
  std::sort(values.begin(), values.end());
  for (auto [level, intervals] : {std::pair(interval_levels[0], &errors.middle),
                                  std::pair(interval_levels[1], &errors.central)})
    intervals->push_back(
        stretched(central_interval(values, level), estimate, widening, level, dof));
}

}  // namespace

Curve mean_curve(const RealizationCurves& curves) {
  return {curves.t, weighted_means(curves, std::vector<double>(curves.realizations, 1.0)),
          curves.sigma};
}

ResampledErrors resample(const Model& model, const RealizationCurves& curves, const Fit& fit,
                         const ResamplingOptions& options) {
  assert(curves.realizations >= 2 && curves.values.size() == curves.t.size() * curves.realizations);
  ResampledErrors result;
  result.resamples = options.kind == Resampling::jackknife ? curves.realizations : options.count;
  const FitOptions refit = refit_options(fit);
  std::vector<std::optional<ParameterValues>> found(result.resamples);
  std::atomic<std::uint32_t> next{0};
  on_threads(options.threads, [&] {
    for (std::uint32_t i = next++; i < result.resamples; i = next++) {
      const Curve curve{curves.t, weighted_means(curves, multiplicities(curves, i, options)),
                        curves.sigma};
      const auto refitted = jostle::fit(model, curve, refit);
      const Fit* good = std::get_if<Fit>(&refitted);
      if (good && is_minimum(good->reason)) found[i] = good->values();
    }
  });
  for (std::size_t j = 0; j < fit.estimates.size(); ++j) {
    std::vector<double> values;
    for (const auto& parameters : found) {
      if (parameters) values.push_back((*parameters)[j]);
    }
    result.failed = result.resamples - static_cast<std::uint32_t>(values.size());
    add_parameter(std::move(values), fit.estimates[j], options.kind, curves.realizations, result);
  }
  return result;
}

}  // namespace jostle::inline ensemble
