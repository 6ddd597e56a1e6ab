#include "study/planning/cost_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/grids.hpp"
#include "config/json/json_text.hpp"
#include "config/json/suggestion.hpp"
#include "config/sweep.hpp"
#include "study/planning/replicates.hpp"
#include "study/results_input.hpp"

namespace jostle::inline study {
namespace {

constexpr std::uint32_t fewest_replicates = 2;  // an error needs two

Scene scene_at_point(const LoadedScene& loaded, const std::string& wanted) {
  const std::uint32_t point = chosen_point(study_of(loaded), wanted);
  Scene scene = loaded.points.at(point);
  if (total_taps(scene.protocol) == 0) {
    throw BadInput("/protocol: there is no tap that could cost anything");
  }
  if (scene.observables.empty()) throw BadInput("/observe: there is nothing to be accurate in");
  if (!has_gravity(scene.container)) {
    throw BadInput("/container: a fluid without gravity does not relax, so nothing is incomplete");
  }
  return scene;
}

/// The pilot with the replicates to begin with.
const LoadedScene& begun_with(LoadedScene& pilot, std::uint32_t replicates) {
  pilot.scene.realizations =
      replicates > 0 ? std::min(fewest_replicates, replicates) : fewest_replicates;
  return pilot;
}

}  // namespace

CostPilot make_cost_pilot(const LoadedScene& loaded, const std::string& path,
                          const std::string& point, std::uint64_t pilot_taps) {
  CostPilot made{.scene = scene_at_point(loaded, point), .settings = {}, .pilot = {}};
  made.taps = total_taps(made.scene.protocol);
  made.settings = ladder(made.scene);
  made.pilot =
      load_derived(ladder_scene(made.scene, made.settings, std::min(made.taps, pilot_taps)), path);
  return made;
}

std::string cost_observable(const Scene& scene, const std::string& wanted) {
  std::string found;
  std::vector<std::string> names;
  for (const Observable& observable : scene.observables) {
    const std::string name = label(observable).name;
    names.push_back(name);
    if (name == (wanted.empty() ? "bottom_fraction" : wanted)) found = name;
  }
  if (!found.empty()) return found;
  if (wanted.empty()) return names.front();
  throw BadArgument(
      Argument::observable, wanted,
      fmt::format("the scene observes {}.{}", joined(names, ", "), did_you_mean(wanted, names)));
}

CostRun::CostRun(CostPilot& pilot, const CostBudget& budget, const RunSettings& settings,
                 RunObserver& observer)
    : pilot_(pilot),
      budget_(budget),
      run_(begun_with(pilot.pilot, budget.replicates), settings, observer),
      worked_before_(run_.realizations()) {}

bool CostRun::run() {
  const auto longest = static_cast<std::uint32_t>(most_complete(pilot_.settings).last);
  while (run_.compute(longest)) {
    const std::uint32_t replicates = run_.study().realizations;
    const std::uint32_t wanted =
        budget_.replicates > 0 ? budget_.replicates : affordable(replicates);
    const bool all_failed = run_.summary().failed > 0 && run_.summary().done == 0;
    if (wanted <= replicates || all_failed) return true;
    run_.extend(wanted);
  }
  return false;
}

std::uint32_t CostRun::affordable(std::uint32_t done) const {
  const Seconds spent = std::chrono::steady_clock::now() - began_;
  return affordable_replicates(done, budget_.time, spent,
                               replicates_done(worked_before_, run_.results().realizations()));
}

CostStudy CostRun::study() {
  return CostStudy(run_.close(), pilot_.settings, other_windows(pilot_.scene), pilot_.taps);
}

}  // namespace jostle::inline study
