#include "ensemble/fold.hpp"

#include <cassert>
#include <cmath>

#include "engine/numbers.hpp"
#include "ensemble/moments.hpp"

namespace jostle::inline ensemble {

FoldedColumn fold(std::span<const double> column, std::uint32_t realizations) {
  assert(realizations > 0 && column.size() % realizations == 0);
  FoldedColumn folded;
  for (; !column.empty(); column = column.subspan(realizations)) {
    Moments moments;
    for (const double value : column.first(realizations)) moments.add(value);
    folded.mean.push_back(moments.mean());
    folded.sigma.push_back(moments.sigma());
    folded.error.push_back(moments.standard_error());
    folded.count.push_back(static_cast<std::uint32_t>(moments.count()));
  }
  return folded;
}

SeriesBlock::SeriesBlock(std::size_t n_columns, std::uint64_t first_tap, std::uint64_t n_taps,
                         std::uint32_t realizations)
    : first_tap_(first_tap),
      realizations_(realizations),
      columns_(n_columns, std::vector<double>(n_taps * realizations, not_a_number)) {}

void SeriesBlock::set(std::uint32_t realization, const TapRow& row) {
  assert(row.tap >= first_tap_ && row.observables.size() + row.diagnostics.size() == n_columns());
  std::size_t column = 0;
  for (const double value : row.observables) {
    set(column++, row.tap - first_tap_, realization, value);
  }
  for (const double value : row.diagnostics) {
    set(column++, row.tap - first_tap_, realization, value);
  }
}

void SeriesBlock::set(std::uint32_t realization, std::span<const double> rows) {
  for (std::uint64_t tap = 0; !rows.empty(); ++tap) {
    for (std::size_t column = 0; column < n_columns(); ++column) {
      set(column, tap, realization, rows[column]);
    }
    rows = rows.subspan(n_columns());
  }
}

void SeriesBlock::set(std::size_t column, std::uint64_t tap, std::uint32_t realization,
                      double value) {
  columns_[column][tap * realizations_ + realization] = std::isnan(value) ? not_a_number : value;
}

}  // namespace jostle::inline ensemble
