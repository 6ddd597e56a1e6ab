#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "engine/bed/geometry.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/starts/starts.hpp"
#include "tests/ensemble/bits.hpp"
#include "tests/monte_carlo_plan.hpp"

#include "ensemble/realization.hpp"

// Conditions of every hard case: finite numbers, no overlap beyond rounding, work in proportion
// to the trials, the same bits when repeated.
namespace jostle {

inline const StreamKey hard_case_key = stream_key(20260101, 0, 0, Purpose::trials);

inline bool finite(const std::vector<Vec3>& centres) {
  return std::ranges::all_of(centres, [](const Vec3& r) {
    return std::isfinite(r.x) && std::isfinite(r.y) && std::isfinite(r.z);
  });
}

/// Makes trials, in one call and again in calls of odd lengths. No overlap of the start may grow,
/// and none may be made: moves compare with the very arithmetic of the brute force.
inline Packing run_trials(const Packing& start, const Move& move, std::uint64_t trials,
                          Sampler sampler = Sampler::exhaustive) {
  Packing end = start, repeated = start;
  const auto loop =
      make_trial_loop(start.container, move, hard_case_key, best_instruction_set(), sampler);
  loop->load(start);
  loop->begin_tap();
  loop->run(trials);
  loop->store(end);

  const auto cut =
      make_trial_loop(start.container, move, hard_case_key, best_instruction_set(), sampler);
  cut->load(start);
  cut->begin_tap();
  for (std::uint64_t done = 0; done < trials;) {
    const std::uint64_t piece = std::min<std::uint64_t>(trials - done, 1 + done / 3);
    cut->run(piece);
    done += piece;
  }
  cut->store(repeated);

  CHECK(finite(end.centres));
  CHECK(deepest_overlap_brute_force(end).depth <=
        std::max(deepest_overlap_brute_force(start).depth, 1e-15));
  CHECK(end.centres == repeated.centres);
  CHECK(loop->state() == cut->state());
  CHECK(loop->tally().trials == trials);
  // A sphere has at most twelve neighbours that touch, and some dozens within a long step.
  CHECK(loop->tally().distance_tests <= 200 * trials);
  return end;
}

/// Runs a plan to its end and looks at the bed after every `every` taps.
inline RecordedRealization run_plan(const Plan& plan, std::uint64_t every = 1) {
  RecordedRealization record;
  Realization realization(plan, 0);
  while (!realization.finished()) {
    Slice slice = realization.advance(1'000'000);
    if (!slice.row) continue;
    if (slice.row->tap % every == 0) {
      const Packing packing{plan.container, realization.state().centres};
      CHECK(finite(packing.centres));
      CHECK(deepest_overlap_brute_force(packing).depth <= overlap_bound(packing));
    }
    record.rows.push_back(std::move(*slice.row));
  }
  record.state = realization.state();
  return record;
}

/// Two runs are equal, bit for bit.
inline RecordedRealization run_plan_twice(const Plan& plan, std::uint64_t every = 1) {
  RecordedRealization record = run_plan(plan, every);
  CHECK(bits(run_plan(plan, every)) == bits(record));
  return record;
}

/// hcp has 6 by 4 sqrt(3), fcc 6 by 6 diameters; no gap between neighbours.
inline Packing close_packed(Lattice lattice, std::uint32_t layers) {
  const bool hcp = lattice == Lattice::hcp;
  RandomStream unused(stream_key(1, 0, 0, Purpose::start));
  return make_start(Crystal{lattice, false}, PeriodicBox{6, hcp ? 6.928203230275509 : 6},
                    layers * (hcp ? 48 : 36), unused);
}

}  // namespace jostle
