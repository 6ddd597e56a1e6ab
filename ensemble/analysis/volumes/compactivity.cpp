#include "ensemble/analysis/volumes/compactivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/numbers.hpp"
#include "ensemble/analysis/volumes/log_ratio.hpp"
#include "ensemble/moments.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "ensemble/statistics/jackknife.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr double least_overlap = 0.02;

/// `value_of` with no realization left out, then each.
template <class Of>
Replicates replicates(std::size_t realizations, const Of& value_of) {
  Replicates found{value_of(realizations), {}};
  for (std::size_t r = 0; realizations > 1 && r < realizations; ++r)
    found.left_out.push_back(value_of(r));
  return found;
}

Replicates sum(const Replicates& a, const Replicates& b, double factor = 1) {
  Replicates total{a.whole + factor * b.whole, a.left_out};
  for (std::size_t r = 0; r < a.left_out.size(); ++r) total.left_out[r] += factor * b.left_out[r];
  return total;
}

// A straight line's change over the series, in deviations about the line; 0 where the values do not
// vary about it, as two never do.
double drift_of(std::span<const double> values, double mean) {
  if (values.size() < 3) return 0;
  const auto n = static_cast<double>(values.size());
  const double middle = 0.5 * (n - 1);
  double covariance = 0, squares = 0;
  for (std::size_t t = 0; t < values.size(); ++t) {
    covariance += (static_cast<double>(t) - middle) * (values[t] - mean);
    squares += (values[t] - mean) * (values[t] - mean);
  }
  const double slope = 12 * covariance / (n * (n * n - 1));
  const double residual_variance = std::max(squares - slope * covariance, 0.0) / n;
  return residual_variance > 0 ? slope * (n - 1) / std::sqrt(residual_variance) : 0;
}

CompactivityStep step_between(std::span<const SteadyVolumes> states, std::size_t start,
                              const VolumeBins& bins) {
  const SteadyVolumes &first = states[start], &second = states[start + 1];
  const std::size_t realizations = first.realizations();
  CompactivityStep step{.start = start, .end = start + 1};
  const auto mean_deviation = [&](std::size_t r) {
    return std::pow(first.variance(r) * second.variance(r), 0.25);
  };
  const double deviation = mean_deviation(realizations);
  step.separation = std::abs(second.mean(realizations) - first.mean(realizations)) / deviation;
  step.fluctuations = replicates(realizations, [&](std::size_t r) {
    return -(second.mean(r) - first.mean(r)) / std::pow(mean_deviation(r), 2);
  });
  const auto histograms = [&](std::size_t r) {
    return std::pair{first.histogram(r, bins.count), second.histogram(r, bins.count)};
  };
  const auto [a, b] = histograms(realizations);
  step.overlap = shared(a, b);
  step.overlaps = true;
  const double centre = 0.5 * (first.mean(realizations) + second.mean(realizations));
  std::vector<LogRatio> ratios;
  for (std::size_t r = 0; r <= (realizations > 1 ? realizations : 0); ++r) {
    const std::size_t left_out = realizations > 1 ? r : realizations;
    const auto [p, q] = histograms(left_out);
    step.overlaps = step.overlaps && shared(p, q) >= least_overlap;
    if (!step.overlaps) return step;
    ratios.push_back(log_ratio(p, q, bins, centre, deviation));
  }
  const auto ratio = [&](std::size_t r) -> const LogRatio& {
    return ratios[std::min(r, ratios.size() - 1)];
  };
  step.histograms = replicates(realizations, [&](std::size_t r) { return -ratio(r).slope; });
  step.curvature = replicates(realizations, [&](std::size_t r) { return -ratio(r).slope_change; });
  return step;
}

}  // namespace

std::size_t VolumeBins::bin_of(double volume) const {
  const double place = (volume - first) / width;
  return place <= 0 ? 0 : std::min(count - 1, static_cast<std::size_t>(place));
}

void SteadyVolumes::add(std::span<const double> volumes) {
  assert(volumes.size() >= 2);
  Moments moments;
  for (const double volume : volumes) moments.add(volume);
  const auto [low, high] = std::ranges::minmax(volumes);
  lowest_ = means_.empty() ? low : std::min(lowest_, low);
  highest_ = means_.empty() ? high : std::max(highest_, high);
  means_.push_back(moments.mean());
  variances_.push_back(moments.sigma() * moments.sigma());
  drifts_.push_back(drift_of(volumes, moments.mean()));
}

