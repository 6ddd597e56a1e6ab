#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

#include "engine/bed/elementary.hpp"
#include "engine/bed/slab.hpp"
#include "engine/monte_carlo/kernel/falling_trials.hpp"
#include "engine/monte_carlo/kernel/neighbour_lists.hpp"
#include "engine/monte_carlo/kernel/packed_geometry.hpp"
#include "engine/monte_carlo/kernel/proposals.hpp"
#include "engine/monte_carlo/kernel/shields.hpp"
#include "engine/monte_carlo/step_adaptation.hpp"
#include "engine/monte_carlo/theta_table.hpp"
#include "engine/monte_carlo/trial_loop.hpp"

namespace jostle {

/// What decides a trial that rises: it cannot happen (polar), it is refused (cold), it passes with
/// probability exp(-beta dz) (thermal), or height does not matter (weightless).
enum class Rise { impossible, refused, thermal, free };

/// The trial loop of one container and one kind of move. One trial is: propose, wrap, test floor
/// and sides, test the neighbours, accept or refuse. Everything else happens once a batch or more
/// rarely.
template <class Box, Rise rise>
class TypedTrialLoop final : public TrialLoop {
 public:
  TypedTrialLoop(const Box& box, const Move& move, StreamKey key, const ProposalKernels& kernels)
      : box_(box), key_(key), kernels_(kernels) {
    if (const auto* polar = std::get_if<PolarMove>(&move)) {
      polar_ = *polar;
      theta_table_ = make_theta_table(polar_);
      state_.step = polar_.max_step;
    } else {
      metropolis_ = std::get<MetropolisMove>(move);
      state_.step = metropolis_.max_step;
    }
  }

  void load(const Packing& packing) override {
    centres_.resize(packing.centres.size());
    std::ranges::transform(packing.centres, centres_.begin(), packed);
    lists_valid_ = false;
    batch_valid_ = false;
  }

  void store(Packing& packing) const override {
    packing.centres.resize(centres_.size());
    std::ranges::transform(centres_, packing.centres.begin(), unpacked);
  }

  void begin_tap() override {
    if constexpr (rise != Rise::impossible) {
      if (metropolis_.adaptation && metropolis_.adaptation->reset_each_tap) {
        state_.step = metropolis_.max_step;
        lists_valid_ = false;  // a longer step wants a wider skin
        state_.window_trials = state_.window_base = state_.window_accepted = 0;
      }
    }
  }

  void run(std::uint64_t n_trials) override {
    assert(!centres_.empty());
    if (!lists_valid_) build_lists();
    while (n_trials > 0) {
      const std::uint64_t offset = state_.next_trial % ProposalBatch::size;
      if (!batch_valid_ || offset == 0) propose(state_.next_trial - offset);
      std::uint64_t piece = std::min(n_trials, ProposalBatch::size - offset);
      if constexpr (rise != Rise::impossible) piece = std::min(piece, until_adaptation());
      const BatchCounts counts =
          run_batch(static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(offset + piece));
      state_.next_trial += piece;
      tally_.trials += piece;
      tally_.accepted += counts.accepted;
      tally_.distance_tests += counts.distance_tests;
      if constexpr (rise != Rise::impossible) {
        if (metropolis_.adaptation) {
          adapt_step(*metropolis_.adaptation, state_,
                     {piece, counts.rising, counts.accepted, counts.accepted_rising});
        }
      }
      n_trials -= piece;
    }
  }

  double mean_height() const override {
    double sum = 0;
    for (const PackedCentre& centre : centres_) sum += centre.z;
    return sum / static_cast<double>(centres_.size());
  }

  double solids_fraction(HeightWindow window) const override {
    Packing packing{box_, {}};
    store(packing);
    return jostle::solids_fraction(packing, window);
  }

  std::uint32_t n_spheres() const override { return static_cast<std::uint32_t>(centres_.size()); }
  const MoveState& state() const override { return state_; }
  void restore(const MoveState& state, const SamplerState&) override {
    state_ = state;
    batch_valid_ = false;
    lists_valid_ = false;  // a longer step wants a wider skin
  }
  const TrialTally& tally() const override { return tally_; }
  std::size_t bytes() const override {
    return sizeof(*this) + lists_.bytes() + shields_.bytes() +
           sizeof(PackedCentre) * centres_.capacity() + sizeof(double) * theta_table_.capacity();
  }

