#include "engine/monte_carlo/plain_loop.hpp"

#include <cmath>
#include <utility>

#include "engine/bed/boundary.hpp"
#include "engine/bed/elementary.hpp"
#include "engine/bed/philox.hpp"
#include "engine/monte_carlo/theta_table.hpp"

namespace jostle::inline engine {

PlainLoop::PlainLoop(Packing packing, const Move& move, StreamKey key)
    : packing_(std::move(packing)),
      move_(move),
      key_(key),
      step_(std::visit([](const auto& chosen) { return chosen.max_step; }, move)) {
  if (const auto* polar = std::get_if<PolarMove>(&move_)) theta_table_ = make_theta_table(*polar);
}

void PlainLoop::run(std::uint64_t n_trials) {
  static_assert(std::variant_size_v<Move> == 2,
                "add the proposal and the path of the new move here");
  const bool polar = std::holds_alternative<PolarMove>(move_);
  const ProposalKernels kernels = baseline::proposal_kernels();
  for (const std::uint64_t end = next_trial_ + n_trials; next_trial_ < end; ++next_trial_) {
    const std::uint64_t t = next_trial_ % ProposalBatch::size;
    if (t == 0) {
      const BatchOrigin origin{static_cast<std::uint64_t>(key_), next_trial_,
                               static_cast<std::uint32_t>(packing_.centres.size())};
      if (polar) {
        kernels.polar(origin, theta_table_.data(), step_, *batch_);
      } else {
        kernels.metropolis(origin, *batch_);
      }
    }
    const Vec3 step{batch_->dx[t], batch_->dy[t], batch_->dz[t]};
    accepted_ += passes(batch_->sphere[t], polar ? step : step_ * step);
  }
}

bool PlainLoop::passes(std::uint32_t sphere, Vec3 step) {
  const Boundary boundary(packing_.container);
  const Vec3 target = wrapped(boundary, packing_.centres[sphere] + step);
  const double radius = packing_.radius(sphere);
  if (!clear_of_boundaries(boundary, target, radius)) return false;
  for (std::size_t j = 0; j < packing_.centres.size(); ++j) {
    if (j == sphere) continue;
    if (overlaps(boundary, target, packing_.centres[j], radius + packing_.radius(j))) return false;
  }
  const auto* metropolis = std::get_if<MetropolisMove>(&move_);
  if (metropolis && boundary.has_floor() &&
      !rise_passes(*metropolis, packing_.mass(sphere), step.z)) {
    return false;
  }
  packing_.centres[sphere] = target;
  return true;
}

bool PlainLoop::rise_passes(const MetropolisMove& move, double mass, double dz) const {
  if (dz <= 0) return true;
  if (std::isinf(move.beta)) return false;
  const double u = (philox_block(key_, next_trial_, 1)[0] + 0.5) * 0x1p-32;
  return u < exponential(-(move.beta * (mass * dz)));
}

}  // namespace jostle::inline engine
