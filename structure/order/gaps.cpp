#include "structure/order/gaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/bed/boundary.hpp"

namespace jostle::inline structure {

namespace {

unsigned boundary_contacts(const Boundary& boundary, Vec3 r, double radius, double tolerance) {
  const double reach = radius + 2 * radius * tolerance;
  unsigned contacts = 0;
  for (const Face& face : Faces(boundary)) contacts += face.distance(r) <= reach ? 1 : 0;
  return contacts;
}

/// Mean of x over [0, 1] with a density as exp(a x), less 1/2; odd in a.
double tilted_mean(double a) {
  if (std::abs(a) < 1e-3) return a / 12;
  return 0.5 / std::tanh(0.5 * a) - 1 / a;
}

/// ln of the integral of exp(a x) over [0, 1].
double ln_tilted_sum(double a) {
  if (std::abs(a) < 1e-6) return 0.5 * a;
  return std::max(a, 0.0) + std::log(-std::expm1(-std::abs(a)) / std::abs(a));
}

/// Mean of x = ln(h / low) / range, less 1/2, of gaps with a density in x as exp(a x) (1 + h)^2.
double mean_in_shells(double a, double low, double range) {
  // (1 + h)^2 = 1 + 2 h + h^2, and h^k is low^k exp(k range x).
  const double ln_factors[] = {0, std::log(2 * low), 2 * std::log(low)};
  double terms[3], largest = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    terms[k] = ln_factors[k] + ln_tilted_sum(a + k * range);
    largest = std::max(largest, terms[k]);
  }
  double sum = 0, weights = 0;
  for (int k = 0; k < 3; ++k) {
    const double weight = std::exp(terms[k] - largest);
    weights += weight;
    sum += weight * tilted_mean(a + k * range);
  }
  return sum / weights;
}

}  // namespace

unsigned least_contacts_of(const Container& container) {
  return has_gravity(container) ? 3 : 4;
}

Backbone backbone(const Packing& packing, const NeighbourTable& near, double tolerance,
                  unsigned least) {
  const Boundary boundary(packing.container);
  const double reach = (1 + tolerance) * (1 + tolerance);
  Backbone found;
  found.rattler.assign(near.size(), false);
  std::vector<std::size_t> loose;
  for (std::size_t i = 0; i < near.size(); ++i) {
    unsigned contacts =
        boundary_contacts(boundary, packing.centres[i], packing.radius(i), tolerance);
    for (const Neighbour& neighbour : near.neighbours_of(i)) {
      contacts += neighbour.distance_squared <= reach ? 1 : 0;
    }
    found.contacts.push_back(contacts);
    if (contacts < least) loose.push_back(i);
  }
  for (const std::size_t i : loose) found.rattler[i] = true;
  while (!loose.empty()) {
    const std::size_t i = loose.back();
    loose.pop_back();
    for (const Neighbour& neighbour : near.neighbours_of(i)) {
      if (neighbour.distance_squared > reach) continue;
      const std::size_t j = neighbour.sphere;
      --found.contacts[j];
      if (found.rattler[j] || found.contacts[j] >= least) continue;
      found.rattler[j] = true;
      loose.push_back(j);
    }
  }
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (found.rattler[i]) found.contacts[i] = 0;
  }
  return found;
}

double gap_exponent(std::span<const double> gaps, double low, double high,
                    std::span<const double> weights) {
  constexpr std::size_t fewest = 10;
  const double range = std::log(high / low);
  double sum = 0, all = 0, least = high, most = low;
  std::size_t n = 0;
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    if (gaps[k] < low || gaps[k] > high) continue;
    const double weight = weights.empty() ? 1 : weights[k];
    sum += weight * std::log(gaps[k] / low) / range;
    all += weight;
    least = std::min(least, gaps[k]);
    most = std::max(most, gaps[k]);
    ++n;
  }
  constexpr double one_size = 1e-6;  // equal, as in a crystal: these have no law
  if (n < fewest || most - least < one_size) return std::numeric_limits<double>::quiet_NaN();
  const double mean = sum / all - 0.5;
  // For ln h the density is as h^(1 - gamma) (1 + h)^2.
  constexpr double steepest = 1e4;
  double lower = -steepest, upper = steepest;
  for (int turn = 0; turn < 100; ++turn) {
    const double middle = 0.5 * (lower + upper);
    (mean_in_shells(middle, low, range) < mean ? lower : upper) = middle;
  }
  return 1 - 0.5 * (lower + upper) / range;
}

}  // namespace jostle::inline structure
