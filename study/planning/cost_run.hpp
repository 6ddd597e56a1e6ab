#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/ladder.hpp"
#include "study/planning/cost_study.hpp"
#include "study/running/run.hpp"

// Cost of a scene's accuracy: a pilot over a ladder of settings, in paired replicates.
namespace jostle::inline study {

/// The pilot of a scene at one point of its sweep.
struct CostPilot {
  Scene scene;  // at that point
  std::vector<PilotSetting> settings;
  LoadedScene pilot;       // a sweep over the settings, cut to a few taps
  std::uint64_t taps = 0;  // taps of the whole scene
};

/// `point`: its number, or "pointer=value" of the sweep; empty: the first. `pilot_taps`: at most so
/// many taps. `path` is the scene's, which packings of the start are relative to. Throws
/// BadArgument, BadInput for a scene whose accuracy has no cost.
CostPilot make_cost_pilot(const LoadedScene& loaded, const std::string& path,
                          const std::string& point, std::uint64_t pilot_taps);

/// Selects an observable of the scene: the named one; without a name bottom_fraction, or the first.
/// Throws BadArgument with the list of observables.
std::string cost_observable(const Scene& scene, const std::string& wanted);

/// How long the pilot is run: so many replicates, or if 0 as many as fit into the time, at least
/// two.
struct CostBudget {
  Seconds time{600};
  std::uint32_t replicates = 0;
};

/// Runs whole replicates: one realization of every setting. The longest setting first, so that
/// threads end together. None is added where all so far failed.
class CostRun {
 public:
  /// `pilot` and `observer` must outlive this. Throws as SceneRun.
  CostRun(CostPilot& pilot, const CostBudget& budget, const RunSettings& settings,
          RunObserver& observer);

  /// True if the replicates were completed, not stopped. Throws ResultsError.
  bool run();
  /// Ends the run and reads what it found. Nothing but the destructor may be called after.
  CostStudy study();

 private:
  std::uint32_t affordable(std::uint32_t done) const;

  const CostPilot& pilot_;
  CostBudget budget_;
  SceneRun run_;
  std::vector<RealizationSummary> worked_before_;  // by earlier processes
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

}  // namespace jostle::inline study
