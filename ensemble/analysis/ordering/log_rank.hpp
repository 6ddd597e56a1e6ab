#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "ensemble/analysis/ordering/times.hpp"
#include "ensemble/plan.hpp"

// Finds the ensemble that orders first.
namespace jostle::inline ensemble {

/// For each time among all of them, [n]: 1 if it ordered, 0 if not, less Nelson & Aalen's
/// cumulative hazard up to and with its tap. The scores of a group add up to its events observed
/// less those expected, the log-rank statistic (Mantel 1966; Peto & Peto 1972,
/// doi:10.2307/2344317). Early times score high.
std::vector<double> log_rank_scores(std::span<const OrderingTime> times);

/// The times of one ensemble by realization, absent where one failed, and the tap at which they are
/// censored.
struct OrderingTimes {
  std::vector<std::optional<OrderingTime>> of_realization;
  std::uint64_t last = 0;
  /// Those that are there.
  std::vector<OrderingTime> known() const;
};

/// Probability that chance alone makes `first` so much earlier than `second`, if both have one law:
/// one-sided, by permuting which times are whose, so it is right for any number of realizations and
/// any law. Independent streams: all ways to share the times out. Matched streams: the two times of
/// a realization change places or not. All ways where they are at most `most_ways`, else so many
/// less one drawn at random, always the same. Times beyond the earlier end count as censored there.
struct EarlierTest {
  double p = 1;
  double least = 1;  // smallest p that so many realizations could give
};
EarlierTest earlier(const OrderingTimes& first, const OrderingTimes& second, Streams streams);
inline constexpr std::size_t most_ways = 10'000;

/// Finds which of k candidates may be the best. Candidate j is excluded where another beats it at
/// `level` over k - 1 (multiple comparisons with the best, Hsu 1996; Bonferroni): the true best is
/// among the remaining ones with probability at least 1 - `level`.
struct Candidates {
  std::vector<double> p;      // p-value against the most likely winner, times k - 1, at most 1; [k]
  std::vector<bool> may_be;   // [k]
  bool could_decide = false;  // realizations are enough for any pair to differ at the level
  static constexpr double level = significance_level / 2;  // level of two such questions
};
/// The earliest; k >= 2.
Candidates may_order_first(std::span<const OrderingTimes> all, Streams streams);
/// The largest mean; values: [k][realizations], NaN where one failed. Welch's tests, or with
/// matched streams Student's of the differences, one-sided. Never excluded: those `open`.
Candidates may_be_largest(std::span<const std::vector<double>> values, Streams streams,
                          const std::vector<bool>& open);

/// The place of the highest mean score among all; ties: the first.
std::size_t orders_first(std::span<const OrderingTimes> all);

}  // namespace jostle::inline ensemble
