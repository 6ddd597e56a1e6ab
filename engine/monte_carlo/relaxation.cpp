#include "engine/monte_carlo/relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace jostle::inline engine {

namespace {

struct MeasurementInterval {
  std::uint64_t n_spheres;
  std::uint64_t operator()(const MeanHeightStop& rule) const {
    return rule.every_sweeps * n_spheres;
  }
  std::uint64_t operator()(const HeightChangeStop& rule) const {
    return rule.every_sweeps * n_spheres;
  }
  std::uint64_t operator()(const BulkFractionStop& rule) const { return rule.every_trials; }
  std::uint64_t operator()(const SweepsStop& rule) const { return rule.sweeps * n_spheres; }
};

// Looks at the bed at a measuring point; returns whether the rule is met.
struct Measure {
  const TrialLoop& loop;
  HeightWindow window;
  RelaxationProgress& progress;

  bool operator()(const MeanHeightStop& rule) const {
    return changes_less_than([&](double height) { return rule.eta * height; });
  }
  bool operator()(const HeightChangeStop& rule) const {
    return changes_less_than([&](double) { return rule.change; });
  }
  bool operator()(const BulkFractionStop& rule) const {
    if (progress.trials == 0 && !rule.measure_start) return false;
    const double previous = progress.last_value;
    const double now = progress.last_value = loop.solids_fraction(window);
    if (!std::exchange(progress.measured, true)) return false;
    progress.passes = std::abs(now - previous) <= rule.change ? progress.passes + 1 : 0;
    return progress.passes >= rule.times;
  }
  bool operator()(const SweepsStop& rule) const {
    return progress.trials >= rule.sweeps * loop.n_spheres();
  }

 private:
  // Returns whether <Z> has changed by less than bound(<Z> before), diameters, and in a mixture the
  // mean height of every kind likewise: one intruder that rises is invisible in the mean. Returns
  // false at the first test.
  template <class Bound>
  bool changes_less_than(const Bound& bound) const {
    const double previous = progress.last_value;
    const double now = progress.last_value = loop.mean_height();
    const auto kinds_before = std::exchange(progress.kind_heights, loop.kind_heights());
    if (!std::exchange(progress.measured, true)) return false;
    if (!(std::abs(now - previous) < bound(previous))) return false;
    return std::ranges::equal(kinds_before, progress.kind_heights, [&](double was, double is) {
      return std::abs(is - was) < bound(was);
    });
  }
};

}  // namespace

void relax(TrialLoop& loop, const Stop& stop, HeightWindow window, RelaxationProgress& progress,
           std::uint64_t budget) {
  const std::uint64_t sweep = loop.n_spheres();
  const std::uint64_t cap = stop.max_sweeps * sweep;
  const std::uint64_t interval =
      std::max<std::uint64_t>(1, std::visit(MeasurementInterval{sweep}, stop.rule));
  const Measure measure{loop, window, progress};
  if (progress.trials == 0 && !progress.measured && std::visit(measure, stop.rule)) {
    progress.status = DynamicsStatus::settled;
  }
  // Up to the first sweep boundary at or beyond the budget.
  const std::uint64_t pause = (progress.trials + budget + sweep - 1) / sweep * sweep;
  while (progress.status == DynamicsStatus::running && progress.trials < pause) {
    const std::uint64_t measuring_point = (progress.trials / interval + 1) * interval;
    const std::uint64_t until = std::min({measuring_point, pause, cap});
    const std::uint64_t accepted_before = loop.tally().accepted;
    loop.run(until - progress.trials);
    progress.accepted += loop.tally().accepted - accepted_before;
    progress.trials = until;
    if (until == measuring_point && std::visit(measure, stop.rule)) {
      progress.status = DynamicsStatus::settled;
    } else if (until == cap) {
      progress.status = DynamicsStatus::capped;
    }
  }
}

}  // namespace jostle::inline engine
