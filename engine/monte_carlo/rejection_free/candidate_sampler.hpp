#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "engine/bed/elementary.hpp"
#include "engine/bed/random.hpp"
#include "engine/monte_carlo/rejection_free/bound_tables.hpp"
#include "engine/monte_carlo/rejection_free/directions.hpp"

namespace jostle::inline engine {

/// Draws candidates, the trials that the bounds do not certainly reject, and tries them. Candidates
/// have numbers of their own: what one draws is a function of the stream, its number, the centres
/// and the step.
template <class Box, class Directions, class Spheres = EqualSpheres>
class CandidateSampler {
  static constexpr int n_sectors = Directions::n_sectors;

 public:
  static constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();

  CandidateSampler(const Box& box, const typename Directions::Policy& move, StreamKey key,
                   const RejectionFreeKernels& kernels)
      : box_(box), key_(key), kernels_(kernels), directions_(move), tables_(box, kernels) {
    for (int p = 0; p < n_sectors; ++p) sector_begins_[p] = sector_begin(p, n_sectors);
  }

  /// Takes over the centres, [n], with bounds for steps up to `reference_step`; trials are of
  /// `step`, no longer than that. MoveState::step both.
  void build(std::vector<PackedCentre> centres, double reference_step, double step) {
    tables_.build(directions_.bins(reference_step), std::move(centres));
    n_located_ = 0;
    set_step(step);
  }

  /// Trials are of `step` from now on.
  void set_step(double step) {
    step_ = step;
    weigh();
  }

  /// The probability that a trial is a candidate, for the present centres.
  double share_of_trials() const {
    const double share = static_cast<double>(tables_.weights().total()) *
                         (1.0 / whole_weight / (n_ring_parts * n_sectors)) /
                         static_cast<double>(centres().size());
    return Directions::probability(share, tables_.bins(), step_);
  }

  /// How many trials pass before the candidate of that number, from the one before it or from any
  /// later moment: geometric. `never` beyond 1e18.
  std::uint64_t trials_before(std::uint64_t number) {
    const double wait = batch_.waiting[fetch(number)] * mean_wait_;
    return wait < 1e18 ? static_cast<std::uint64_t>(wait) : never;
  }

  /// Makes the candidate's trial; returns whether it was accepted.
  bool try_candidate(std::uint64_t number) {
    const std::uint32_t t = fetch(number);
    if (t - first_located_ >= n_located_) locate_from(t);
    const bool accepted = accepts(t, located_[t - first_located_]);
    if (accepted) n_located_ = 0;
    return accepted;
  }

  /// For another loop, or after a restore: no candidate of this batch is known.
  void forget_batch() { batch_valid_ = false; }

  const std::vector<PackedCentre>& centres() const { return tables_.centres(); }
  std::uint64_t rows_made() const { return tables_.rows_made(); }
  std::uint64_t distance_tests() const { return distance_tests_; }
  std::size_t bytes() const { return tables_.bytes(); }

 private:
  static constexpr std::uint32_t most_ahead = 8;

  // The mean of the exponential law whose floor is the number of trials before a candidate.
  void weigh() {
    const double share = share_of_trials();
    mean_wait_ = share < 1e-12 ? 1 / std::max(share, 1e-30)
                 : share < 1   ? -1 / natural_log(1 - share)
                               : 0;
  }

  // Makes sure that the batch holds a candidate; returns its place.
  std::uint32_t fetch(std::uint64_t number) {
    const auto place = static_cast<std::uint32_t>(number % CandidateBatch::size);
    const std::uint64_t first = number - place;
    if (batch_valid_ && batch_first_ == first) return place;
    kernels_.draw_candidates(static_cast<std::uint64_t>(key_), first, n_sectors, batch_);
    n_located_ = 0;
    batch_first_ = first;
    batch_valid_ = true;
    return place;
  }