 private:
  // Room in the skin beyond the longest step, diameters (bench/: little changes from 0.1 to 0.3).
  static constexpr double spare_skin = 0.2;

  // Trials held against shields together, and the acceptances, one in so many, below which that is
  // begun and above which it is ended.
  static constexpr std::uint32_t group = 16, quiet_one_in = 6, busy_one_in = 4, rare_one_in = 100;

  struct BatchCounts {
    std::uint64_t accepted = 0, rising = 0, accepted_rising = 0, distance_tests = 0;
  };

  void propose(std::uint64_t first) {
    const BatchOrigin origin{static_cast<std::uint64_t>(key_), first, n_spheres()};
    if constexpr (rise == Rise::impossible) {
      kernels_.polar(origin, theta_table_.data(), polar_.max_step, batch_);
    } else {
      kernels_.metropolis(origin, batch_);
    }
    if constexpr (rise == Rise::refused) falling_.list(batch_);
    batch_valid_ = true;
  }

  // What the loop reads again and again, in locals: the compiler cannot know that no store to a
  // centre changes them.
  struct View {
    PackedBox<Box> box;
    PackedCentre* centres;
    const NeighbourLists::Index* rows;
    std::size_t stride;
    const Shield* shields;
    const PackedCentre* origins;
    double half_skin_squared;
    double step;
    bool wait;  // for what trials that pass their shields take to look at closely
  };
  View view() {
    return {PackedBox<Box>(box_),
            centres_.data(),
            lists_.rows(),
            lists_.stride(),
            shields_.data(),
            lists_.origins(),
            lists_.half_skin_squared(),
            rise == Rise::impossible ? 1.0 : state_.step,
            rare_ && centres_.size() > 10'000};
  }

  BatchCounts run_batch(std::uint32_t begin, std::uint32_t end) {
    BatchCounts counts;
    std::uint32_t first = begin, last = end;
    if constexpr (rise == Rise::refused) {
      first = falling_.before(begin);
      last = falling_.before(end);
      counts.rising = (end - begin) - (last - first);
    }
    // Rises at finite beta draw a number of their own: they are counted one by one.
    if (rise == Rise::thermal || busy_) {
      run_one_by_one(begin, first, last, counts);
    } else {
      run_shielded(first, last, counts);
    }
    if constexpr (rise != Rise::thermal) watch_acceptance(end - begin, counts.accepted);
    return counts;
  }

  // Decides, once a sweep or more rarely, whether shields pay.
  void watch_acceptance(std::uint64_t trials, std::uint64_t accepted) {
    watched_trials_ += trials;
    watched_accepted_ += accepted;
    if (watched_trials_ < std::max<std::uint64_t>(n_spheres(), 4 * ProposalBatch::size)) return;
    const bool was_busy = busy_;
    busy_ = watched_accepted_ * (busy_ ? quiet_one_in : busy_one_in) > watched_trials_;
    rare_ = watched_accepted_ * rare_one_in < watched_trials_;
    watched_trials_ = watched_accepted_ = 0;
    if (was_busy && !busy_) raise_shields();
  }
  [[gnu::noinline]] void raise_shields() { shields_.build(PackedBox<Box>(box_), centres_, lists_); }

  // The loops are never inlined, nor are the rare paths out of them: their code then does not
  // depend on what else a program holds (bench/instruction_costs.py).

  // Trials first .. last - 1 of those looked at, one after another.
  [[gnu::noinline]] void run_one_by_one(std::uint32_t begin, std::uint32_t first,
                                        std::uint32_t last, BatchCounts& counts) {
    View here = view();
    for (std::uint32_t k = first; k < last; ++k) {
      fetch_list(here, k + ProposalBatch::margin);
      const std::uint32_t t = looked_at(k);
      const std::uint32_t i = batch_.sphere[t];
      const PackedCentre target = target_of(here, t);
      if constexpr (rise == Rise::thermal) counts.rising += batch_.dz[t] > 0;
      if (!here.box.clear_of_boundaries(target)) continue;
      if (blocked(here, i, target, here.rows[i * here.stride], counts.distance_tests)) continue;
      if constexpr (rise == Rise::thermal) {
        const std::uint64_t trial = state_.next_trial + (t - begin);
        if (batch_.dz[t] > 0 && !rise_passes(trial, here.step * batch_.dz[t])) continue;
      }
      const bool moved = accept(here, i, target, counts);
      if constexpr (rise == Rise::thermal) counts.accepted_rising += moved && batch_.dz[t] > 0;
    }
  }

  // The same where fewer trials are accepted: a group of trials is first held against the shields,
  // without branches, and only those that pass are looked at closely; where memory is far and
  // hardly any is accepted, two groups later, when what that takes has been fetched. One that
  // nothing blocks forgets what was found after it: it moves a sphere or renews a list.
  [[gnu::noinline]] void run_shielded(std::uint32_t first, std::uint32_t last,
                                      BatchCounts& counts) {
    std::array<std::uint32_t, 4 * group> open;
    std::uint32_t n_open = 0, n_fetched = 0;
    View here = view();
    for (std::uint32_t k = first; k < last || n_open > 0;) {
      const std::uint32_t known = n_open, end = std::min(k + group, last);
      counts.distance_tests += Shield::size * (end - k);
      for (; k < end; ++k) {
        __builtin_prefetch(&here.shields[batch_.sphere[looked_at(k + ProposalBatch::margin)]]);
        open[n_open] = k;
        n_open += !shut_out(here, looked_at(k));
      }
      std::uint32_t due = n_open;
      if (here.wait) {
        if (k < last) due = n_fetched;
        for (std::uint32_t s = n_fetched; s < known; ++s) fetch_neighbours(here, open[s]);
        for (std::uint32_t s = known; s < n_open; ++s) fetch_list(here, open[s]);
        n_fetched = known;
      }
      std::uint32_t s = 0;
      while (s < due && !passes(here, looked_at(open[s]), counts)) ++s;
      if (s < due) {
        k = open[s] + 1;
        n_open = n_fetched = 0;
      } else {
        std::copy(open.begin() + due, open.begin() + n_open, open.begin());
        n_open -= due;
        n_fetched -= std::min(n_fetched, due);
      }
    }
  }

  // A trial that its shield lets pass. True if no neighbour blocks it: it is then accepted, or a
  // new list shows what blocks it.
  [[gnu::always_inline]] bool passes(View& here, std::uint32_t t, BatchCounts& counts) {
    const std::uint32_t i = batch_.sphere[t];
    const PackedCentre target = target_of(here, t);
    if (!here.box.clear_of_boundaries(target)) return false;
    if (blocked_beyond_shield(here, i, target, counts.distance_tests)) return false;
    accept(here, i, target, counts);
    return true;
  }

  [[gnu::always_inline]] bool shut_out(const View& here, std::uint32_t t) const {
    return shuts<Box>(here.shields[batch_.sphere[t]], static_cast<float>(here.step * batch_.dx[t]),
                      static_cast<float>(here.step * batch_.dy[t]),
                      static_cast<float>(here.step * batch_.dz[t]));
  }

  // Whether a neighbour blocks what the shield let pass. One that does moves up in the list:
  // shields come to hold those that block most often.
  [[gnu::noinline]] bool blocked_beyond_shield(const View& here, std::uint32_t i,
                                               const PackedCentre& target, std::uint64_t& tests) {
    const auto* const row = here.rows + i * here.stride;
    for (std::uint32_t place = Shield::size; place < row[0]; ++place) {
      ++tests;
      if (distance_squared(here.box, target, here.centres[row[1 + place]]) < 1.0) {
        shields_.promote(here.box, centres_, lists_, i, place);
        return true;
      }
    }
    return blocked(here, i, target, std::min(*row, Shield::size), tests);
  }

  [[gnu::always_inline]] PackedCentre target_of(const View& here, std::uint32_t t) const {
    const PackedCentre& from = here.centres[batch_.sphere[t]];
    return here.box.wrapped({from.xy + here.step * Pair{batch_.dx[t], batch_.dy[t]},
                             from.z + here.step * batch_.dz[t], 0});
  }

  // Moves sphere i, which nothing in its list blocks; false if a new list shows that something
  // does.
  [[gnu::always_inline]] bool accept(View& here, std::uint32_t i, const PackedCentre& target,
                                     BatchCounts& counts) {
    const bool shielded = rise != Rise::thermal && !busy_;
    if (distance_squared(here.box, target, here.origins[i]) > here.half_skin_squared) {
      if (shielded) shields_.before_renewal(lists_, i);
      // The list may lack what lies there: one made where the sphere stands has it.
      if (lists_.renew(box_, i, here.centres[i])) {
        ++tally_.list_renewals;
        if (shielded) shields_.after_renewal(here.box, centres_, lists_);
      } else {
        build_lists();
        here = view();
      }
      if (blocked(here, i, target, *lists_.row(i), counts.distance_tests)) {
        if (shielded) shields_.follow(here.box, centres_, lists_, i);
        return false;
      }
    }
    here.centres[i] = target;
    if (shielded) shields_.follow(here.box, centres_, lists_, i);
    ++counts.accepted;
    return true;
  }

  // Whether one of the first n neighbours overlaps a sphere i placed at `target`.
  [[gnu::always_inline]] static bool blocked(const View& here, std::uint32_t i,
                                             const PackedCentre& target, std::uint32_t n,
                                             std::uint64_t& tests) {
    const auto* const row = here.rows + i * here.stride;
    const auto* const last = row + 1 + n;
    for (const auto* j = row + 1; j < last; ++j) {
      ++tests;
      if (distance_squared(here.box, target, here.centres[*j]) < 1.0) return true;
    }
    return false;
  }

  [[gnu::noinline]] bool rise_passes(std::uint64_t trial, double dz) const {
    const double u = (philox_block(key_, trial, 1)[0] + 0.5) * 0x1p-32;
    return u < exponential(-(metropolis_.beta * dz));
  }

  [[gnu::always_inline]] void fetch_list(const View& here, std::uint32_t k) const {
    const std::uint32_t i = batch_.sphere[looked_at(k)];
    __builtin_prefetch(&here.centres[i]);
    __builtin_prefetch(here.rows + i * here.stride);
  }
  [[gnu::noinline]] void fetch_neighbours(const View& here, std::uint32_t k) const {
    const auto* const row = here.rows + batch_.sphere[looked_at(k)] * here.stride;
    for (std::uint32_t m = 1; m <= row[0]; ++m) __builtin_prefetch(&here.centres[row[m]]);
  }

  // The trial of the batch that is looked at as the k-th.
  std::uint32_t looked_at(std::uint32_t k) const {
    if constexpr (rise == Rise::refused) return falling_[k];
    return k;
  }

  std::uint64_t until_adaptation() const {
    if (!metropolis_.adaptation) return ProposalBatch::size;
    return metropolis_.adaptation->every_trials - state_.window_trials;
  }

  // The longest displacement of a trial, diameters, with room for rounding.
  double longest_step() const {
    return (rise == Rise::impossible ? 1.0 : 1.7320508075688773) * state_.step * 1.000001;
  }

  [[gnu::noinline]] void build_lists() {
    Vec3 drift;
    if constexpr (rise == Rise::impossible) drift.z = -0.43 * state_.step;
    if constexpr (rise == Rise::refused) drift.z = -0.5 * state_.step;
    lists_.build(box_, centres_, 2 * longest_step() + spare_skin, drift);
    lists_valid_ = true;
    if (!busy_) raise_shields();
    ++tally_.list_builds;
  }

  Box box_;
  StreamKey key_;
  ProposalKernels kernels_;
  PolarMove polar_;
  MetropolisMove metropolis_;
  MoveState state_;
  TrialTally tally_;
  std::vector<double> theta_table_;
  PackedCentres centres_;
  NeighbourLists lists_;
  bool lists_valid_ = false;
  bool batch_valid_ = false;
  Shields<Box> shields_;  // up to date unless busy
  bool busy_ = true;      // many trials were accepted of late
  bool rare_ = false;     // hardly any
  std::uint64_t watched_trials_ = 0, watched_accepted_ = 0;
  ProposalBatch batch_;
  FallingTrials falling_;  // in the cold
};

}  // namespace jostle
