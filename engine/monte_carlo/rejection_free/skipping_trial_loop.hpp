#pragma once

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "engine/bed/elementary.hpp"
#include "engine/monte_carlo/kernel/typed_trial_loop.hpp"
#include "engine/monte_carlo/rejection_free/bound_tables.hpp"

namespace jostle {

/// The trial loop that looks only at candidates: trials that the bounds do not certainly refuse.
/// The number of trials up to the next candidate is geometric, so the law of the trajectory, counts
/// of trials included, is that of the exhaustive loop; the random numbers are others. It skips
/// while few trials are accepted, and is exhaustive otherwise, as after a tap.
template <class Box, Rise rise>
class SkippingTrialLoop final : public TrialLoop {
  static_assert(rise == Rise::impossible || rise == Rise::refused);
  static constexpr bool cubic = rise == Rise::refused;
  static constexpr int n_sectors = cubic ? cubic_sectors : polar_sectors;

 public:
  SkippingTrialLoop(const Box& box, const Move& move, StreamKey key,
                    const ProposalKernels& proposals, const SkippingKernels& kernels)
      : box_(box),
        packed_box_(box),
        key_(key),
        kernels_(kernels),
        exhaustive_(box, move, key, proposals),
        tables_(box, bounds_kernel(kernels)) {
    if (const auto* polar = std::get_if<PolarMove>(&move)) {
      theta_table_ = make_theta_table(*polar);
    } else {
      adaptation_ = std::get<MetropolisMove>(move).adaptation;
    }
    for (int p = 0; p < n_sectors; ++p) sector_begins_[p] = sector_begin(p, n_sectors);
  }

  void load(const Packing& packing) override {
    be_exhaustive();
    exhaustive_.load(packing);
  }

  void store(Packing& packing) const override {
    if (!sampler_.skipping) return exhaustive_.store(packing);
    packing.centres.resize(tables_.centres().size());
    std::ranges::transform(tables_.centres(), packing.centres.begin(), unpacked);
  }

  void begin_tap() override {
    look_again();
    be_exhaustive();
    exhaustive_.begin_tap();
  }

  void run(std::uint64_t n_trials) override {
    while (n_trials > 0) {
      const std::uint64_t piece = std::min(n_trials, until_decision());
      const std::uint64_t accepted_before = tally_.accepted;
      sampler_.skipping ? skip(piece) : look_at_all(piece);
      tally_.trials += piece;
      tally_.bound_rows = tables_.rows_made();
      n_trials -= piece;
      const std::uint64_t accepted = tally_.accepted - accepted_before;
      if (sampler_.skipping && adaptation_ &&
          adapt_step(*adaptation_, move_, {piece, 0, accepted, 0})) {
        adapt_to_new_step();
      }
      decide(piece, accepted);
    }
  }

  double mean_height() const override {
    if (!sampler_.skipping) return exhaustive_.mean_height();
    double sum = 0;
    for (const PackedCentre& centre : tables_.centres()) sum += centre.z;
    return sum / static_cast<double>(tables_.centres().size());
  }

  double solids_fraction(HeightWindow window) const override {
    Packing packing{box_, {}};
    store(packing);
    return jostle::solids_fraction(packing, window);
  }

  std::uint32_t n_spheres() const override { return exhaustive_.n_spheres(); }
  const MoveState& state() const override {
    return sampler_.skipping ? move_ : exhaustive_.state();
  }
  SamplerState sampler_state() const override { return sampler_; }
  void restore(const MoveState& move, const SamplerState& sampler) override {
    exhaustive_.restore(move, {});
    sampler_ = sampler;
    batch_valid_ = false;
    if (!sampler_.skipping) return;
    move_ = move;
    build_tables(exhaustive_centres());
  }
  const TrialTally& tally() const override { return tally_; }
  std::size_t bytes() const override {
    return sizeof(*this) + exhaustive_.bytes() + tables_.bytes();
  }

 private:
  // The exhaustive loop hands over once fewer than this share of a window's trials is accepted, and
  // takes over again where more than several times as many are: a step that adapts grows short.
  // Measured where both cost the same; a cold Metropolis trial is cheap to look at.
  static constexpr double least_acceptance = cubic ? 0.004 : 0.015, several = 3;
  static constexpr std::uint64_t window_sweeps = 25;
  // Beyond this share of candidates the bounds are of no use.
  static constexpr double most_candidates = 0.3;
  static constexpr std::uint32_t most_ahead = 8;
  static constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();

  static BoundsKernel<n_sectors> bounds_kernel(const SkippingKernels& kernels) {
    if constexpr (cubic) {
      return kernels.cubic_bounds;
    } else {
      return kernels.linear_bounds;
    }
  }

