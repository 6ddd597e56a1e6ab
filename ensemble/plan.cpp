#include "ensemble/plan.hpp"

#include <cassert>

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

const Tap& tap_number(const Plan& plan, std::uint64_t t) {
  assert(t >= 1 && t <= total_taps(plan));
  auto stage = plan.protocol.begin();
  for (; t > stage->count; ++stage) t -= stage->count;
  return stage->tap;
}

}  // namespace jostle::inline ensemble
