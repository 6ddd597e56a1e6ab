#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "engine/monte_carlo/kernel/typed_trial_loop.hpp"
#include "engine/monte_carlo/rejection_free/candidate_sampler.hpp"

namespace jostle::inline engine {

/// Rejection-free sampling of a relaxation (Philippe & Bideau 2001, sec. II; Rosato et al. 2010,
/// sec. II, at zero temperature): the loop that looks only at candidates, the trials that bounds do
/// not certainly reject.
///
/// A trial of the exhaustive loop takes a random sphere i of n and a random step: its direction
/// falls into a bin b with probability w_b, its length l is at most L. Every sphere and bin has a
/// bound L_ib, beyond which each step is rejected (BoundTables; rejection_free_kernels.cpp derives
/// it). A trial with l <= L_ib is a candidate. While nothing moves trials are independent, and one
/// is a candidate with probability
///   P = (1 / n) sum_ib w_b F(L_ib / L),  F(x) = x of polar steps, x^3 of steps in a cube.
/// Hence k trials pass before the next candidate with probability P (1 - P)^k: one random number
/// advances over all of them. Its sphere and bin are drawn with probabilities proportional to
/// w_b F(L_ib / L), its direction within the bin and its length within the bound by the law of the
/// move. Then it is tested exactly, as every trial is. The law of the trajectory, counts of trials
/// included, is that of the exhaustive loop; the random numbers are others.
///
/// This is the n-fold way (Bortz, Kalos & Lebowitz 1975, doi:10.1016/0021-9991(75)90060-1) with
/// bounds in place of exact probabilities; a candidate that the exact test rejects thins the
/// process to the required law (Lewis & Shedler 1979, doi:10.1002/nav.3800260304). Used while few
/// trials are accepted; otherwise, as after a tap, the loop is exhaustive.
template <class Box, class Directions, class Spheres = EqualSpheres>
class RejectionFreeLoop final : public TrialLoop {
  using Policy = typename Directions::Policy;

 public:
  RejectionFreeLoop(const Box& box, const Policy& move, StreamKey key,
                    const ProposalKernels& proposals, const RejectionFreeKernels& kernels)
      : box_(box), exhaustive_(box, move, key, proposals), candidates_(box, move, key, kernels) {}

  void load(const Packing& packing) override {
    be_exhaustive();
    sizes_ = packing.sizes;
    exhaustive_.load(packing);
  }

  void store(Packing& packing) const override {
    if (!sampler_.active) return exhaustive_.store(packing);
    packing.centres.resize(candidates_.centres().size());
    std::ranges::transform(candidates_.centres(), packing.centres.begin(), unpacked);
  }

  void begin_tap() override {
    return_to_exhaustive();
    be_exhaustive();
    exhaustive_.begin_tap();
  }

  void run(std::uint64_t n_trials) override {
    while (n_trials > 0) {
      const std::uint64_t piece = std::min(n_trials, until_decision());
      const std::uint64_t accepted_before = tally_.accepted;
      sampler_.active ? try_candidates(piece) : run_exhaustive(piece);
      tally_.trials += piece;
      n_trials -= piece;
      const std::uint64_t accepted = tally_.accepted - accepted_before;
      if (sampler_.active &&
          exhaustive_.move().adapt(move_, {.trials = piece, .accepted = accepted})) {
        adapt_to_new_step();
      }
      decide(piece, accepted);
    }
    tally_.bound_rows = candidates_.rows_made();
    tally_.distance_tests = exhaustive_.tally().distance_tests + candidates_.distance_tests();
    tally_.list_builds = exhaustive_.tally().list_builds;
    tally_.list_renewals = exhaustive_.tally().list_renewals;
  }

  double mean_height() const override {
    if (!sampler_.active) return exhaustive_.mean_height();
    if constexpr (Spheres::several) return jostle::mean_height(stored());
    double sum = 0;
    for (const PackedCentre& centre : candidates_.centres()) sum += centre.z;
    return sum / static_cast<double>(candidates_.centres().size());
  }

  std::vector<double> kind_heights() const override {
    if constexpr (Spheres::several) return jostle::kind_heights(stored());
    return {};
  }

  double solids_fraction(HeightWindow window) const override {
    return jostle::solids_fraction(stored(), window);
  }

  std::uint32_t n_spheres() const override { return exhaustive_.n_spheres(); }
  const MoveState& state() const override { return sampler_.active ? move_ : exhaustive_.state(); }
  SamplerState sampler_state() const override { return sampler_; }
  void restore(const MoveState& move, const SamplerState& sampler) override {
    exhaustive_.restore(move, {});
    sampler_ = sampler;
    candidates_.forget_batch();
    if (!sampler_.active) return;
    move_ = move;
    candidates_.build(exhaustive_centres(), sampler_.reference_step, move_.step);
  }
  const TrialTally& tally() const override { return tally_; }
  std::size_t bytes() const override {
    return sizeof(*this) + exhaustive_.bytes() + candidates_.bytes();
  }