  std::uint64_t until_decision() const {
    const std::uint64_t window = window_sweeps * n_spheres() - sampler_.window_trials;
    if (!sampler_.skipping || !adaptation_) return window;
    return std::min(window, adaptation_->every_trials - move_.window_trials);
  }

  void look_at_all(std::uint64_t n_trials) {
    const TrialTally before = exhaustive_.tally();
    exhaustive_.run(n_trials);
    tally_.accepted += exhaustive_.tally().accepted - before.accepted;
    tally_.distance_tests += exhaustive_.tally().distance_tests - before.distance_tests;
    tally_.list_builds += exhaustive_.tally().list_builds - before.list_builds;
    tally_.list_renewals += exhaustive_.tally().list_renewals - before.list_renewals;
  }

  void decide(std::uint64_t trials, std::uint64_t accepted) {
    sampler_.window_trials += trials;
    sampler_.window_accepted += accepted;
    if (sampler_.window_trials < window_sweeps * n_spheres()) return;
    const double share =
        static_cast<double>(sampler_.window_accepted) / static_cast<double>(sampler_.window_trials);
    sampler_.window_trials = sampler_.window_accepted = 0;
    if (!sampler_.skipping && share < least_acceptance) begin_skipping();
    if (sampler_.skipping && share > several * least_acceptance) look_again();
  }

  // Hands the centres back to the exhaustive loop, if they are not there.
  void look_again() {
    if (!sampler_.skipping) return;
    Packing packing{box_, {}};
    store(packing);
    load(packing);
  }

  void be_exhaustive() {
    if (sampler_.skipping) exhaustive_.restore(move_, {});
    sampler_.skipping = false;
    sampler_.window_trials = sampler_.window_accepted = 0;
  }

  std::vector<PackedCentre> exhaustive_centres() const {
    Packing packing{box_, {}};
    exhaustive_.store(packing);
    std::vector<PackedCentre> centres(packing.centres.size());
    std::ranges::transform(packing.centres, centres.begin(), packed);
    return centres;
  }

  void begin_skipping() {
    move_ = exhaustive_.state();
    sampler_.reference_step = move_.step;
    build_tables(exhaustive_centres());
    if (candidate_share() > most_candidates) return;
    sampler_.skipping = true;
    draw_candidate(move_.next_trial);
  }

  void build_tables(std::vector<PackedCentre> centres) {
    if constexpr (cubic) {
      tables_.build(cubic_bins(sampler_.reference_step), std::move(centres));
    } else {
      tables_.build(polar_bins(theta_table_, sampler_.reference_step), std::move(centres));
    }
    n_located_ = 0;
    weigh();
  }

  // The probability that a trial is a candidate.
  double candidate_share() const {
    const double bounds = static_cast<double>(tables_.weights().total()) *
                          (1.0 / whole_weight / (n_ring_parts * n_sectors)) / n_spheres();
    if constexpr (cubic) {
      constexpr double solid_angle = 2 * 3.14159265358979323846;
      const double ratio = tables_.bins().longest / (2 * move_.step);
      return bounds * (ratio * ratio * ratio) * (solid_angle / 3);
    }
    return bounds;
  }

  // The mean of the exponential law whose floor is the number of trials before a candidate.
  void weigh() {
    const double share = candidate_share();
    mean_wait_ = share < 1e-12 ? 1 / std::max(share, 1e-30)
                 : share < 1   ? -1 / natural_log(1 - share)
                               : 0;
  }

  void draw_candidate(std::uint64_t from) {
    const double wait = batch_.waiting[fetch(++sampler_.candidate)] * mean_wait_;
    sampler_.pending = wait < 1e18 ? from + static_cast<std::uint64_t>(wait) : never;
  }

  // Makes sure that the batch holds a candidate; returns its place.
  std::uint32_t fetch(std::uint64_t number) {
    const auto place = static_cast<std::uint32_t>(number % CandidateBatch::size);
    const std::uint64_t first = number - place;
    if (batch_valid_ && batch_first_ == first) return place;
    kernels_.candidates(static_cast<std::uint64_t>(key_), first, n_sectors, batch_);
    n_located_ = 0;
    batch_first_ = first;
    batch_valid_ = true;
    return place;
  }

  void skip(std::uint64_t n_trials) {
    const std::uint64_t end = move_.next_trial + n_trials;
    while (sampler_.pending < end) {
      const std::uint32_t t = fetch(sampler_.candidate);
      if (t - first_located_ >= n_located_) locate_from(t);
      if (try_candidate(t, located_[t - first_located_])) n_located_ = 0;
      draw_candidate(sampler_.pending + 1);
    }
    move_.next_trial = end;
  }

