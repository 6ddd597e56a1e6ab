#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/ladder.hpp"
#include "ensemble/analysis/accuracy.hpp"
#include "ensemble/analysis/table.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline study {

/// Time of a setting on one core.
struct SettingTime {
  double start_seconds = 0,
         tap_seconds = 0;  // tap seconds of one realization; a tap of the pilot's second half
  double work = 0;         // work of such a tap: sweeps, or simulated seconds
};

/// A bulk fraction read through another window less itself: at the scene's own setting, on the same
/// packings.
struct WindowEffect {
  std::string name;  // "quantiles 0.1 to 0.9"
  PairedBias difference;
};

/// Results of the pilot for one observable, after its last tap.
struct CostOfObservable {
  Column label;
  std::vector<PairedBias> biases;          // [n_settings]
  std::vector<SettingCost> setting_costs;  // [n_settings], for the whole run of the scene
  std::vector<SettingCost> limits;         // at_limits() of the pilot
  PairedBias last_step{};                  // the most complete setting less the one before
  Remainder remainder;                     // its remaining bias; only if that step is significant
  std::vector<double> bias_by_tap, bias_error_by_tap;  // [n_settings, n_taps], taps 1 .. n_taps
  /// [n_settings]: since tap n_taps / 2; empty of a pilot of one tap.
  std::vector<Growth> growths;
  std::vector<WindowEffect> windows;  // windows of a bulk fraction
};

/// A pilot over the settings of a ladder, as far as its replicates (realizations) are complete.
class CostStudy {
 public:
  /// `taps` is the number of taps of the whole scene, for which times are estimated; `windows` are
  /// those that the pilot observes beside the scene's.
  CostStudy(const ResultsFile& file, std::vector<PilotSetting> settings,
            std::vector<OtherWindow> windows, std::uint64_t taps);

  const std::vector<PilotSetting>& settings() const { return settings_; }
  std::uint32_t replicates() const { return replicates_; }
  std::uint64_t pilot_taps() const { return pilot_taps_; }
  /// From which to its last biases are seen to grow or not.
  std::uint64_t middle_tap() const { return pilot_taps_ / 2; }
  std::uint64_t taps() const { return taps_; }
  const std::vector<SettingTime>& times() const { return times_; }
  /// Unit of the work of a tap: "sweeps", or "simulated seconds".
  std::string work_name() const;
  /// Realizations that failed, which are in no number of the study.
  const std::vector<RealizationSummary>& failed() const { return failed_; }
  const std::vector<CostOfObservable>& observables() const { return observables_; }
  MostComplete reference() const { return most_complete(settings_); }
  /// Core seconds of a whole realization.
  double realization_seconds(std::size_t setting) const;

  /// cost/<observable>: one row a setting, and the bias by tap.
  std::vector<Table> tables(std::uint32_t scene_realizations) const;

 private:
  void read_times(const ResultsFile& file);
  /// The settings that use the beds of the scene's own.
  std::vector<std::uint64_t> has_beds() const;
  CostOfObservable read_observable(const ResultsFile& file, const Column& label) const;
  std::vector<WindowEffect> read_windows(const ResultsFile& file,
                                         const std::string& observable) const;

  std::vector<PilotSetting> settings_;
  std::vector<OtherWindow> windows_;
  std::uint64_t taps_ = 0, pilot_taps_ = 0;
  std::uint32_t replicates_ = 0;
  std::vector<SettingTime> times_;
  std::vector<RealizationSummary> failed_;
  std::vector<CostOfObservable> observables_;
};

}  // namespace jostle::inline study
