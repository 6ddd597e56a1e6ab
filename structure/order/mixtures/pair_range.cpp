// The range of partial g(r): what is asked of a scene before anything is measured.
#include <algorithm>
#include <cmath>
#include <string>

#include "engine/bed/boundary.hpp"
#include "structure/order/mixtures/partial_correlation.hpp"
#include "structure/order/whole_shells.hpp"

namespace jostle::inline structure {

std::optional<std::string> partial_pairs_fault(const Container& container, double largest,
                                               std::size_t n_kinds, std::optional<double> r_max) {
  const Boundary boundary(container);
  if (n_kinds > most_kinds_of_pairs)
    return "partial g(r): there are " + std::to_string(n_kinds) +
           " kinds of spheres; pairs of at most " + std::to_string(most_kinds_of_pairs) +
           " kinds are counted";
  const double half = 0.5 * narrowest_period(boundary);
  if (r_max && *r_max * largest > half * (1 + 1e-9))
    return "partial g(r): " + std::to_string(*r_max) + " sums of radii are " +
           std::to_string(*r_max * largest) +
           " d for the largest spheres; r_max must not exceed half a period, " +
           std::to_string(half) + " d";
  return std::nullopt;
}

double widest_partial_pairs(const Packing& packing) {
  constexpr double usual = 4, tenth = 0.1;
  const double half = 0.5 * narrowest_period(Boundary(packing.container));
  const double widest = half / (2 * packing.largest_radius());
  return std::min(std::floor(widest / tenth + 1e-9) * tenth, usual);
}

}  // namespace jostle::inline structure
