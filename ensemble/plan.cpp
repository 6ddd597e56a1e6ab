#include "ensemble/plan.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace jostle::inline ensemble {

std::uint64_t total_taps(const Plan& plan) {
  std::uint64_t total = 0;
  for (const Stage& stage : plan.protocol) total += stage.count;
  return total;
}

StreamKey stream_key(const Plan& plan, std::uint32_t realization, Purpose purpose) {
  const bool shared = plan.streams == Streams::matched && purpose != Purpose::trials;
  return stream_key(plan.seed, shared ? 0 : plan.point_id, realization, purpose);
}

std::shared_ptr<const Sizes> sizes_of(const Plan& plan, std::uint32_t realization) {
  if (const auto* given = std::get_if<GivenPacking>(&plan.start)) return given->sizes;
  if (plan.kinds.empty()) return nullptr;
  RandomStream random(stream_key(plan, realization, Purpose::sizes));
  return draw_sizes(plan.kinds, random);
}

bool has_drawn_sizes(const Plan& plan) {
  return !std::holds_alternative<GivenPacking>(plan.start) &&
         std::ranges::any_of(plan.kinds, [](const MixtureKind& kind) {
           return !std::holds_alternative<FixedDiameter>(kind.diameter) &&
                  !std::holds_alternative<ListedDiameters>(kind.diameter);
         });
}

StartSpheres start_spheres(const Plan& plan, std::shared_ptr<const Sizes> sizes) {
  StartSpheres spheres{plan.n_spheres, std::move(sizes), plan.pour_order, {}};
  std::uint32_t first = 0;
  for (const MixtureKind& kind : plan.kinds) {
    if (kind.place) spheres.placed.push_back({first, (*kind.place)[0], (*kind.place)[1]});
    first += kind.count;
  }
  return spheres;
}

const Tap& tap_number(const Plan& plan, std::uint64_t t) {
  assert(t >= 1 && t <= total_taps(plan));
  auto stage = plan.protocol.begin();
  for (; t > stage->count; ++stage) t -= stage->count;
  return stage->tap;
}

}  // namespace jostle::inline ensemble
