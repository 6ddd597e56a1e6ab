#include "ensemble/plan.hpp"

#include <cassert>

namespace jostle::inline ensemble {

std::uint64_t total_taps(const Plan& plan) {
  std::uint64_t total = 0;
  for (const Stage& stage : plan.protocol) total += stage.count;
  return total;
}

const Tap& tap_number(const Plan& plan, std::uint64_t t) {
  assert(t >= 1 && t <= total_taps(plan));
  auto stage = plan.protocol.begin();
  for (; t > stage->count; ++stage) t -= stage->count;
  return stage->tap;
}

}  // namespace jostle::inline ensemble
