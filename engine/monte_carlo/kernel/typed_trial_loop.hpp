#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <memory>
#include <utility>

#include "engine/bed/slab.hpp"
#include "engine/monte_carlo/kernel/caching_rule.hpp"
#include "engine/monte_carlo/kernel/move_policies.hpp"
#include "engine/monte_carlo/kernel/neighbourhood.hpp"
#include "engine/monte_carlo/kernel/proposals.hpp"
#include "engine/monte_carlo/trial_loop.hpp"

namespace jostle::inline engine {

/// The trial loop of one container and one move, for equal spheres or several sizes: the Metropolis
/// algorithm for hard spheres in gravity (Metropolis et al., J. Chem. Phys. 21, 1087 (1953)); the
/// polar move is that of Philippe & Bideau 2001, sec. II. A trial of sphere i at r is
///
///   1. r' = r + d, wrapped; i and d are drawn from (key, number of the trial)  proposals.hpp
///   2. rejected if r' is nearer to floor or sides than its radius              packed_geometry.hpp
///   3. rejected if |r' - r_j| < R_i + R_j for a neighbour j                    neighbourhood.hpp
///   4. if z' > z, accepted with probability exp(-beta m g (z' - z))            move_policies.hpp
///   5. r = r' if accepted
///
/// Everything else happens once per batch of trials or more rarely: lists and caches are made, the
/// step adapts. Invariants: no two spheres overlap and none lies beyond floor or sides; the
/// trajectory is a function of the start and the key alone, whatever lists, caches and batches
/// hold.
template <class Box, MovePolicy Policy, class Spheres = EqualSpheres>
class TypedTrialLoop final : public TrialLoop {
 public:
  TypedTrialLoop(const Box& box, Policy move, StreamKey key, const ProposalKernels& kernels)
      : box_(box), key_(key), kernels_(kernels), move_(std::move(move)), neighbourhood_(box) {
    state_.step = move_.max_step();
  }

  void load(const Packing& packing) override {
    if constexpr (!Spheres::several)
      require_equal_spheres(packing, "trials of a loop made for equal spheres");
    sizes_ = packing.sizes;
    neighbourhood_.load(packing);
    batch_valid_ = false;
  }
  void store(Packing& packing) const override { neighbourhood_.store(packing); }
  void begin_tap() override { move_.begin_tap(state_); }

  void run(std::uint64_t n_trials) override {
    assert(n_spheres() > 0);
    while (n_trials > 0) {
      const std::uint64_t offset = state_.next_trial % ProposalBatch::size;
      if (!batch_valid_ || offset == 0) propose(state_.next_trial - offset);
      const std::uint64_t piece =
          std::min({n_trials, ProposalBatch::size - offset, move_.until_adaptation(state_)});
      const TrialCounts counts =
          run_batch(static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(offset + piece));
      state_.next_trial += piece;
      tally_.trials += piece;
      tally_.accepted += counts.accepted;
      move_.adapt(state_, counts);
      n_trials -= piece;
    }
    tally_.list_builds = neighbourhood_.builds();
    tally_.list_renewals = neighbourhood_.renewals();
  }

  double mean_height() const override {
    if constexpr (Spheres::several) return jostle::mean_height(stored());
    double sum = 0;
    for (const PackedCentre& centre : neighbourhood_.centres()) sum += centre.z;
    return sum / static_cast<double>(n_spheres());
  }

  std::vector<double> kind_heights() const override {
    if constexpr (Spheres::several) return jostle::kind_heights(stored());
    return {};
  }

  double solids_fraction(HeightWindow window) const override {
    return jostle::solids_fraction(stored(), window);
  }

  std::uint32_t n_spheres() const override {
    return static_cast<std::uint32_t>(neighbourhood_.centres().size());
  }
  const MoveState& state() const override { return state_; }
  void restore(const MoveState& state, const SamplerState&) override {
    state_ = state;
    batch_valid_ = false;
  }
  const TrialTally& tally() const override { return tally_; }
  std::size_t bytes() const override {
    return sizeof(*this) + neighbourhood_.bytes() + move_.bytes();
  }
  const Policy& move() const { return move_; }

 private:
  static constexpr std::uint32_t group = 16;  // trials tested per cache pass
  // Above this number of spheres the data exceed the processor's caches: prefetch.
  static constexpr std::uint32_t many_spheres = 10'000;

  Packing stored() const {
    Packing packing{box_, {}, sizes_};
    store(packing);
    return packing;
  }

  // m g dz of a rise, in units of m g d: m is that of a sphere of diameter 1.
  [[gnu::always_inline]] double cost_of_rise(std::uint32_t sphere, double dz) const {
    if constexpr (Spheres::several)
      if (sizes_) return sizes_->mass(sphere) * dz;
    return dz;
  }

  void propose(std::uint64_t first) {
    const BatchOrigin origin{static_cast<std::uint64_t>(key_), first, n_spheres()};
    move_.propose(kernels_, origin, batch_);
    batch_valid_ = true;
  }

  TrialCounts run_batch(std::uint32_t begin, std::uint32_t end) {
    const TrialRange range = move_.looked_at(begin, end);
    const std::uint32_t n_trials = end - begin;
    TrialCounts counts{.trials = n_trials, .rising = n_trials - (range.last - range.first)};
    if (Policy::geometry_decides && caching_.caching_pays()) {
      run_groups(range, counts);
    } else {
      run_one_by_one(begin, range, counts);
    }
    if (Policy::geometry_decides) caching_.count(n_trials, counts.accepted, n_spheres());
    return counts;
  }

