#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ensemble/statistics/student_tests.hpp"

// Cost of accuracy: settings of a relaxation compared in pairs, realization by realization, each
// pair from one starting packing.
namespace jostle::inline ensemble {

/// A setting against the reference: the mean of the pairs' differences.
struct PairedBias {
  std::size_t pairs = 0;  // realizations that both have
  double bias = 0;        // NaN without pairs
  double error = 0;       // standard error; NaN below two pairs
  /// By how much pairing shrinks the variance of the difference: (s^2 + s_ref^2) / s_difference^2.
  /// NaN below two pairs; infinite where all differences are the same.
  double variance_reduction = 0;
};

/// values and reference: one per realization, NaN where it is missing.
PairedBias paired_bias(std::span<const double> values, std::span<const double> reference);

/// True if a bias still grows with taps: its change from an earlier tap to a later one.
struct Growth {
  PairedBias change;      // change of the bias, in pairs
  double tails = 1;       // probability of such a change by chance (Student's t)
  double detectable = 0;  // a change that would be found at 5 % with power 0.8
  bool is_seen() const { return tails < significance_level; }
};

/// values and reference at both taps: one per realization, NaN where it is missing. Nothing is
/// known below two pairs: NaN, and not seen.
Growth bias_growth(std::span<const double> values_before, std::span<const double> reference_before,
                   std::span<const double> values, std::span<const double> reference);

/// True if it is significant: Student's t over pairs, at 5 %.
bool is_seen(const PairedBias& bias);

/// Remaining bias of a ladder's last setting.
struct Remainder {
  std::size_t realizations = 0;  // common to all three settings
  double value = 0;              // NaN where steps do not shrink: r outside 0 .. 0.9
  double error = 0;  // jackknife over realizations; NaN where it is not defined without one of them
};

/// From three settings, each more complete than the one before, one value a realization, NaN where
/// it is missing: if steps between the means go on to shrink as the last two did, X_inf - X_last =
/// d r / (1 - r) with d = X_last - X_before and r the ratio of the two steps.
Remainder remainder(std::span<const double> two_before, std::span<const double> previous,
                    std::span<const double> last);

/// A setting as a choice.
struct SettingCost {
  double bias = 0, bias_error = 0;  // bias of the observable
  double sigma = 0;                 // deviation between realizations
  double realization_seconds = 0;   // seconds of a whole realization, on one core
  std::size_t values = 0;           // realizations that it has, of which sigma is
  std::size_t pairs = 0;            // those that the reference has too, of which the bias is
};

struct Recommendation {
  std::size_t setting = 0;
  std::uint64_t realizations = 0;  // at least 2
  double core_seconds = 0;
};

/// The setting and number of realizations that reach a total error (the bias with its error, and
/// sigma / M^(1/2), in quadrature) of at most `target` (above 0) for the least core time; nothing
/// where every bias is too large. Settings without a known bias are passed over.
std::optional<Recommendation> cheapest(std::span<const SettingCost> settings, double target);

/// By what a deviation of so many values (at least 2) is multiplied for a limit that the true one
/// of a Gaussian exceeds once in five times: 1.35 for 8, 2.12 for 3. Infinite below 2.
double sigma_limit(std::size_t n_values);

/// Results of a pilot besides its settings.
struct Pilot {
  std::size_t reference = 0;  // reference of settings: the most complete, of which biases are
  PairedBias last_step, step_before;    // to the reference, and to the setting before it
  std::vector<std::uint64_t> has_beds;  // [n_settings], 1: has the beds of the reference
};

/// The mean square over the settings that share their beds, by degrees of freedom, in the place of
/// each one's sigma: those of a few replicates scatter by more than they differ.
void pool_sigma(std::span<SettingCost> settings, const Pilot& pilot);

/// Settings at the limits of what the pilot knows, each exceeded once in five times: sigma by
/// sigma_limit() of its values; the bias of its pairs by Student's t, its error no smaller than the
/// root mean square over the settings of one bed, since of many settings one has a small error by
/// chance. The remaining bias of the reference is added to each bias: the limit of its last step
/// where that is not seen, which takes for granted that further steps shrink at least by half; else
/// the rest of a series whose ratio is at the limit of these two steps. Biases are NaN where that
/// series has no end. bias_error is 0.
std::vector<SettingCost> at_limits(std::span<const SettingCost> settings, const Pilot& pilot);

/// True if no other setting has both a smaller |bias| + error and a smaller time, [n_settings].
std::vector<std::uint64_t> pareto_front(std::span<const SettingCost> settings);

}  // namespace jostle::inline ensemble