void SteadyVolumes::count(std::span<const double> volumes, const VolumeBins& bins) {
  std::vector<double> shares(bins.count, 0.0);
  for (const double volume : volumes) shares[bins.bin_of(volume)] += 1;
  for (double& share : shares) share /= static_cast<double>(volumes.size());
  shares_.push_back(std::move(shares));
}

double SteadyVolumes::mean(std::size_t left_out) const {
  Moments moments;
  for (std::size_t r = 0; r < means_.size(); ++r) {
    if (r != left_out) moments.add(means_[r]);
  }
  return moments.mean();
}

double SteadyVolumes::variance(std::size_t left_out) const {
  Moments means, series_moments;
  for (std::size_t r = 0; r < means_.size(); ++r) {
    if (r == left_out) continue;
    means.add(means_[r]);
    series_moments.add(variances_[r]);
  }
  return series_moments.mean() + means.sigma() * means.sigma();
}

std::vector<double> SteadyVolumes::histogram(std::size_t left_out, std::size_t n_bins) const {
  std::vector<double> all(n_bins, 0.0);
  double counted = 0;
  for (std::size_t r = 0; r < shares_.size(); ++r) {
    if (r == left_out) continue;
    counted += 1;
    for (std::size_t k = 0; k < n_bins; ++k) all[k] += shares_[r][k];
  }
  for (double& share : all) share /= counted;
  return all;
}

VolumeBins volume_bins(std::span<const SteadyVolumes> states) {
  constexpr double bins_a_deviation = 16, most = 1e6;
  double low = std::numeric_limits<double>::infinity(), high = -low, narrowest = low;
  for (const SteadyVolumes& state : states) {
    low = std::min(low, state.lowest());
    high = std::max(high, state.highest());
    narrowest = std::min(narrowest, std::sqrt(state.variance(state.realizations())));
  }
  if (!(narrowest > 0)) throw std::invalid_argument("the volume of a state does not vary");
  const double width = narrowest / bins_a_deviation;
  if (!((high - low) / width < most)) {
    throw std::invalid_argument("the states are too far apart for their histograms to overlap");
  }
  return {low - 0.5 * width, width, static_cast<std::size_t>((high - low) / width) + 2};
}

Jackknifed jackknifed(const Replicates& replicates) {
  const auto n = static_cast<double>(replicates.left_out.size());
  if (n < 2) return {replicates.whole, {}};
  Moments left_out;
  for (const double value : replicates.left_out) left_out.add(value);
  return {n * replicates.whole - (n - 1) * left_out.mean(),
          {jackknife_error(replicates.left_out), n - 1}};
}

LogEstimate variance_of(const SteadyVolumes& state) {
  if (state.realizations() < 2) return no_estimate();
  const Jackknifed found = jackknifed(
      replicates(state.realizations(), [&](std::size_t r) { return std::log(state.variance(r)); }));
  return log_estimate(std::exp(found.value), found.error);
}

Replicates difference_of(const CompactivityStep& step) {
  return sum(step.histograms, step.fluctuations, -1);
}

std::vector<CompactivityStep> compactivity_steps(std::span<const SteadyVolumes> states,
                                                 const VolumeBins& bins) {
  std::vector<CompactivityStep> steps;
  for (std::size_t i = 0; i + 1 < states.size(); ++i)
    steps.push_back(step_between(states, i, bins));
  return steps;
}

std::vector<Jackknifed> inverse_compactivity(std::span<const CompactivityStep> steps,
                                             Replicates CompactivityStep::*estimator) {
  std::vector<Jackknifed> found = {{0, {0, 0}}};
  if (steps.empty()) return found;
  Replicates total{0, std::vector<double>(steps.front().fluctuations.left_out.size(), 0.0)};
  bool goes_on = true;
  for (const CompactivityStep& step : steps) {
    goes_on = goes_on && (step.overlaps || estimator == &CompactivityStep::fluctuations);
    if (goes_on) total = sum(total, step.*estimator);
    found.push_back(goes_on ? jackknifed(total) : Jackknifed{not_a_number, {}});
  }
  return found;
}

Jackknifed drift_together(std::span<const SteadyVolumes> states) {
  if (states.empty()) return {not_a_number, {}};
  Moments drifts;
  for (std::size_t r = 0; r < states.front().realizations(); ++r) {
    double sum = 0;
    for (const SteadyVolumes& state : states) sum += state.drifts()[r];
    drifts.add(sum / static_cast<double>(states.size()));
  }
  Jackknifed drift{drifts.mean(), {}};
  if (drifts.count() > 1)
    drift.error = {drifts.standard_error(), static_cast<double>(drifts.count() - 1)};
  return drift;
}

