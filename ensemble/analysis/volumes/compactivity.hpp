#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/numbers.hpp"
#include "ensemble/statistics/log_estimate.hpp"
#include "ensemble/statistics/student_tests.hpp"

// Volumes of steady states and the compactivity X of Edwards & Oakeshott 1989,
// doi:10.1016/0378-4371(89)90034-4: where a volume V is found with probability
// D(V) exp(-V/X) / Z(X), with one density of states D for all strengths. Volumes are in volumes of
// a sphere, and so is X.
namespace jostle::inline ensemble {

/// Bins of equal width that all histograms share.
struct VolumeBins {
  double first = 0, width = 0;  // the lower end of the first
  std::size_t count = 0;
  std::size_t bin_of(double volume) const;
  double middle(std::size_t bin) const { return first + (static_cast<double>(bin) + 0.5) * width; }
};

/// The steady state at one strength. Filled in two passes, so that no series need be kept.
class SteadyVolumes {
 public:
  /// The first pass: a realization's series, [n >= 2].
  void add(std::span<const double> volumes);
  /// The second pass, the same series in the same order.
  void count(std::span<const double> volumes, const VolumeBins& bins);

  std::size_t realizations() const { return means_.size(); }
  /// Mean over the realizations but `left_out` (none: realizations()), each counted alike.
  double mean(std::size_t left_out) const;
  /// About that mean: within the series and between them, sum of squares over their number.
  double variance(std::size_t left_out) const;
  /// Change of a straight line through each series from its first to its last value, in
  /// deviations of the series about it, [realizations].
  const std::vector<double>& drifts() const { return drifts_; }
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }
  /// Share of the volumes in each bin, [n_bins].
  std::vector<double> histogram(std::size_t left_out, std::size_t n_bins) const;

 private:
  std::vector<double> means_, variances_, drifts_;  // [realizations]; variances about the own mean
  std::vector<std::vector<double>> shares_;
  double lowest_ = 0, highest_ = 0;
};

/// Sixteen a deviation of the narrowest state. Throws std::invalid_argument where a state does not
/// vary, or the states lie so far apart that the bins would be more than a million.
VolumeBins volume_bins(std::span<const SteadyVolumes> states);

/// An estimate from all realizations, and with each left out in turn.
struct Replicates {
  double whole = 0;
  std::vector<double> left_out{};  // [realizations]
};

/// By the jackknife over realizations, without its bias of order 1/M: for a variance about the mean
/// of finite series all of it, for 1/variance the leading part.
struct Jackknifed {
  double value = 0;
  ErrorOf error{};  // M - 1 degrees of freedom; none below two realizations
};
Jackknifed jackknifed(const Replicates& replicates);

/// The variance of a state likewise, of its logarithm: variances of few values are skewed. NaN
/// below two realizations.
LogEstimate variance_of(const SteadyVolumes& state);

/// 1/X of the second state less that of the first, in 1/(volumes of a sphere), by two estimators.
struct CompactivityStep {
  std::size_t start = 0, end = 0;  // states
  double separation = 0;           // separation of the mean volumes, in deviations
  double overlap = 0;              // sum over bins of the smaller share: 1 of equal histograms
  /// True if the overlap is sufficient for histograms without any single realization.
  bool overlaps = false;
  /// -(V_2 - V_1) / (s_1 s_2), s^2 the variance: the integral of -dV / var(V) (Nowak et al. 1998,
  /// doi:10.1103/PhysRevE.57.1971) with the mean of 1/var taken geometrically, which is exact where
  /// the variance is constant and where it grows as (V - V_min)^2.
  Replicates fluctuations{};
  /// The slope of ln[P_1(V) / P_2(V)] against V (Dean & Lefevre 2003,
  /// doi:10.1103/PhysRevLett.90.198301), a straight line fitted to the counts by maximum
  /// likelihood (logistic regression).
  Replicates histograms{};
  /// For a parabola fitted to ln[P_1 / P_2] likewise: what its slope changes by over a deviation,
  /// in the units of 1/X. 0 where one density of states serves both.
  Replicates curvature{};
};

/// Comparison of the two estimators and of Edwards' form.
struct CompactivityVerdict {
  /// Smallest over the steps, corrected (Holm 1979); NaN without a test.
  double difference_p = not_a_number, curvature_p = not_a_number;
  double detectable = 0;  // largest over the steps: disagreement or curvature, over the largest
                          // step of 1/X, that would have been found with probability 0.8
  double separation = 0;  // separation at the widest step that overlaps
  double drift_p = 1;     // p-value for no drift of all states together; NaN for one realization
  std::string statement;  // "agree", "disagree" or "cannot decide", and why

  static constexpr double level = significance_level;  // false alarms, all tests together
  static constexpr double largest_unseen = 0.5;        // relative
  static constexpr double least_separation = 0.5;      // deviations
};

/// Estimate by histograms less that by fluctuations, for steps that overlap.
Replicates difference_of(const CompactivityStep& step);

/// Between neighbours in the order given, all of the same realizations.
std::vector<CompactivityStep> compactivity_steps(std::span<const SteadyVolumes> states,
                                                 const VolumeBins& bins);
/// Sums of the steps, 1/X of each state less that of the first, [n_states], by one estimator; NaN
/// from the first step on that has none.
std::vector<Jackknifed> inverse_compactivity(std::span<const CompactivityStep> steps,
                                             Replicates CompactivityStep::*estimator);
/// The drift of all states together, in deviations: of each realization the mean over the states,
/// which see what each alone does not. None below two realizations.
Jackknifed drift_together(std::span<const SteadyVolumes> states);
/// `drift`: of the states together. If they drift, nothing is decided.
CompactivityVerdict compactivity_verdict(std::span<const CompactivityStep> steps,
                                         const Jackknifed& drift);

}  // namespace jostle::inline ensemble
