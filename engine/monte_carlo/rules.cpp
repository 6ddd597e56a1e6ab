#include <limits>

#include "engine/monte_carlo/trial_loop.hpp"

// Valid combinations of containers, moves and samplers.
namespace jostle::inline engine {

std::optional<std::string> move_fault(const Move& move, const Container& container) {
  if (has_gravity(container) || !std::holds_alternative<PolarMove>(move)) return std::nullopt;
  return "polar moves fall: without gravity (fully_periodic) use \"metropolis\"";
}

std::optional<std::string> sampler_fault(Sampler sampler, const Move& move,
                                         const Container& container) {
  static_assert(std::variant_size_v<Move> == 2, "add the samplers that suit the new move here");
  if (sampler == Sampler::exhaustive) return std::nullopt;
  std::string fault_text;
  const auto add = [&](const char* reason) {
    fault_text += (fault_text.empty() ? "" : "; ") + std::string(reason);
  };
  if (!has_gravity(container)) {
    add("skipping needs trials that only fall, and without gravity (fully_periodic) none does");
  }
  if (const auto* metropolis = std::get_if<MetropolisMove>(&move)) {
    if (metropolis->beta != std::numeric_limits<double>::infinity()) {
      add("skipping needs trials that only fall, and a finite beta lets some rise");
    }
    if (metropolis->adaptation && metropolis->adaptation->base != AcceptanceBase::all_trials) {
      add("skipping does not see the upward trials that the adaptation of the step leaves out "
          "(\"of\": \"not_upward\")");
    }
  }
  if (fault_text.empty()) return std::nullopt;
  return fault_text + ": use \"exhaustive\"";
}

}  // namespace jostle::inline engine
