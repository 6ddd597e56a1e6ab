#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ensemble/sink.hpp"

// The fold over the realizations of a sweep point, for results files and for sinks of one's own.
namespace jostle::inline ensemble {

/// Statistics of an ensemble in one column, [n_taps] each. Moments defines the NaN values.
struct FoldedColumn {
  std::vector<double> mean, sigma, error;  // sigma with 1/M; error: of the mean
  std::vector<std::uint32_t> count;        // realizations that have a value
};

/// Folds a column, [n_taps, n_realizations], in the order of realizations; NaN is no value.
FoldedColumn fold(std::span<const double> column, std::uint32_t realizations);

/// Taps first_tap .. first_tap + n_taps - 1 of all realizations of a sweep point, column by column:
/// NaN, always the same one, until they are set. Different realizations may be set concurrently.
class SeriesBlock {
 public:
  SeriesBlock(std::size_t n_columns, std::uint64_t first_tap, std::uint64_t n_taps,
              std::uint32_t realizations);

  std::uint64_t first_tap() const { return first_tap_; }
  std::size_t n_columns() const { return columns_.size(); }

  /// A row as a sink is given it: its observables, then its diagnostics. Its tap is in the block.
  void set(std::uint32_t realization, const TapRow& row);
  /// Rows [n, n_columns] of a realization from first_tap on, n at most n_taps.
  void set(std::uint32_t realization, std::span<const double> rows);

  /// [n_taps, n_realizations].
  const std::vector<double>& column(std::size_t number) const { return columns_[number]; }
  FoldedColumn folded(std::size_t number) const { return fold(columns_[number], realizations_); }

 private:
  void set(std::size_t column, std::uint64_t tap, std::uint32_t realization, double value);

  std::uint64_t first_tap_;
  std::uint32_t realizations_;
  std::vector<std::vector<double>> columns_;  // [n_columns] of [n_taps, n_realizations]
};

}  // namespace jostle::inline ensemble
