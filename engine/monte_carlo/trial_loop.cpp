#include "engine/monte_carlo/trial_loop.hpp"

#include <cstdlib>
#include <stdexcept>

#include "engine/monte_carlo/kernel/proposals.hpp"
#include "engine/monte_carlo/kernel/typed_trial_loop.hpp"
#include "engine/monte_carlo/rejection_free/skipping_kernels.hpp"
#include "engine/monte_carlo/rejection_free/skipping_trial_loop.hpp"

namespace jostle {

namespace {

ProposalKernels kernels_for(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return avx512::proposal_kernels();
    case InstructionSet::avx2:
      return avx2::proposal_kernels();
    case InstructionSet::baseline:
      break;
  }
  return baseline::proposal_kernels();
}

bool machine_has(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
    case InstructionSet::avx2:
      return __builtin_cpu_supports("avx2");
    case InstructionSet::baseline:
      break;
  }
  return true;
}

SkippingKernels skipping_kernels_for(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return avx512::skipping_kernels();
    case InstructionSet::avx2:
      return avx2::skipping_kernels();
    case InstructionSet::baseline:
      break;
  }
  return baseline::skipping_kernels();
}

void refuse_skipping_rises(const Container& container, const Move& move) {
  if (!has_gravity(container)) {
    throw std::invalid_argument(
        "the skipping sampler needs gravity, which a fully periodic box has not: use the "
        "exhaustive sampler");
  }
  const auto* metropolis = std::get_if<MetropolisMove>(&move);
  if (metropolis == nullptr) return;
  if (metropolis->beta != std::numeric_limits<double>::infinity()) {
    throw std::invalid_argument(
        "the skipping sampler is for trials that never rise, and a finite beta lets them: use the "
        "exhaustive sampler");
  }
  if (metropolis->adaptation && metropolis->adaptation->base != AcceptanceBase::all_trials) {
    throw std::invalid_argument(
        "the skipping sampler does not count rising trials, of which the adaptation of the step "
        "asks: count all trials or use the exhaustive sampler");
  }
}

std::unique_ptr<TrialLoop> make_skipping_loop(const Container& container, const Move& move,
                                              StreamKey key, InstructionSet set) {
  refuse_skipping_rises(container, move);
  const ProposalKernels proposals = kernels_for(set);
  const SkippingKernels kernels = skipping_kernels_for(set);
  return std::visit(
      [&](const auto& box) -> std::unique_ptr<TrialLoop> {
        using Box = std::decay_t<decltype(box)>;
        if constexpr (std::is_same_v<Box, FullyPeriodicBox>) {
          return nullptr;  // refused above
        } else if (std::holds_alternative<PolarMove>(move)) {
          return std::make_unique<SkippingTrialLoop<Box, Rise::impossible>>(box, move, key,
                                                                            proposals, kernels);
        } else {
          return std::make_unique<SkippingTrialLoop<Box, Rise::refused>>(box, move, key, proposals,
                                                                         kernels);
        }
      },
      container);
}

template <class Box>
std::unique_ptr<TrialLoop> loop_for(const Box& box, const Move& move, StreamKey key,
                                    const ProposalKernels& kernels) {
  if (std::holds_alternative<PolarMove>(move)) {
    return std::make_unique<TypedTrialLoop<Box, Rise::impossible>>(box, move, key, kernels);
  }
  if (std::get<MetropolisMove>(move).beta == std::numeric_limits<double>::infinity()) {
    return std::make_unique<TypedTrialLoop<Box, Rise::refused>>(box, move, key, kernels);
  }
  return std::make_unique<TypedTrialLoop<Box, Rise::thermal>>(box, move, key, kernels);
}

std::unique_ptr<TrialLoop> loop_for(const FullyPeriodicBox& box, const Move& move, StreamKey key,
                                    const ProposalKernels& kernels) {
  if (std::holds_alternative<PolarMove>(move)) {
    throw std::invalid_argument(
        "the polar move only goes down and a fully periodic box has no down: use the Metropolis "
        "move");
  }
  return std::make_unique<TypedTrialLoop<FullyPeriodicBox, Rise::free>>(box, move, key, kernels);
}

}  // namespace

std::string_view name(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return "avx512";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::baseline:
      break;
  }
  return "baseline";
}

InstructionSet best_instruction_set() {
  const char* wanted = std::getenv("JOSTLE_INSTRUCTION_SET");
  for (const InstructionSet set :
       {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::baseline}) {
    if (machine_has(set) && (!wanted || wanted == name(set))) return set;
  }
  throw std::invalid_argument(std::string("JOSTLE_INSTRUCTION_SET is \"") + wanted +
                              "\", which this machine does not have: use baseline, avx2 or avx512");
}

std::unique_ptr<TrialLoop> make_trial_loop(const Container& container, const Move& move,
                                           StreamKey key, InstructionSet set, Sampler sampler) {
  if (sampler == Sampler::skipping) return make_skipping_loop(container, move, key, set);
  const ProposalKernels kernels = kernels_for(set);
  return std::visit([&](const auto& box) { return loop_for(box, move, key, kernels); }, container);
}

}  // namespace jostle
