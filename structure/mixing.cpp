#include "structure/mixing.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/numbers.hpp"

namespace jostle::inline structure {

namespace {

/// The kind whose mean diameter comes first in the order: each is compared with the best before it.
template <class Order>
std::uint32_t first_kind(const Sizes& sizes, const Order& order) {
  std::vector<double> sums(sizes.kinds().size(), 0), counts(sums);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    sums[sizes.kind(i)] += sizes.diameter(i);
    ++counts[sizes.kind(i)];
  }
  std::uint32_t best = 0;
  bool found = false;
  for (std::uint32_t k = 0; k < sums.size(); ++k) {
    if (counts[k] == 0) continue;
    if (!found || order(sums[k] / counts[k], sums[best] / counts[best])) best = k;
    found = true;
  }
  return best;
}

/// One direction, divided into cells of equal width.
struct EvenCells {
  double low, width;
  std::uint64_t n;

  EvenCells(double begin, double end, double centre)
      : low(begin),
        width(end - begin),
        n(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(width / centre)))) {}

  std::uint64_t cell(double coordinate) const {
    const double place = (coordinate - low) / width * static_cast<double>(n);
    return static_cast<std::uint64_t>(std::clamp(place, 0.0, static_cast<double>(n - 1)));
  }
};

}  // namespace

std::uint32_t kind_named(const Sizes& sizes, std::string_view name) {
  for (std::uint32_t k = 0; k < sizes.kinds().size(); ++k) {
    if (sizes.kinds()[k].name == name) return k;
  }
  throw std::invalid_argument("no kind of spheres is named \"" + std::string(name) + '"');
}

std::uint32_t largest_kind(const Sizes& sizes) {
  return first_kind(sizes, [](double a, double b) { return a > b; });
}

std::uint32_t smallest_kind(const Sizes& sizes) {
  return first_kind(sizes, [](double a, double b) { return a <= b; });
}

double kind_height(const Packing& packing, std::uint32_t kind) {
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    if (packing.sizes->kind(i) != kind) continue;
    const double d = packing.sizes->diameter(i), weight = d * d * d;
    sum += weight * packing.centres[i].z;
    weights += weight;
  }
  return weights > 0 ? sum / weights : not_a_number;
}

double segregation(const Packing& packing, std::uint32_t large, std::uint32_t small) {
  return 2 * (kind_height(packing, large) - kind_height(packing, small)) / bed_height(packing);
}

double lacey_index(const Packing& packing, std::uint32_t kind, double cell) {
  struct Count {
    double all = 0, of_kind = 0;
  };
  const Boundary boundary(packing.container);
  const double top = boundary.periodic_z ? boundary.height : surface_height(packing);
  const EvenCells x(0, boundary.width_x, cell), y(0, boundary.width_y, cell), z(0, top, cell);
  std::map<std::uint64_t, Count> cells;
  Count bed;
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const Vec3& r = packing.centres[i];
    Count& count = cells[(z.cell(r.z) * y.n + y.cell(r.y)) * x.n + x.cell(r.x)];
    const double is_kind = packing.sizes->kind(i) == kind ? 1 : 0;
    for (Count* counts : {&count, &bed}) {
      counts->all += 1;
      counts->of_kind += is_kind;
    }
  }
  const double p = bed.of_kind / bed.all, segregated_variance = p * (1 - p);
  double variance = 0;
  for (const auto& [number, count] : cells) {
    const double deviation = count.of_kind / count.all - p;
    variance += count.all / bed.all * deviation * deviation;
  }
  const double random =
      segregated_variance * (static_cast<double>(cells.size()) - 1) / (bed.all - 1);
  return segregated_variance > random
             ? (segregated_variance - variance) / (segregated_variance - random)
             : not_a_number;
}

}  // namespace jostle::inline structure
