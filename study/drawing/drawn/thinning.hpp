#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ensemble/analysis/table.hpp"

// Selects the part of long series, tables and sweeps for a page, so that it opens at once.
namespace jostle::inline study {

/// Indices out of 0 .. n - 1, ascending: all where there are at most `most` (>= 1), else so many,
/// evenly spread, the first and the last among them.
std::vector<std::size_t> evenly_spread(std::size_t n, std::size_t most);

/// The values at evenly_spread() places.
template <class Value>
std::vector<Value> spread(const std::vector<Value>& values, std::size_t most) {
  std::vector<Value> chosen;
  for (const std::size_t i : evenly_spread(values.size(), most)) chosen.push_back(values[i]);
  return chosen;
}

/// Indices out of 0 .. n - 1, ascending: 0, the last, so many per decade in equal steps of the
/// logarithm, and `evenly` in equal steps, so that neither an early nor a late change is lost.
std::vector<std::size_t> logarithmically_spread(std::size_t n, std::size_t per_decade,
                                                std::size_t evenly);

/// Indices of the least and the greatest value, in this order; none where no value is finite.
std::vector<std::size_t> extremes_of(std::span<const double> values);

/// All of both, ascending, each once.
std::vector<std::size_t> joined(std::vector<std::size_t> first,
                                const std::vector<std::size_t>& second);

/// How much of a table's axes is kept.
struct TableThinning {
  std::size_t most_taps = 24;     // most taps of the axis `tap`: evenly spread
  std::size_t most_places = 400;  // most places of any other axis except `t`
  std::size_t per_decade = 24;    // places per decade of `t`, the taps of a fitted curve
  std::size_t whole = 0;          // longest `t` that is not thinned
};

/// The table with its axes thinned, all quantities along them likewise. The places where a quantity
/// is least and greatest stay, at every tap that is kept: no peak is lost. A quantity that does not
/// have as many values as its axes give is left out. The note `drawn` gives how many places of a
/// thinned `t` are kept.
Table thinned(const Table& table, const TableThinning& thinning);

/// Numbers and texts of a table, axes included.
std::size_t n_values(const Table& table);

}  // namespace jostle::inline study
