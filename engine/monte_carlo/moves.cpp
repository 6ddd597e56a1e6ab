#include "engine/monte_carlo/moves.hpp"

#include <limits>

#include "engine/monte_carlo/trial_loop.hpp"

// Valid combinations of containers, moves and samplers.
namespace jostle::inline engine {

std::optional<std::string> PolarMove::container_fault(const Container& container) const {
  if (has_gravity(container)) return std::nullopt;
  return "polar moves fall: without gravity (fully_periodic) use \"metropolis\"";
}

std::vector<std::string> PolarMove::skipping_faults() const {
  return {};
}

std::optional<std::string> MetropolisMove::container_fault(const Container&) const {
  return std::nullopt;
}

std::vector<std::string> MetropolisMove::skipping_faults() const {
  std::vector<std::string> faults;
  if (beta != std::numeric_limits<double>::infinity()) {
    faults.push_back("skipping needs trials that only fall, and a finite beta lets some rise");
  }
  if (adaptation && adaptation->base != AcceptanceBase::all_trials) {
    faults.push_back(
        "skipping does not see the upward trials that the adaptation of the step leaves out "
        "(\"of\": \"not_upward\")");
  }
  return faults;
}

std::optional<std::string> move_fault(const Move& move, const Container& container) {
  return std::visit([&](const auto& chosen) { return chosen.container_fault(container); }, move);
}

std::optional<std::string> sampler_fault(Sampler sampler, const Move& move,
                                         const Container& container) {
  if (sampler == Sampler::exhaustive) return std::nullopt;
  std::string faults;
  const auto add = [&](const std::string& reason) {
    faults += (faults.empty() ? "" : "; ") + reason;
  };
  if (!has_gravity(container)) {
    add("skipping needs trials that only fall, and without gravity (fully_periodic) none does");
  }
  for (const std::string& reason :
       std::visit([](const auto& chosen) { return chosen.skipping_faults(); }, move)) {
    add(reason);
  }
  if (faults.empty()) return std::nullopt;
  return faults + ": use \"exhaustive\"";
}

}  // namespace jostle::inline engine
