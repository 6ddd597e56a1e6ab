#include "study/planning/pilot.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "engine/bed/boundary.hpp"
#include "engine/bed/slab.hpp"
#include "ensemble/processor_clock.hpp"
#include "ensemble/realization.hpp"

namespace jostle::inline study {
namespace {

using Clock = ProcessorClock;

constexpr double narrowest = 8;              // diameters, of a footprint that is cut
constexpr double narrowest_for_largest = 3;  // and in diameters of the largest sphere
constexpr std::uint32_t most_oversize = 5;   // times max_spheres, before depth is cut as well

double narrowest_cut(const Plan& plan) {
  if (plan.kinds.empty()) return narrowest;
  return std::max(narrowest, narrowest_for_largest * range_of(plan.kinds).greatest);
}

/// A width times about `factor`, never below the narrowest; a whole number of `unit`s where a
/// lattice requires it.
double cut_width(double width, double factor, double unit, double least_width) {
  const double least = std::min(width, std::max(least_width, width * factor));
  if (unit == 0) return least;
  const double whole = std::round(width / unit);
  return width * std::min(whole, std::ceil(least / unit)) / whole;
}

/// Periods of the lattice along x and y; 0: none.
struct LatticeUnits {
  double x = 0, y = 0;
};
LatticeUnits lattice_units(const Plan& plan) {
  const auto* crystal = std::get_if<Crystal>(&plan.start);
  if (crystal == nullptr) return {};
  const Boundary boundary(plan.container);
  return {boundary.periodic_x ? 1 : 0.0, !boundary.periodic_y               ? 0
                                         : crystal->lattice == Lattice::hcp ? std::sqrt(3.0)
                                                                            : 1};
}

/// The container on about `share` of its area. Where one side of a box cannot be cut as far as the
/// other, the other is cut further.
Container with_cut_footprint(const Plan& plan, double share) {
  const Boundary boundary(plan.container);
  if (!boundary.has_floor()) return plan.container;
  Vec3 size = extent(plan.container);
  const LatticeUnits units = lattice_units(plan);
  const double factor = std::sqrt(share);
  const double least = narrowest_cut(plan);
  const double left_x = cut_width(size.x, factor, units.x, least) / size.x;
  const double left_y = cut_width(size.y, factor, units.y, least) / size.y;
  if (has_one_width(plan.container)) {
    size.x = cut_width(size.x, factor, 0, least);
  } else {
    size.x = cut_width(size.x, share / left_y, units.x, least);
    size.y = cut_width(size.y, share / left_x, units.y, least);
  }
  return *container_of(name_of(plan.container), size);
}

/// Cost of a tap of one strength.
struct TapCost {
  Seconds time{0};
  double sweeps = 0;
};
/// For one kind of tap, by strength.
using CostsByStrength = std::map<double, TapCost>;

TapCost interpolated(const CostsByStrength& costs, double strength) {
  const auto upper = costs.lower_bound(strength);
  if (upper == costs.end()) return costs.rbegin()->second;
  if (upper == costs.begin() || upper->first == strength) return upper->second;
  const auto lower = std::prev(upper);
  const double share = (strength - lower->first) / (upper->first - lower->first);
  return {lower->second.time + share * (upper->second.time - lower->second.time),
          lower->second.sweeps + share * (upper->second.sweeps - lower->second.sweeps)};
}

/// Mechanics whose bed counts as at rest where what is allowed ends, at rest or not.
class ShortDynamics final : public Dynamics {
 public:
  explicit ShortDynamics(std::unique_ptr<Dynamics> whole) : whole_(std::move(whole)) {}

  /// Units until the bed counts as at rest, from now on.
  void allow(std::uint64_t units) {
    left_ = units;
    settled_ = true;
  }
  /// True if the bed was at rest when it counted as such.
  bool settled() const { return settled_; }

  DynamicsStatus advance(std::uint64_t units) override {
    const std::uint64_t units_before = effort().units;
    const DynamicsStatus status = whole_->advance(std::min(units, left_));
    left_ -= std::min(left_, effort().units - units_before);
    if (status != DynamicsStatus::running || left_ > 0) return status;
    settled_ = false;
    return DynamicsStatus::capped;
  }

  void load(const Packing& bed) override { whole_->load(bed); }
  void settle(const Start& start) override { whole_->settle(start); }
  void tap(const Tap& tap, RandomStream& random) override { whole_->tap(tap, random); }
  void store(Packing& bed) const override { whole_->store(bed); }
  std::vector<double> diagnostics() const override { return whole_->diagnostics(); }
  Effort effort() const override { return whole_->effort(); }
  std::uint64_t units_per_slice() const override { return whole_->units_per_slice(); }
  std::size_t bytes() const override { return whole_->bytes(); }
  std::vector<std::byte> save() const override { return whole_->save(); }
  void restore(std::span<const std::byte> state) override { whole_->restore(state); }

 private:
  std::unique_ptr<Dynamics> whole_;
  std::uint64_t left_ = 0;
  bool settled_ = true;
};

/// The plan on the cut bed, with one tap of each of these stages. The first stage comes twice: its
/// first tap makes what all others use, and ends what the start left to settle; it is not counted.
Plan short_plan(const Plan& plan, const CutBed& bed, const std::vector<std::size_t>& stages) {
  Plan cut = plan;
  cut.container = bed.container;
  cut.n_spheres = bed.n_spheres;
  cut.kinds = bed.kinds;
  cut.snapshots.taps = {};
  cut.protocol = {};
  for (const std::size_t stage : stages) {
    const std::uint64_t taps = cut.protocol.empty() ? 2 : 1;
    cut.protocol.push_back({plan.protocol[stage].tap, taps});
  }
  return cut;
}

/// A short realization, a cut one where the plan's is large: each piece of it is ended where its
/// share of the budget ends, at rest or not.
class Pilot {
 public:
  Pilot(const Plan& plan, const CutBed& bed, std::uint64_t budget)
      : plan_(plan),
        bed_(bed),
        short_(short_plan(plan, bed, piloted_stages(plan.protocol))),
        left_(budget) {
    auto dynamics = std::make_unique<ShortDynamics>(dynamics_of(short_, 0));
    dynamics_ = dynamics.get();
    realization_.emplace(short_, 0, std::move(dynamics));
  }

