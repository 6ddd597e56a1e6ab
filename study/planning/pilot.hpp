#pragma once

#include <cstdint>
#include <vector>

#include "engine/bed/container.hpp"
#include "ensemble/plan.hpp"
#include "study/seconds.hpp"

namespace jostle::inline study {

/// Measurements of a short trial of a sweep point, and the estimate for a realization.
struct PilotEstimate {
  std::uint32_t n_spheres = 0;  // n spheres of the pilot's packing: a large one is cut down
  std::size_t n_strengths = 0;  // n strengths of taps that were tried
  std::uint64_t units = 0;      // units of the engine, made by the pilot
  double units_per_second = 0;  // on one core
  double rounds_per_tap = 0;    // units / spheres, mean over the protocol; a lower bound where
                                // `settled` is false
  bool settled = false;         // true if start and taps met their stop rules within the budget
  Seconds start{0};             // seconds until tap 0 is recorded
  Seconds realization{0};       // a whole one on one core; a lower bound likewise
  std::size_t bytes = 0;        // held by one running realization
};

/// Makes the start, applies taps of a few strengths of the protocol in its order and relaxes each,
/// all within about `budget` units of the engine besides what makes the start; the cost of the
/// other taps is interpolated. A bed of more than `max_spheres` is cut down (cut_down) and its cost
/// scaled up in proportion. Throws StartError where the start does not suit the container.
PilotEstimate pilot(const Plan& plan, std::uint64_t budget, std::uint32_t max_spheres = 20'000);

/// A smaller piece of a bed.
struct CutBed {
  Container container;
  std::uint32_t n_spheres = 0;
  bool as_deep = true;               // false where the least footprint still holds too many spheres
  std::vector<MixtureKind> kinds{};  // kinds of a mixture, at least one sphere of each
};

/// A bed of about `max_spheres` spheres on a smaller footprint, as deep as the plan's: relaxations
/// take as many sweeps. Footprints stay at least 8 diameters wide, and 3 of the largest sphere of a
/// mixture, and whole lattices; a column of
/// more than five times `max_spheres` on such a footprint is made shallower. Beds that are small
/// enough, packings from files and boxes without gravity stay as they are.
CutBed cut_down(const Plan& plan, std::uint32_t max_spheres);

/// Stages whose strengths are tried, ascending: of every kind of tap the first, the weakest, that
/// in the middle, the strongest and the last, equal ones once.
std::vector<std::size_t> piloted_stages(const std::vector<Stage>& protocol);

}  // namespace jostle::inline study
