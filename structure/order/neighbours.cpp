#include "structure/order/neighbours.hpp"

#include <cassert>
#include <limits>
#include <numeric>

namespace jostle {
namespace {

constexpr double first_nearest_cut = 1.5;

bool nearer(const Neighbour& a, const Neighbour& b) {
  if (a.distance_squared != b.distance_squared) return a.distance_squared < b.distance_squared;
  return a.sphere < b.sphere;
}

// Periods in x, y and z; 0 where the container is not periodic.
Vec3 periods(const Container& container) {
  if (const auto* box = std::get_if<PeriodicBox>(&container)) {
    return {box->width_x, box->width_y, 0};
  }
  if (const auto* box = std::get_if<FullyPeriodicBox>(&container)) {
    return {box->width_x, box->width_y, box->height};
  }
  return {};
}

// Beyond it no further centre is found; infinite where there are images.
double farthest_reach(const Packing& packing) {
  if (!(periods(packing.container) == Vec3{})) return std::numeric_limits<double>::infinity();
  const double x = width_x(packing.container), y = width_y(packing.container);
  return x + y + top_height(packing);
}

}  // namespace

NeighbourFinder::Axis NeighbourFinder::make_axis(double origin, double length, double period,
                                                 double least_side) {
  Axis axis{.origin = origin, .period = period};
  axis.count = static_cast<int>(std::clamp(std::floor(length / least_side), 1.0, 1e6));
  axis.side = length / axis.count;
  axis.per_length = axis.count / length;
  return axis;
}

NeighbourFinder::NeighbourFinder(const Packing& packing, double cut)
    : cut_squared_(cut * cut), reach_(cut * (1 + 1e-9) + 1e-9) {
  assert(cut > 0);
  const std::vector<Vec3>& centres = packing.centres;
  const auto n = static_cast<std::uint32_t>(centres.size());
  const Vec3 period = periods(packing.container);
  double low = 0, height = period.z;
  if (period.z == 0 && n > 0) {
    const auto [lowest, highest] = std::minmax_element(
        centres.begin(), centres.end(), [](const Vec3& a, const Vec3& b) { return a.z < b.z; });
    low = lowest->z;
    height = highest->z - low;
  }
  height = std::max(height, 1e-3);
  // Small cells leave out most of what lies beyond the cut, if each still holds about a sphere.
  double side = std::max(0.8, cut / 3);
  do {
    x_ = make_axis(0, width_x(packing.container), period.x, side);
    y_ = make_axis(0, width_y(packing.container), period.y, side);
    z_ = make_axis(low, height, period.z, side);
    side *= 1.5;
  } while (1.0 * x_.count * y_.count * z_.count > 1000 + 8.0 * n);

  const auto own_cell = [](const Axis& axis, double x) {
    return static_cast<std::size_t>(std::clamp(axis.cell(x), 0L, axis.count - 1L));
  };
  std::vector<std::size_t> cell_of(n);
  starts_.assign(static_cast<std::size_t>(x_.count) * y_.count * z_.count + 1, 0);
  for (std::uint32_t i = 0; i < n; ++i) {
    const Vec3 r = centres[i];
    cell_of[i] = (own_cell(z_, r.z) * y_.count + own_cell(y_, r.y)) * x_.count + own_cell(x_, r.x);
    ++starts_[cell_of[i] + 1];
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  centres_.resize(n);
  spheres_.resize(n);
  place_of_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t place = next[cell_of[i]]++;
    centres_[place] = centres[i];
    spheres_[place] = i;
    place_of_[i] = place;
  }
}

NeighbourTable neighbours_within(const Packing& packing, double cut) {
  const NeighbourFinder finder(packing, cut);
  NeighbourTable table;
  table.first.reserve(packing.centres.size() + 1);
  table.first.push_back(0);
  for (std::uint32_t i = 0; i < finder.size(); ++i) {
    finder.around(i, [&](std::uint32_t j, Vec3 way, double distance_squared) {
      table.neighbours.push_back({j, way, distance_squared});
    });
    std::sort(table.neighbours.begin() + table.first.back(), table.neighbours.end(), nearer);
    table.first.push_back(static_cast<std::uint32_t>(table.neighbours.size()));
  }
  return table;
}

NeighbourTable nearest_neighbours(const Packing& packing, std::uint32_t count) {
  const auto n = static_cast<std::uint32_t>(packing.centres.size());
  std::vector<Neighbour> found(static_cast<std::size_t>(n) * count);
  std::vector<std::uint32_t> lengths(n, 0), waiting(n);
  std::iota(waiting.begin(), waiting.end(), 0U);
  const double farthest = farthest_reach(packing);
  std::vector<Neighbour> near;
  for (double cut = first_nearest_cut; !waiting.empty() && count > 0; cut *= 1.4) {
    const NeighbourFinder finder(packing, cut);
    std::vector<std::uint32_t> short_of;
    for (const std::uint32_t i : waiting) {
      near.clear();
      finder.around(i, [&](std::uint32_t j, Vec3 way, double distance_squared) {
        near.push_back({j, way, distance_squared});
      });
      if (near.size() < count && cut < farthest) {
        short_of.push_back(i);
        continue;
      }
      lengths[i] = std::min(count, static_cast<std::uint32_t>(near.size()));
      std::partial_sort(near.begin(), near.begin() + lengths[i], near.end(), nearer);
      std::copy_n(near.begin(), lengths[i], found.begin() + static_cast<std::ptrdiff_t>(i) * count);
    }
    waiting.swap(short_of);
  }
  NeighbourTable table;
  table.first = {0};
  for (std::uint32_t i = 0; i < n; ++i) {
    const auto row = found.begin() + static_cast<std::ptrdiff_t>(i) * count;
    table.neighbours.insert(table.neighbours.end(), row, row + lengths[i]);
    table.first.push_back(static_cast<std::uint32_t>(table.neighbours.size()));
  }
  return table;
}

}  // namespace jostle
