#include "ensemble/analysis/ageing/tap_rows.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace jostle::inline ensemble {

std::span<const double> TapRows::row(std::uint64_t tap) const {
  const auto found = std::ranges::lower_bound(taps, tap);
  if (found == taps.end() || *found != tap) return {};
  const auto index = static_cast<std::size_t>(found - taps.begin());
  return std::span(values).subspan(index * realizations, realizations);
}

TapRows choose_taps(std::span<const double> series, std::uint32_t realizations,
                    std::span<const std::uint64_t> taps) {
  assert(realizations > 0 && series.size() % realizations == 0);
  assert(std::ranges::is_sorted(taps, std::ranges::less_equal{}));
  TapRows rows{.taps = {}, .realizations = realizations, .values = {}};
  const std::uint64_t n_taps = series.size() / realizations;
  for (const std::uint64_t tap : taps) {
    if (tap >= n_taps) break;
    const std::span<const double> row = series.subspan(tap * realizations, realizations);
    rows.taps.push_back(tap);
    rows.values.insert(rows.values.end(), row.begin(), row.end());
  }
  return rows;
}

std::vector<std::uint64_t> logarithmic_taps(std::uint64_t first, std::uint64_t last,
                                            double per_decade) {
  assert(1 <= first && first <= last && per_decade > 0);
  const double decades = std::log10(static_cast<double>(last) / static_cast<double>(first));
  const auto steps = static_cast<std::uint64_t>(std::ceil(decades * per_decade));
  std::vector<std::uint64_t> taps = {first};
  for (std::uint64_t i = 1; i < steps; ++i) {
    const double factor =
        std::pow(10, decades * static_cast<double>(i) / static_cast<double>(steps));
    const auto tap = static_cast<std::uint64_t>(std::llround(static_cast<double>(first) * factor));
    if (tap > taps.back() && tap < last) taps.push_back(tap);
  }
  if (last > first) taps.push_back(last);
  return taps;
}

}  // namespace jostle::inline ensemble