CompactivityVerdict compactivity_verdict(std::span<const CompactivityStep> steps,
                                         const Jackknifed& drift) {
  CompactivityVerdict verdict;
  verdict.drift_p = p_value(drift.value, drift.error);
  std::vector<double> p;  // difference and curvature of each step in turn
  std::vector<double> detectable;
  std::size_t overlapping = 0;
  for (const CompactivityStep& step : steps) overlapping += step.overlaps;
  const std::size_t realizations =
      steps.empty() ? 0 : std::max<std::size_t>(1, steps.front().fluctuations.left_out.size());
  for (const CompactivityStep& step : steps) {
    if (!step.overlaps) continue;
    verdict.separation = std::max(verdict.separation, step.separation);
    const double size = std::abs(jackknifed(step.fluctuations).value);
    for (const Jackknifed& test : {jackknifed(difference_of(step)), jackknifed(step.curvature)}) {
      p.push_back(p_value(test.value, test.error));
      if (!test.error.known()) continue;
      if (std::isnan(p.back())) {
        detectable.push_back(std::numeric_limits<double>::infinity());
        continue;
      }
      const double level = CompactivityVerdict::level / static_cast<double>(2 * overlapping);
      const double found = test.error.error * smallest_effect_found(level, test.error.dof);
      detectable.push_back(size > 0 ? found / size : std::numeric_limits<double>::infinity());
    }
  }
  const std::vector<double> corrected = corrected_for_number(p);
  for (std::size_t i = 0; i < corrected.size(); ++i) {
    double& least = i % 2 == 0 ? verdict.difference_p : verdict.curvature_p;
    least = std::fmin(least, corrected[i]);
  }
  verdict.detectable = detectable.empty() ? std::numeric_limits<double>::infinity()
                                          : *std::ranges::max_element(detectable);
  const std::string tests =
      std::isnan(verdict.difference_p) || std::isnan(verdict.curvature_p)
          ? fmt::format("no test, for errors are not known, {} realizations", realizations)
          : finite_text("{} of their difference, {} of a bend of ln P_1/P_2, {} realizations",
                        p_text(verdict.difference_p), plain_p_text(verdict.curvature_p),
                        realizations);
  if (overlapping == 0) {
    verdict.statement = "cannot decide: no two neighbours' histograms overlap; take smaller steps";
  } else if (realizations < 2) {
    verdict.statement = "cannot decide with 1 realization: errors need two";
  } else if (std::isnan(verdict.drift_p) && drift.error.known()) {
    verdict.statement = finite_text(
        "cannot decide: the states of all realizations drift by {:.2g} deviations of single taps "
        "over theirs, and without scatter no test is possible ({})",
        drift.value, tests);
  } else if (verdict.drift_p < CompactivityVerdict::level) {
    verdict.statement = finite_text(
        "cannot decide: the states together still drift, by {:.2g} deviations of single taps over "
        "theirs ({}); take later taps ({})",
        drift.value, p_text(verdict.drift_p), tests);
  } else if (std::fmin(verdict.difference_p, verdict.curvature_p) < CompactivityVerdict::level) {
    verdict.statement = fmt::format("disagree: {}", tests);
  } else if (verdict.separation < CompactivityVerdict::least_separation) {
    verdict.statement = finite_text(
        "cannot decide: {} at most {:.2g} deviations apart, where the two would agree for any "
        "distribution; take {} ({})",
        overlapping == steps.size() ? "neighbours are" : "neighbours that overlap are",
        verdict.separation,
        overlapping == steps.size() ? "wider steps" : "steps of 0.5 to 2 deviations", tests);
  } else if (!std::isfinite(verdict.detectable)) {
    verdict.statement =
        fmt::format("cannot decide: {}; no disagreement, however large, would be found", tests);
  } else if (!(verdict.detectable <= CompactivityVerdict::largest_unseen)) {
    verdict.statement = finite_text(
        "cannot decide: {}; the smallest disagreement detected with 80 % power is {:.2g} steps of "
        "1/X",
        tests, verdict.detectable);
  } else {
    verdict.statement = finite_text(
        "agree: {}; the smallest disagreement detected with 80 % power is {:.2g} steps of 1/X",
        tests, verdict.detectable);
  }
  return verdict;
}

}  // namespace jostle::inline ensemble