  // The loops are never inlined, nor are the rare paths out of them: their code then does not
  // depend on what else a program holds (bench/instruction_costs.py).

  // One trial after another; `begin` is the trial of the batch that state_ reached.
  [[gnu::noinline]] void run_one_by_one(std::uint32_t begin, TrialRange range,
                                        TrialCounts& counts) {
    auto view = neighbourhood_.template view<BlockerCaching::disabled>(move_.reach(state_.step));
    const double unit = move_.unit(state_.step);
    for (std::uint32_t k = range.first; k < range.last; ++k) {
      view.fetch_list(batch_.sphere[move_.trial(k + ProposalBatch::margin)]);
      const std::uint32_t t = move_.trial(k);
      const std::uint32_t i = batch_.sphere[t];
      const bool rises = move_.rises(batch_.dz[t]);
      counts.rising += rises;
      const PackedCentre target = target_of(view, t, unit);
      if (view.rejects(i, target)) continue;
      if (rises) {
        const std::uint64_t trial = state_.next_trial + (t - begin);
        if (!move_.accepts_rise(trial, cost_of_rise(i, unit * batch_.dz[t]))) continue;
      }
      const bool moved = view.move(i, target);
      counts.accepted += moved;
      counts.accepted_rising += moved && rises;
    }
    tally_.distance_tests += view.distance_tests();
  }

  // Like run_one_by_one(), where fewer trials are accepted: a group of trials is first tested
  // against the caches, without branches, and only those that pass are looked at closely; where
  // memory is far and hardly any is accepted, two groups later, when what that takes has been
  // fetched. An accepted trial invalidates the later candidates: it moves a sphere or renews a
  // list.
  [[gnu::noinline]] void run_groups(TrialRange range, TrialCounts& counts) {
    std::array<std::uint32_t, 4 * group> open;
    std::uint32_t n_open = 0, n_fetched = 0;
    auto view = neighbourhood_.template view<BlockerCaching::enabled>(move_.reach(state_.step));
    const double unit = move_.unit(state_.step);
    const bool wait = caching_.hardly_any_accepted() && n_spheres() > many_spheres;
    for (std::uint32_t k = range.first; k < range.last || n_open > 0;) {
      const std::uint32_t known = n_open, end = std::min(k + group, range.last);
      tally_.distance_tests += BlockerCache::size * (end - k);
      for (; k < end; ++k) {
        view.fetch_cache(batch_.sphere[move_.trial(k + ProposalBatch::margin)]);
        open[n_open] = k;
        n_open += !certainly_rejects(view, move_.trial(k), unit);
      }
      std::uint32_t due = n_open;
      if (wait) {
        if (k < range.last) due = n_fetched;
        for (std::uint32_t s = n_fetched; s < known; ++s) {
          view.fetch_neighbours(batch_.sphere[move_.trial(open[s])]);
        }
        for (std::uint32_t s = known; s < n_open; ++s) {
          view.fetch_list(batch_.sphere[move_.trial(open[s])]);
        }
        n_fetched = known;
      }
      std::uint32_t s = 0;
      while (s < due && !moves_if_free(view, move_.trial(open[s]), unit, counts)) ++s;
      if (s < due) {
        k = open[s] + 1;
        n_open = n_fetched = 0;
      } else {
        std::copy(open.begin() + due, open.begin() + n_open, open.begin());
        n_open -= due;
        n_fetched -= std::min(n_fetched, due);
      }
    }
    tally_.distance_tests += view.distance_tests();
  }

  // Decides a trial that its cache lets pass. Returns true if no neighbour of the list rejects it:
  // it is then accepted, or a new list shows what rejects it.
  template <class View>
  [[gnu::always_inline]] bool moves_if_free(View& view, std::uint32_t t, double unit,
                                            TrialCounts& counts) {
    const std::uint32_t i = batch_.sphere[t];
    const PackedCentre target = target_of(view, t, unit);
    if (view.rejects(i, target)) return false;
    counts.accepted += view.move(i, target);
    return true;
  }

  template <class View>
  [[gnu::always_inline]] bool certainly_rejects(const View& view, std::uint32_t t,
                                                double unit) const {
    return view.certainly_rejects(batch_.sphere[t], unit * batch_.dx[t], unit * batch_.dy[t],
                                  unit * batch_.dz[t]);
  }

  template <class View>
  [[gnu::always_inline]] PackedCentre target_of(const View& view, std::uint32_t t,
                                                double unit) const {
    return view.target(batch_.sphere[t], unit * Pair{batch_.dx[t], batch_.dy[t]},
                       unit * batch_.dz[t]);
  }

  Box box_;
  StreamKey key_;
  ProposalKernels kernels_;
  Policy move_;
  MoveState state_;
  TrialTally tally_;
  std::shared_ptr<const Sizes> sizes_;
  Neighbourhood<Box, Spheres> neighbourhood_;
  CachingRule caching_;
  ProposalBatch batch_;
  bool batch_valid_ = false;
};

}  // namespace jostle::inline engine
