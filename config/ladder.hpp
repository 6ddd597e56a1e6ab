#pragma once

#include <string>
#include <vector>

#include "config/scene.hpp"

namespace jostle::inline config {

/// One setting of a scene's accuracy, everything else as the scene has it.
struct PilotSetting {
  enum class Part { scene, stop, interval, step, adaptation, stiffness, spheres, start };
  Part part = Part::scene;
  std::string name;  // "eta = 1e-06"
  EngineSettings engine;
  std::uint32_t n_spheres = 0;
  Container container;
  StartChoice start;
  std::vector<MixtureKind> kinds{};  // empty: equal spheres
};

/// The scene's own setting first, then the others; within a part from rough to complete. Stops:
/// eta, change or sweeps, tenfold and a hundredfold (a published bulk-fraction rule ends with a
/// complete one by mean height); test intervals; the largest step halved and doubled, and theta_0
/// of polar moves; of Metropolis moves the published adaptation, this project's, and none; half the
/// spheres on half the footprint, where the start fills any; between walls the other of the two
/// pours, fitted or direct, unless the start is relaxed. Caps on sweeps are raised with the stops.
/// For discrete elements: a tenfold and a hundredfold kinetic energy that counts as rest, and five
/// and twenty-five times the time it is to last (of a fixed time a quarter to four times of it);
/// time steps half, twice and four times as many; springs ten times softer and stiffer.
std::vector<PilotSetting> ladder(const Scene& scene);

/// The settings whose stops are most complete. The last is the reference of all others; setting 0
/// is the scene's own.
struct MostComplete {
  std::size_t second_last = 0, last = 0;
};
MostComplete most_complete(const std::vector<PilotSetting>& settings);

/// A bulk fraction of the scene, read through another window.
struct OtherWindow {
  std::string name;  // name of the observable
  BulkFraction observable;
};

/// For every bulk fraction of the scene a window half as wide about the same middle, of quantiles
/// one with both edges halfway to the ends of the bed, and where its edges are sharp one that is
/// tapered over a layer spacing. They are named after it ("_narrow", "_wide", "_tapered"); those
/// whose name is taken or too long are left out.
std::vector<OtherWindow> other_windows(const Scene& scene);

/// The scene without its sweep, cut to `taps` taps, as a sweep over the settings in their order,
/// with matched streams, and with starts relaxed as the scene has it: so that realization m begins
/// at every setting from the same bed, but where the setting is another start. (Discrete elements
/// come to rest from the same start, each with its own setting.) Observes other_windows(), too.
/// Keeps no snapshots.
Scene ladder_scene(const Scene& scene, const std::vector<PilotSetting>& settings,
                   std::uint64_t taps);

}  // namespace jostle::inline config