 private:
  // The exhaustive loop hands over once fewer than a share of a window's trials is accepted
  // (Directions::least_acceptance), and takes over again where more than several times as many are:
  // a step that adapts grows short.
  static constexpr double several = 3;
  static constexpr std::uint64_t window_sweeps = 25;
  // Above this share of candidates the bounds do not pay.
  static constexpr double most_candidates = 0.3;

  std::uint64_t until_decision() const {
    const std::uint64_t window = window_sweeps * n_spheres() - sampler_.window_trials;
    return sampler_.active ? std::min(window, exhaustive_.move().until_adaptation(move_)) : window;
  }

  void run_exhaustive(std::uint64_t n_trials) {
    const std::uint64_t accepted_before = exhaustive_.tally().accepted;
    exhaustive_.run(n_trials);
    tally_.accepted += exhaustive_.tally().accepted - accepted_before;
  }

  void decide(std::uint64_t trials, std::uint64_t accepted) {
    sampler_.window_trials += trials;
    sampler_.window_accepted += accepted;
    if (sampler_.window_trials < window_sweeps * n_spheres()) return;
    const double share =
        static_cast<double>(sampler_.window_accepted) / static_cast<double>(sampler_.window_trials);
    sampler_.window_trials = sampler_.window_accepted = 0;
    if (!sampler_.active && share < Directions::least_acceptance) begin_rejection_free();
    if (sampler_.active && share > several * Directions::least_acceptance) return_to_exhaustive();
  }

  // Hands the centres back to the exhaustive loop, if they are not there.
  [[gnu::noinline]] void return_to_exhaustive() {
    if (!sampler_.active) return;
    load(stored());
  }

  void be_exhaustive() {
    if (sampler_.active) exhaustive_.restore(move_, {});
    sampler_.active = false;
    sampler_.window_trials = sampler_.window_accepted = 0;
  }

  Packing stored() const {
    Packing packing{box_, {}, sizes_};
    store(packing);
    return packing;
  }

  std::vector<PackedCentre> exhaustive_centres() const {
    Packing packing{box_, {}, sizes_};
    exhaustive_.store(packing);
    std::vector<PackedCentre> centres;
    centres.reserve(packing.centres.size());
    for (std::size_t i = 0; i < packing.centres.size(); ++i) {
      centres.push_back(Spheres::several ? packed_sphere(packing.centres[i], packing.radius(i))
                                         : packed(packing.centres[i]));
    }
    return centres;
  }

  [[gnu::noinline]] void begin_rejection_free() {
    move_ = exhaustive_.state();
    sampler_.reference_step = move_.step;
    candidates_.build(exhaustive_centres(), sampler_.reference_step, move_.step);
    if (candidates_.share_of_trials() > most_candidates) return;
    sampler_.active = true;
    draw_candidate(move_.next_trial);
  }

  void draw_candidate(std::uint64_t first_word) {
    const std::uint64_t wait = candidates_.trials_before(++sampler_.candidate);
    sampler_.pending = wait == candidates_.never ? candidates_.never : first_word + wait;
  }

  void try_candidates(std::uint64_t n_trials) {
    const std::uint64_t end = move_.next_trial + n_trials;
    while (sampler_.pending < end) {
      ++tally_.candidates;
      tally_.accepted += candidates_.try_candidate(sampler_.candidate);
      draw_candidate(sampler_.pending + 1);
    }
    move_.next_trial = end;
  }

  // Trials are memoryless: the next candidate may be drawn anew at any moment.
  [[gnu::noinline]] void adapt_to_new_step() {
    if (move_.step > sampler_.reference_step || move_.step < 0.8 * sampler_.reference_step) {
      sampler_.reference_step = move_.step;
      candidates_.build(candidates_.centres(), sampler_.reference_step, move_.step);
    } else {
      candidates_.set_step(move_.step);
    }
    draw_candidate(move_.next_trial);
  }

  Box box_;
  std::shared_ptr<const Sizes> sizes_;
  TypedTrialLoop<Box, Policy, Spheres> exhaustive_;
  CandidateSampler<Box, Directions, Spheres> candidates_;
  MoveState move_;  // while rejection-free, when the centres are those of the candidates
  SamplerState sampler_;
  TrialTally tally_;
};

}  // namespace jostle::inline engine