  PilotEstimate estimate() {
    const TapCost start = next_row(left_ / 2);
    settled_ = dynamics_->settled();
    std::size_t untried = short_.protocol.size();
    std::map<std::string, CostsByStrength> costs;
    for (const Stage& stage : short_.protocol) {
      if (stage.count > 1) next_row(left_ / (4 * untried));
      const Control strength = control(stage.tap);
      costs[strength.name][strength.value] = next_row(left_ / untried--);
      settled_ = settled_ && dynamics_->settled();
    }
    return summed(start.time, costs);
  }

 private:
  /// Makes the next row: the start, or a tap.
  TapCost next_row(std::uint64_t budget) {
    const std::uint64_t units_before = dynamics_->effort().units;
    const auto began = Clock::now();
    dynamics_->allow(budget);
    Slice slice;
    while (!slice.row) {
      slice = realization_->advance(std::max<std::uint64_t>(1, budget));
      moving_time_ += slice.relaxing;
    }
    const std::uint64_t units = dynamics_->effort().units - units_before;
    left_ -= std::min(left_, units);
    return {Clock::now() - began, static_cast<double>(units) / bed_.n_spheres};
  }

  PilotEstimate summed(Seconds start_time,
                       const std::map<std::string, CostsByStrength>& costs) const {
    Seconds taps_time{0};
    double sweeps = 0;
    for (const Stage& stage : plan_.protocol) {
      if (stage.count == 0) continue;
      const Control strength = control(stage.tap);
      const TapCost cost = interpolated(costs.at(strength.name), strength.value);
      const auto n = static_cast<double>(stage.count);
      taps_time += n * cost.time;
      sweeps += n * cost.sweeps;
    }
    const double scale = static_cast<double>(plan_.n_spheres) / bed_.n_spheres;
    const auto n_taps = static_cast<double>(total_taps(plan_));
    const std::uint64_t units = dynamics_->effort().units;
    const double observed = static_cast<double>(bed_.n_spheres) * sizeof(Vec3);
    // Memory of the followed motion, and its multiple in a checkpoint: measured, 4 to 5 times.
    const std::uint64_t followed =
        plan_.motion ? 4 * motion_bytes(*plan_.motion, plan_.n_spheres) : 0;
    return {.n_spheres = bed_.n_spheres,
            .n_strengths = short_.protocol.size(),
            .units = units,
            .units_per_second = units > 0 ? static_cast<double>(units) / moving_time_.count() : 0,
            .rounds_per_tap = n_taps > 0 ? sweeps / n_taps : 0,
            .settled = settled_ && bed_.as_deep,
            .start = scale * start_time,
            .realization = scale * (start_time + taps_time),
            .bytes = static_cast<std::size_t>(
                         scale * (static_cast<double>(dynamics_->bytes()) + observed)) +
                     followed};
  }

  const Plan& plan_;
  const CutBed& bed_;
  const Plan short_;
  std::uint64_t left_;
  ShortDynamics* dynamics_ = nullptr;  // dynamics of the realization
  std::optional<Realization> realization_;
  Seconds moving_time_{0};
  bool settled_ = true;
};

/// The bed with so much of the plan's spheres, at least one of each kind; places move with the
/// sides.
void set_share(CutBed& bed, const Plan& plan, double share) {
  if (plan.kinds.empty()) {
    bed.n_spheres = std::max(1u, static_cast<std::uint32_t>(std::lround(share * plan.n_spheres)));
    return;
  }
  bed.kinds = with_share(plan.kinds, share);
  bed.n_spheres = static_cast<std::uint32_t>(n_spheres_of(bed.kinds));
  const Boundary whole(plan.container), cut(bed.container);
  for (MixtureKind& kind : bed.kinds) {
    if (!kind.place) continue;
    (*kind.place)[0] *= cut.width_x / whole.width_x;
    (*kind.place)[1] *= cut.width_y / whole.width_y;
  }
}

}  // namespace

CutBed cut_down(const Plan& plan, std::uint32_t max_spheres) {
  CutBed bed{plan.container, plan.n_spheres, true, plan.kinds};
  const bool may_be_cut =
      has_gravity(plan.container) && !std::holds_alternative<GivenPacking>(plan.start);
  if (!may_be_cut || plan.n_spheres <= max_spheres) return bed;
  const double share = static_cast<double>(max_spheres) / plan.n_spheres;
  bed.container = with_cut_footprint(plan, share);
  const double left = footprint_area(bed.container) / footprint_area(plan.container);
  set_share(bed, plan, left);
  bed.as_deep = bed.n_spheres <= most_oversize * max_spheres;
  if (!bed.as_deep)
    set_share(bed, plan, static_cast<double>(most_oversize * max_spheres) / plan.n_spheres);
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
    const bool known = std::ranges::any_of(distinct, [&](std::size_t earlier_stage) {
      return protocol[earlier_stage].tap == protocol[stage].tap;
    });
    if (!known) distinct.push_back(stage);
  }
  return distinct;
}

PilotEstimate pilot(const Plan& plan, std::uint64_t budget, std::uint32_t max_spheres) {
  const CutBed bed = cut_down(plan, max_spheres);
  return Pilot(plan, bed, budget).estimate();
}

}  // namespace jostle::inline study
