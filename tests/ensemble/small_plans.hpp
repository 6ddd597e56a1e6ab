#pragma once

#include <string>
#include <vector>

#include "ensemble/plan.hpp"
#include "tests/monte_carlo_plan.hpp"

namespace jostle {

/// A plan of seconds' fraction: 60 spheres, a few taps, everything observed.
inline Plan small_plan() {
  Plan plan;
  plan.seed = 20010222;
  plan.container = PeriodicBox{4, 4};
  plan.n_spheres = 60;
  plan.start = SteepestDescentPour{};
  plan.protocol = {{Dilate{.epsilon = 0.05}, 3}, {Lift{.gamma = 0.2}, 2}};
  monte_carlo(plan).relax.move = PolarMove{};
  monte_carlo(plan).relax.stop = {.rule = MeanHeightStop{.eta = 1e-3, .every_sweeps = 10},
                                  .max_sweeps = 500};
  plan.observables = {MeanHeight{}, BottomFraction{}, CorrectedFraction{}, BulkFraction{}};
  plan.snapshots.taps = {0, 2, 5};
  return plan;
}

/// Small plans that differ in every part of the engine, each with a name.
struct NamedPlan {
  std::string name;
  Plan plan;
};

inline std::vector<NamedPlan> various_plans() {
  const StepAdaptation adaptation{.factor = 0.9, .every_trials = 700};
  std::vector<NamedPlan> plans;
  const auto add = [&](const char* name) -> Plan& {
    return plans.emplace_back(NamedPlan{name, small_plan()}).plan;
  };

  add("periodic, polar, mean height");

  Plan& walled = add("walls, fitted pour, Metropolis that keeps its step, bulk fraction");
  walled.container = WalledBox{4.5, 4.2};
  walled.start = FittedPour{};
  monte_carlo(walled).relax.move = MetropolisMove{.max_step = 0.2, .adaptation = adaptation};
  std::get<MetropolisMove>(monte_carlo(walled).relax.move).adaptation->reset_each_tap = false;
  monte_carlo(walled).relax.stop = {.rule = BulkFractionStop{.change = 0.01, .every_trials = 1234},
                                    .max_sweeps = 300};

  Plan& tube = add("cylinder, random settle, exponential polar, bulk fraction by heights");
  tube.container = Cylinder{4.3};
  tube.start = RandomSettle{};
  monte_carlo(tube).relax.move =
      PolarMove{.max_step = 0.3, .theta0 = 0.5, .law = ThetaLaw::exponential};
  monte_carlo(tube).relax.stop = {.rule = BulkFractionStop{.change = 0.005,
                                                           .every_trials = 1500,
                                                           .times = 3,
                                                           .measure_start = false,
                                                           .window = HeightWindow{0.5, 2.5}},
                                  .max_sweeps = 300};

  Plan& absolute = add("walls, pour between them, polar, mean height in diameters");
  absolute.container = WalledBox{4.5, 4.2};
  monte_carlo(absolute).relax.stop = {.rule = HeightChangeStop{.change = 1e-4, .every_sweeps = 20},
                                      .max_sweeps = 2000};

  Plan& shaken = add("periodic, shake, warm Metropolis that resets its step, sweeps");
  shaken.protocol = {{Shake{.lambda = 0.05, .lateral_radius = 0.1}, 2}, {DilateFloorHeld{}, 3}};
  monte_carlo(shaken).relax.move =
      MetropolisMove{.max_step = 0.15, .beta = 5, .adaptation = adaptation};
  monte_carlo(shaken).relax.stop = {.rule = SweepsStop{.sweeps = 60}};

  Plan& fluid = add("fully periodic, Metropolis, sweeps, capped");
  fluid.container = FullyPeriodicBox{4, 4.5, 5};
  fluid.start = Grow{};
  fluid.protocol = {{Lift{.gamma = 0}, 5}};
  monte_carlo(fluid).relax.move = MetropolisMove{.max_step = 0.2, .adaptation = {}};
  monte_carlo(fluid).relax.stop = {.rule = SweepsStop{.sweeps = 60}, .max_sweeps = 40};
  fluid.observables = {MeanHeight{}, BulkFraction{.window = HeightWindow{1, 4}}};

  Plan& skipped = add("periodic, random settle, polar, skipping");
  skipped.start = RandomSettle{};
  monte_carlo(skipped).relax.stop = {.rule = MeanHeightStop{.eta = 1e-5, .every_sweeps = 30},
                                     .max_sweeps = 2000};
  monte_carlo(skipped).relax.sampler = Sampler::rejection_free;

  Plan& skipped_walls = add("walls, Metropolis that keeps its step, sweeps, skipping");
  skipped_walls.container = WalledBox{4.5, 4.2};
  monte_carlo(skipped_walls).relax.move = MetropolisMove{.max_step = 0.2, .adaptation = adaptation};
  std::get<MetropolisMove>(monte_carlo(skipped_walls).relax.move).adaptation->factor = 0.999;
  std::get<MetropolisMove>(monte_carlo(skipped_walls).relax.move).adaptation->reset_each_tap =
      false;
  monte_carlo(skipped_walls).relax.stop = {.rule = SweepsStop{.sweeps = 400}};
  monte_carlo(skipped_walls).relax.sampler = Sampler::rejection_free;

  Plan& settled = add("periodic, random settle by Metropolis that skips, then polar");
  settled.start = RandomSettle{};
  monte_carlo(settled).relax_start =
      Relaxation{.move = MetropolisMove{.max_step = 0.2, .adaptation = adaptation},
                 .stop = {.rule = SweepsStop{.sweeps = 300}},
                 .sampler = Sampler::rejection_free};
  return plans;
}

}  // namespace jostle
