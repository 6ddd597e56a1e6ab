#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ensemble/analysis/structure_tables.hpp"
#include "ensemble/analysis/table.hpp"
#include "ensemble/plan.hpp"

// Differences in structure between the points of a sweep.
namespace jostle::inline ensemble {

/// One number that a part measures in every packing, as the mean coordination number.
struct PackingNumber {
  std::string part, name, units, long_name;
  std::vector<std::vector<double>> values;  // [n_taps][n_realizations]; NaN where there is none
};

/// The numbers of the packings of a sweep point.
struct ComparedPoint {
  std::string label;
  std::uint32_t point = 0;          // its number
  std::vector<std::uint64_t> taps;  // [n_taps], ascending
  std::vector<PackingNumber> numbers;
};

/// The numbers that have one value per packing and an error of their mean. Curves and fitted laws
/// have none.
ComparedPoint packing_numbers(std::string label, std::uint32_t point,
                              const EnsembleStructure& structure);

/// Up to this number of points every pair is compared; of more points each with the first.
inline constexpr std::size_t most_compared_pairwise = 6;

/// A table comparison/<part> for each part with a number that two points have: differences of the
/// means at the last tap of which all points keep packings. With matched streams they are paired
/// by realization, with Student's t of M - 1 degrees of freedom; else Welch's test applies. The
/// p-values of a number are corrected for its pairs by Holm's rule. A difference without scatter
/// has neither error nor p-value. No table where there are fewer than two points, or no common tap.
std::vector<Table> comparison_tables(std::span<const ComparedPoint> points, Streams streams);

}  // namespace jostle::inline ensemble
