#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ensemble/analysis/analyses.hpp"
#include "ensemble/analysis/ordering/log_rank.hpp"
#include "ensemble/analysis/ordering/times.hpp"

// Ordering kinetics as tables. docs/reference/analyses.md, "Ordering".
namespace jostle::inline ensemble {

/// Takes all taps of one realization after another.
class OrderingAnalysis {
 public:
  /// series: taps 0 to the last; settings.hold is at most their number.
  OrderingAnalysis(const AnalysedSeries& series, const OrderingSettings& settings);

  void add(std::uint32_t realization, std::span<const double> values);  // [n_taps]
  /// After at least one realization.
  Table table() const;
  /// By number of the realization, [n_realizations]; absent where it was not added.
  OrderingTimes times(std::size_t n_realizations) const;

 private:
  void add_times(Table& table) const;
  void add_law(Table& table) const;

  AnalysedSeries series_;
  OrderingSettings settings_;
  std::uint64_t last_;  // at which times are censored
  std::vector<std::uint64_t> realizations_;
  std::vector<OrderingTime> times_;
  GrowthOfSeries growth_;
};

/// One point of a sweep as the comparison takes it.
struct OrderingPoint {
  std::string label;  // "lift=0.25"
  OrderingTimes times;
  std::vector<double>
      last_values{};  // means of the last taps, by number of realization, NaN if it failed
  std::optional<Verdict> steady{};  // steadiness of these taps; absent: too few taps
};

/// Quantity of the last taps that is compared: name, units, taps.
struct ComparedValue {
  std::string observable, units, taps;
};

/// Finds the point that orders first, and the point with the largest final value: two or more
/// points.
Table ordering_comparison(const std::string& observable, const OrderingSettings& settings,
                          const ComparedValue& value, const std::vector<OrderingPoint>& points,
                          Streams streams);

}  // namespace jostle::inline ensemble
