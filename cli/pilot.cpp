#include "cli/pilot.hpp"

#include <algorithm>
#include <variant>

#include "engine/relaxation.hpp"
#include "engine/slab.hpp"
#include "engine/starts.hpp"
#include "engine/taps.hpp"
#include "engine/trial_loop.hpp"
#include "ensemble/processor_clock.hpp"

namespace jostle {
namespace {

using Clock = ProcessorClock;

/// A cut-down bed is a shallower one of the same kind; a file's packing and a fluid without gravity
/// would be something else.
std::uint32_t pilot_spheres(const Plan& plan, std::uint32_t max_spheres) {
  const bool shallower_is_alike =
      has_gravity(plan.container) && !std::holds_alternative<GivenPacking>(plan.start);
  return shallower_is_alike ? std::min(plan.n_spheres, max_spheres) : plan.n_spheres;
}

HeightWindow pilot_window(const Stop& stop, const Packing& packing) {
  const auto* rule = std::get_if<BulkFractionStop>(&stop.rule);
  return rule == nullptr ? HeightWindow{} : resolve(rule->window, packing);
}

}  // namespace

PilotEstimate pilot(const Plan& plan, std::uint64_t budget, std::uint32_t max_spheres) {
  PilotEstimate estimate{.n_spheres = pilot_spheres(plan, max_spheres)};
  const auto key = [&](Purpose purpose) {
    return stream_key(plan.seed, plan.point_id, 0, purpose);
  };
  const auto began = Clock::now();
  RandomStream start_stream(key(Purpose::start)), tap_stream(key(Purpose::tap));
  Packing packing = make_start(plan.start, plan.container, estimate.n_spheres, start_stream);
  const auto made = Clock::now();
  const auto make_loop = [&](const Relaxation& rule) {
    return make_trial_loop(plan.container, rule.move, key(Purpose::trials), best_instruction_set(),
                           rule.sampler);
  };
  RelaxationProgress before;
  const Relaxation* of_start = relaxation_of_start(plan);
  if (of_start != nullptr) {
    const auto loop = make_loop(*of_start);
    loop->load(packing);
    loop->begin_tap();
    relax(*loop, of_start->stop, pilot_window(of_start->stop, packing), before, budget / 2);
    loop->store(packing);
  }
  const Seconds start_time = Clock::now() - began;

  const auto loop = make_loop(plan.relax);
  RelaxationProgress tap;
  const HeightWindow window = pilot_window(plan.relax.stop, packing);
  const auto tap_began = Clock::now();
  if (total_taps(plan) > 0) excite(packing, tap_number(plan, 1), tap_stream);
  loop->load(packing);
  loop->begin_tap();
  relax(*loop, plan.relax.stop, window, tap, budget - std::min(budget / 2, before.trials));
  const Seconds tap_time = Clock::now() - tap_began, relax_time = Clock::now() - made;

  estimate.trials = before.trials + loop->tally().trials;
  estimate.trials_per_second = static_cast<double>(estimate.trials) / relax_time.count();
  const bool start_settled = of_start == nullptr || before.status != RelaxationStatus::running;
  estimate.settled = start_settled && tap.status != RelaxationStatus::running;
  estimate.sweeps_per_tap = static_cast<double>(tap.trials) / estimate.n_spheres;
  const double scale = static_cast<double>(plan.n_spheres) / estimate.n_spheres;
  estimate.realization = scale * (start_time + tap_time * static_cast<double>(total_taps(plan)));
  const double bytes = static_cast<double>(loop->bytes() + packing.centres.size() * sizeof(Vec3));
  estimate.bytes = static_cast<std::size_t>(scale * bytes);
  return estimate;
}

}  // namespace jostle
