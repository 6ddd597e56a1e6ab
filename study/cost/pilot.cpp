#include "study/cost/pilot.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <variant>

#include "engine/bed/slab.hpp"
#include "engine/monte_carlo/relaxation.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/starts/starts.hpp"
#include "engine/taps.hpp"
#include "ensemble/processor_clock.hpp"
#include "ensemble/protocol_steps.hpp"

namespace jostle {
namespace {

using Clock = ProcessorClock;

constexpr double narrowest = 8;             // diameters, of a footprint that is cut
constexpr std::uint32_t most_oversize = 5;  // times max_spheres, before depth is cut as well

HeightWindow pilot_window(const Stop& stop, const Packing& packing) {
  const auto* rule = std::get_if<BulkFractionStop>(&stop.rule);
  return rule == nullptr ? HeightWindow{} : resolve(rule->window, packing);
}

/// A width times about `factor`, never below the narrowest; a whole number of `unit`s of it where
/// a lattice wants that.
double cut_width(double width, double factor, double unit) {
  const double least = std::min(width, std::max(narrowest, width * factor));
  if (unit == 0) return least;
  const double whole = std::round(width / unit);
  return width * std::min(whole, std::ceil(least / unit)) / whole;
}

/// Of the lattice along x and y, what a footprint is a whole number of; 0: of nothing.
struct LatticeUnits {
  double x = 0, y = 0;
};
LatticeUnits lattice_units(const Plan& plan) {
  const auto* crystal = std::get_if<Crystal>(&plan.start);
  if (crystal == nullptr || !std::holds_alternative<PeriodicBox>(plan.container)) return {};
  return {1, crystal->lattice == Lattice::hcp ? std::sqrt(3.0) : 1};
}

/// The container on about `share` of its area. Where one side of a box cannot be cut as far as the
/// other, the other is cut further.
Container with_cut_footprint(const Plan& plan, double share) {
  Container container = plan.container;
  const LatticeUnits units = lattice_units(plan);
  const double factor = std::sqrt(share);
  const auto cut_box = [&](auto& box) {
    const double left_x = cut_width(box.width_x, factor, units.x) / box.width_x;
    const double left_y = cut_width(box.width_y, factor, units.y) / box.width_y;
    box.width_x = cut_width(box.width_x, share / left_y, units.x);
    box.width_y = cut_width(box.width_y, share / left_x, units.y);
  };
  if (auto* periodic = std::get_if<PeriodicBox>(&container)) cut_box(*periodic);
  if (auto* walled = std::get_if<WalledBox>(&container)) cut_box(*walled);
  if (auto* tube = std::get_if<Cylinder>(&container)) {
    tube->diameter = cut_width(tube->diameter, factor, 0);
  }
  return container;
}

/// What a tap of one strength took.
struct TapCost {
  Seconds time{0};
  double sweeps = 0;
};
/// Of one kind of tap, by strength.
using CostsByStrength = std::map<double, TapCost>;

TapCost between(const CostsByStrength& costs, double strength) {
  const auto above = costs.lower_bound(strength);
  if (above == costs.end()) return costs.rbegin()->second;
  if (above == costs.begin() || above->first == strength) return above->second;
  const auto below = std::prev(above);
  const double share = (strength - below->first) / (above->first - below->first);
  return {below->second.time + share * (above->second.time - below->second.time),
          below->second.sweeps + share * (above->second.sweeps - below->second.sweeps)};
}

/// A realization that is tried, a cut one where the plan's is large.
class Pilot {
 public:
  Pilot(const Plan& plan, const CutBed& bed, std::uint64_t budget)
      : plan_(plan), engine_(std::get<MonteCarlo>(plan.engine)), bed_(bed), budget_(budget) {
    const auto began = Clock::now();
    RandomStream random(key(Purpose::start));
    packing_ = make_start(plan.start, bed.container, bed.n_spheres, random);
    if (const Relaxation* rule = relaxation_of_start(engine_, plan.start)) {
      const auto relaxing = Clock::now();
      const auto loop = make_loop(*rule);
      loop->load(packing_);
      run(*loop, rule->stop, pilot_window(rule->stop, packing_), budget / 2);
      relax_time_ += Clock::now() - relaxing;
    }
    start_time_ = Clock::now() - began;
  }

  PilotEstimate estimate() {
    const std::vector<std::size_t> stages = piloted_stages(plan_.protocol);
    const auto loop = make_loop(engine_.relax);
    const HeightWindow window = pilot_window(engine_.relax.stop, packing_);
    std::uint64_t left = budget_ - std::min(budget_ / 2, trials_);
    std::size_t untried = stages.size();
    RandomStream tap_random(key(Purpose::tap));
    std::map<std::string, CostsByStrength> costs;
    loop->load(packing_);
    for (const std::size_t stage : stages) {
      const Tap& tap = plan_.protocol[stage].tap;
      const auto began = Clock::now();
      excite(packing_, tap, tap_random);
      loop->load(packing_);
      const std::uint64_t trials = run(*loop, engine_.relax.stop, window, left / untried--);
      left -= std::min(left, trials);
      const Seconds time = Clock::now() - began;
      relax_time_ += time;
      const Control strength = control(tap);
      costs[strength.name][strength.value] = {time, static_cast<double>(trials) / bed_.n_spheres};
    }
    return summed(costs, stages.size(), loop->bytes());
  }

