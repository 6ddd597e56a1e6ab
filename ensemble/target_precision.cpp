#include "ensemble/target_precision.hpp"

#include <algorithm>
#include <cmath>

namespace jostle::inline ensemble {

namespace {

/// Realizations that this target asks for, at most twice as many as there are.
double wanted(double realizations, const SpreadFound& found) {
  if (found.met()) return realizations;
  if (std::isnan(found.value)) return 2 * realizations;
  if (found.spread == Spread::sigma) return std::ceil(1.25 * realizations);
  const double excess = found.value / found.at_most;
  return std::min(std::ceil(realizations * excess * excess), 2 * realizations);
}

}  // namespace

std::uint32_t next_realizations(std::uint32_t realizations, std::span<const SpreadFound> found,
                                std::uint32_t at_most) {
  if (std::ranges::all_of(found, [](const SpreadFound& spread) { return spread.met(); })) {
    return realizations;
  }
  double most = static_cast<double>(realizations) + 1;
  for (const SpreadFound& spread : found) {
    most = std::max(most, wanted(static_cast<double>(realizations), spread));
  }
  const double limit = std::max(at_most, realizations);
  return static_cast<std::uint32_t>(std::min(most, limit));
}

}  // namespace jostle::inline ensemble