  // Finds the spheres of some candidates of the batch: most are rejected and change nothing, so
  // that the next ones are already known. After an acceptance fewer. Not inlined: its code then
  // does not depend on the loop around it.
  [[gnu::noinline]] void locate_from(std::uint32_t t) {
    n_ahead_ = n_located_ == 0 ? 2 : std::min(2 * n_ahead_, most_ahead);
    first_located_ = t;
    n_located_ = std::min(n_ahead_, CandidateBatch::size - t);
    for (std::uint32_t k = 0; k < n_located_; ++k) {
      located_[k] = locate(t + k);
      tables_.prefetch(located_[k].sphere);
    }
  }

  // The sphere of a candidate of the batch, and what chooses its bin: rest + fraction is uniform in
  // [0, weight).
  struct Located {
    std::uint32_t sphere;
    std::int32_t rest;
    double fraction;
  };
  Located locate(std::uint32_t t) const {
    __extension__ using Wide = unsigned __int128;
    const WeightTree& weights = tables_.weights();
    const Wide target = Wide{batch_.choice[t]} * weights.total();
    const WeightTree::Hit hit = weights.find(static_cast<std::uint64_t>(target >> 64));
    const auto fraction = static_cast<std::uint64_t>(target) >> 11;
    return {hit.index, static_cast<std::int32_t>(hit.rest),
            static_cast<double>(fraction) * 0x1p-53};
  }

  // The bin that a candidate falls in, and its bound over the longest step.
  struct Bin {
    int sector, ring;
    double length_ratio;
  };
  std::optional<Bin> bin_of(const Located& located) const {
    const auto& row = tables_.row(located.sphere);
    int sector = 0;
    for (int p = 0; p < n_sectors; ++p) sector += row.up_to[p] <= located.rest;
    const std::int32_t weight_before = sector == 0 ? 0 : row.up_to[sector - 1];
    double rest = (located.rest - weight_before) + located.fraction;
    // The likeliest first. A sector weighs a little more than its bins.
    for (int ring = n_rings - 1; ring >= 0; --ring) {
      const double size = Directions::size(row.bound(ring, sector));
      rest -= size * (tables_.bins().parts[ring] * whole_weight);
      if (rest < 0) return Bin{sector, ring, Directions::length_ratio(size)};
    }
    return std::nullopt;
  }

  Vec3 displacement(std::uint32_t t, const Bin& bin) const {
    const SineCosine theta = directions_.angle(bin.ring, unit(batch_.theta[t]));
    const double length =
        tables_.bins().longest * bin.length_ratio * unit(Directions::length_word(batch_, t));
    const SineCosine begin = sector_begins_[bin.sector];
    const double sideways = length * theta.sine;
    return {sideways * (begin.cosine * batch_.cosine[t] - begin.sine * batch_.sine[t]),
            sideways * (begin.sine * batch_.cosine[t] + begin.cosine * batch_.sine[t]),
            -(length * theta.cosine)};
  }

  static double unit(std::uint32_t word) { return (word + 0.5) * 0x1p-32; }

  bool accepts(std::uint32_t t, const Located& located) {
    const std::optional<Bin> bin = bin_of(located);
    if (!bin) return false;
    const Vec3 d = displacement(t, *bin);
    if (!Directions::proposes(d, step_)) return false;
    const std::uint32_t i = located.sphere;
    const PackedCentre& centre = centres()[i];
    const PackedCentre target = box_.wrapped(
        {centre.xy + Pair{d.x, d.y}, centre.z + d.z, Spheres::several ? centre.radius : 0});
    if (!box_.clear_of_boundaries(target)) return false;
    if (tables_.blocked(i, d, target, distance_tests_)) return false;
    tables_.move(i, target);
    weigh();
    return true;
  }

  PackedBox<Box, Spheres> box_;
  StreamKey key_;
  RejectionFreeKernels kernels_;
  Directions directions_;
  BoundTables<Box, Directions, Spheres> tables_;
  double step_ = 0;
  std::array<SineCosine, n_sectors> sector_begins_;
  double mean_wait_ = 0;
  CandidateBatch batch_;
  std::array<Located, most_ahead> located_;
  std::uint32_t first_located_ = 0, n_located_ = 0, n_ahead_ = 0;
  std::uint64_t batch_first_ = 0;
  bool batch_valid_ = false;
  std::uint64_t distance_tests_ = 0;
};

}  // namespace jostle::inline engine