 private:
  PilotEstimate summed(const std::map<std::string, CostsByStrength>& costs, std::size_t n_strengths,
                       std::size_t loop_bytes) const {
    Seconds taps_time{0};
    double sweeps = 0;
    for (const Stage& stage : plan_.protocol) {
      if (stage.count == 0) continue;
      const Control strength = control(stage.tap);
      const TapCost cost = between(costs.at(strength.name), strength.value);
      const auto n = static_cast<double>(stage.count);
      taps_time += n * cost.time;
      sweeps += n * cost.sweeps;
    }
    const double scale = static_cast<double>(plan_.n_spheres) / bed_.n_spheres;
    const auto n_taps = static_cast<double>(total_taps(plan_));
    const double bytes = static_cast<double>(loop_bytes + packing_.centres.size() * sizeof(Vec3));
    return {
        .n_spheres = bed_.n_spheres,
        .n_strengths = n_strengths,
        .trials = trials_,
        .trials_per_second = trials_ > 0 ? static_cast<double>(trials_) / relax_time_.count() : 0,
        .sweeps_per_tap = n_taps > 0 ? sweeps / n_taps : 0,
        .settled = settled_ && bed_.as_deep,
        .realization = scale * (start_time_ + taps_time),
        .bytes = static_cast<std::size_t>(scale * bytes)};
  }

  /// Relaxes what is loaded, into the packing; returns the trials that took.
  std::uint64_t run(TrialLoop& loop, const Stop& stop, HeightWindow window, std::uint64_t budget) {
    RelaxationProgress progress;
    loop.begin_tap();
    relax(loop, stop, window, progress, budget);
    loop.store(packing_);
    settled_ = settled_ && progress.status != DynamicsStatus::running;
    trials_ += progress.trials;
    return progress.trials;
  }

  StreamKey key(Purpose purpose) const {
    return stream_key(plan_.seed, plan_.point_id, 0, purpose);
  }
  std::unique_ptr<TrialLoop> make_loop(const Relaxation& rule) const {
    return make_trial_loop(bed_.container, rule.move, key(Purpose::trials), best_instruction_set(),
                           rule.sampler);
  }

  const Plan& plan_;
  const MonteCarlo& engine_;
  const CutBed& bed_;
  std::uint64_t budget_;
  Packing packing_;
  Seconds start_time_{0}, relax_time_{0};
  std::uint64_t trials_ = 0;
  bool settled_ = true;
};

}  // namespace

CutBed cut_down(const Plan& plan, std::uint32_t max_spheres) {
  CutBed bed{plan.container, plan.n_spheres};
  const bool may_be_cut =
      has_gravity(plan.container) && !std::holds_alternative<GivenPacking>(plan.start);
  if (!may_be_cut || plan.n_spheres <= max_spheres) return bed;
  const double share = static_cast<double>(max_spheres) / plan.n_spheres;
  bed.container = with_cut_footprint(plan, share);
  const double left = footprint_area(bed.container) / footprint_area(plan.container);
  bed.n_spheres = std::max(1u, static_cast<std::uint32_t>(std::lround(left * plan.n_spheres)));
  bed.as_deep = bed.n_spheres <= most_oversize * max_spheres;
  if (!bed.as_deep) bed.n_spheres = most_oversize * max_spheres;
  return bed;
}

std::vector<std::size_t> piloted_stages(const std::vector<Stage>& protocol) {
  struct Found {
    std::size_t first, weakest, strongest, last, middle;
  };
  const auto strength = [&](std::size_t stage) { return control(protocol[stage].tap).value; };
  std::map<std::string, Found> kinds;
  for (std::size_t i = 0; i < protocol.size(); ++i) {
    if (protocol[i].count == 0) continue;
    auto& found =
        kinds.try_emplace(control(protocol[i].tap).name, Found{i, i, i, i, i}).first->second;
    if (strength(i) < strength(found.weakest)) found.weakest = i;
    if (strength(i) > strength(found.strongest)) found.strongest = i;
    found.last = i;
  }
  for (std::size_t i = 0; i < protocol.size(); ++i) {
    if (protocol[i].count == 0) continue;
    Found& found = kinds.at(control(protocol[i].tap).name);
    const double middle = (strength(found.weakest) + strength(found.strongest)) / 2;
    if (std::abs(strength(i) - middle) < std::abs(strength(found.middle) - middle)) {
      found.middle = i;
    }
  }
  std::vector<std::size_t> stages;
  for (const auto& [name, found] : kinds) {
    stages.insert(stages.end(),
                  {found.first, found.weakest, found.middle, found.strongest, found.last});
  }
  std::ranges::sort(stages);
  // One strength costs the same wherever it comes.
  std::vector<std::size_t> distinct;
  for (const std::size_t stage : stages) {
    const bool known = std::ranges::any_of(
        distinct, [&](std::size_t other) { return protocol[other].tap == protocol[stage].tap; });
    if (!known) distinct.push_back(stage);
  }
  return distinct;
}

PilotEstimate pilot(const Plan& plan, std::uint64_t budget, std::uint32_t max_spheres) {
  const CutBed bed = cut_down(plan, max_spheres);
  return Pilot(plan, bed, budget).estimate();
}

}  // namespace jostle
