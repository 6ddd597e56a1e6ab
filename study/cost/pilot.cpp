#include "study/cost/pilot.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <variant>

#include "engine/bed/slab.hpp"
#include "engine/engines.hpp"
#include "engine/starts/starts.hpp"
#include "engine/taps.hpp"
#include "ensemble/processor_clock.hpp"
#include "ensemble/protocol_steps.hpp"

namespace jostle::inline study {
namespace {

using Clock = ProcessorClock;

constexpr double trials_per_slice = 4e6;    // of the Monte Carlo engine
constexpr double narrowest = 8;             // diameters, of a footprint that is cut
constexpr std::uint32_t most_oversize = 5;  // times max_spheres, before depth is cut as well

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

/// A realization that is tried, a cut one where the plan's is large: each piece of it is ended
/// where its share of the budget ends, at rest or not.
class Pilot {
 public:
  Pilot(const Plan& plan, const CutBed& bed, std::uint64_t budget)
      : plan_(plan),
        bed_(bed),
        dynamics_(make_dynamics(plan.engine, {.start = stream_key(plan, 0, Purpose::start_trials),
                                              .taps = stream_key(plan, 0, Purpose::trials)})),
        tap_random_(stream_key(plan, 0, Purpose::tap)) {
    // The budget is one of trials; other engines do less in the same time.
    budget_ = static_cast<std::uint64_t>(static_cast<double>(budget) *
                                         dynamics_->units_per_slice() / trials_per_slice);
    const auto began = Clock::now();
    RandomStream random(stream_key(plan, 0, Purpose::start));
    const Packing start = make_start(plan.start, bed.container, bed.n_spheres, random);
    dynamics_->load(start);
    dynamics_->settle(plan.start);
    advance(budget_ / 2);
    start_time_ = Clock::now() - began;
  }

  PilotEstimate estimate() {
    constexpr Seconds short_tap{0.2};
    const std::vector<std::size_t> stages = piloted_stages(plan_.protocol);
    std::uint64_t left = budget_ - std::min(budget_ / 2, dynamics_->effort().units);
    std::size_t untried = stages.size();
    std::map<std::string, CostsByStrength> costs;
    for (const std::size_t stage : stages) {
      const Tap& tap = plan_.protocol[stage].tap;
      const std::uint64_t before = dynamics_->effort().units;
      TapCost cost = timed(tap, left / untried);
      // The first also makes what all others use.
      if (stage == stages.front() && cost.time < short_tap) cost = timed(tap, left / untried);
      --untried;
      left -= std::min(left, dynamics_->effort().units - before);
      const Control strength = control(tap);
      costs[strength.name][strength.value] = cost;
    }
    return summed(costs, stages.size());
  }

 private:
  TapCost timed(const Tap& tap, std::uint64_t budget) {
    const std::uint64_t before = dynamics_->effort().units;
    const auto began = Clock::now();
    dynamics_->tap(tap, tap_random_);
    advance(budget);
    const auto units = static_cast<double>(dynamics_->effort().units - before);
    return {Clock::now() - began, units / bed_.n_spheres};
  }

  void advance(std::uint64_t budget) {
    const auto began = Clock::now();
    const DynamicsStatus status = dynamics_->advance(budget);
    moving_time_ += Clock::now() - began;
    settled_ = settled_ && status != DynamicsStatus::running;
  }

  PilotEstimate summed(const std::map<std::string, CostsByStrength>& costs,
                       std::size_t n_strengths) const {
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
    const std::uint64_t units = dynamics_->effort().units;
    const double observed = static_cast<double>(bed_.n_spheres) * sizeof(Vec3);
    return {.n_spheres = bed_.n_spheres,
            .n_strengths = n_strengths,
            .units = units,
            .units_per_second = units > 0 ? static_cast<double>(units) / moving_time_.count() : 0,
            .rounds_per_tap = n_taps > 0 ? sweeps / n_taps : 0,
            .settled = settled_ && bed_.as_deep,
            .realization = scale * (start_time_ + taps_time),
            .bytes = static_cast<std::size_t>(
                scale * (static_cast<double>(dynamics_->bytes()) + observed))};
  }

  const Plan& plan_;
  const CutBed& bed_;
  std::uint64_t budget_ = 0;
  std::unique_ptr<Dynamics> dynamics_;
  RandomStream tap_random_;
  Seconds start_time_{0}, moving_time_{0};
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

}  // namespace jostle::inline study