  // Finds the spheres of some candidates of the batch: most are refused and change nothing, so
  // that the next ones are already known. After an acceptance fewer.
  void locate_from(std::uint32_t t) {
    n_ahead_ = n_located_ == 0 ? 2 : std::min(2 * n_ahead_, most_ahead);
    first_located_ = t;
    n_located_ = std::min(n_ahead_, CandidateBatch::size - t);
    for (std::uint32_t k = 0; k < n_located_; ++k) {
      located_[k] = locate(t + k);
      tables_.prefetch(located_[k].index);
    }
  }

  // The sphere of a candidate of the batch, and what chooses its bin.
  WeightTree::Hit locate(std::uint32_t t) const {
    __extension__ using Wide = unsigned __int128;
    const WeightTree& weights = tables_.weights();
    return weights.find(
        static_cast<std::uint64_t>((Wide{batch_.choice[t]} * weights.total()) >> 64));
  }

  Vec3 displacement(std::uint32_t t, const WeightTree::Hit& hit) const {
    const BoundRow<n_sectors>& row = tables_.row(hit.index);
    auto rest = static_cast<std::int32_t>(hit.rest);
    int sector = 0, ring = 0;
    while (rest >= row.sector_weight[sector]) rest -= row.sector_weight[sector++];
    for (;; ++ring) {
      const std::int32_t weight = row.weight[ring][sector] * tables_.bins().parts[ring];
      if (rest < weight) break;
      rest -= weight;
    }
    const double bound = row.weight[ring][sector] * (1.0 / whole_weight);
    double length = tables_.bins().longest * (cubic ? cube_root(bound) : bound);
    SineCosine theta;
    if constexpr (cubic) {
      theta = cubic_angle(ring, unit(batch_.theta[t]));
      length *= unit(std::max({batch_.length[0][t], batch_.length[1][t], batch_.length[2][t]}));
    } else {
      theta = polar_angle(theta_table_, ring, unit(batch_.theta[t]));
      length *= unit(batch_.length[0][t]);
    }
    const SineCosine begin = sector_begins_[sector];
    const double sideways = length * theta.sine;
    return {sideways * (begin.cosine * batch_.cosine[t] - begin.sine * batch_.sine[t]),
            sideways * (begin.sine * batch_.cosine[t] + begin.cosine * batch_.sine[t]),
            -(length * theta.cosine)};
  }

  static double unit(std::uint32_t word) { return (word + 0.5) * 0x1p-32; }

  // Returns whether the candidate was accepted.
  bool try_candidate(std::uint32_t t, const WeightTree::Hit& hit) {
    ++tally_.candidates;
    const Vec3 d = displacement(t, hit);
    if constexpr (cubic) {  // the bounds may reach beyond the cube of the trials
      const double side = std::max({std::abs(d.x), std::abs(d.y), -d.z});
      if (side > move_.step) return false;
    }
    const std::uint32_t i = hit.index;
    const PackedCentre& centre = tables_.centres()[i];
    const PackedCentre target =
        packed_box_.wrapped({centre.xy + Pair{d.x, d.y}, centre.z + d.z, 0});
    if (!packed_box_.clear_of_boundaries(target)) return false;
    if (tables_.blocked(i, target, tally_.distance_tests)) return false;
    tables_.move(i, target);
    weigh();
    ++tally_.accepted;
    return true;
  }

  // Trials are memoryless: the next candidate may be drawn anew at any moment.
  void adapt_to_new_step() {
    if (move_.step > sampler_.reference_step || move_.step < 0.8 * sampler_.reference_step) {
      sampler_.reference_step = move_.step;
      build_tables(tables_.centres());
    } else {
      weigh();
    }
    draw_candidate(move_.next_trial);
  }

  Box box_;
  PackedBox<Box> packed_box_;
  StreamKey key_;
  SkippingKernels kernels_;
  std::optional<StepAdaptation> adaptation_;
  std::vector<double> theta_table_;
  TypedTrialLoop<Box, rise> exhaustive_;
  BoundTables<Box, n_sectors> tables_;
  MoveState move_;  // while skipping, when the centres are those of the tables
  SamplerState sampler_;
  TrialTally tally_;
  std::array<SineCosine, n_sectors> sector_begins_;
  double mean_wait_ = 0;
  CandidateBatch batch_;
  std::array<WeightTree::Hit, most_ahead> located_;
  std::uint32_t first_located_ = 0, n_located_ = 0, n_ahead_ = 0;
  std::uint64_t batch_first_ = 0;
  bool batch_valid_ = false;
};

}  // namespace jostle
