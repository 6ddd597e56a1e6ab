#include "structure/snapshot_statistics.hpp"

#include <cassert>
#include <cmath>

#include "engine/cell_grid.hpp"
#include "engine/geometry.hpp"

namespace jostle {

namespace {

// Steps from one image of a sphere to the next; 0 where the direction is not periodic.
Vec3 periods(const Container& container) {
  if (const auto* box = std::get_if<PeriodicBox>(&container)) {
    return {box->width_x, box->width_y, 0};
  }
  if (const auto* box = std::get_if<FullyPeriodicBox>(&container)) {
    return {box->width_x, box->width_y, box->height};
  }
  return {};
}

// How many images to either side of the nearest one may lie within the cut: none, unless the box is
// narrower than twice the cut.
int further_images(double period, double cut) {
  return period > 0 ? static_cast<int>(cut / period + 0.5) : 0;
}

// Counts the images of a sphere within the cut, given the way to its nearest image.
class ImagesWithin {
 public:
  ImagesWithin(const Container& container, double cut)
      : period_(periods(container)),
        images_{further_images(period_.x, cut), further_images(period_.y, cut),
                further_images(period_.z, cut)},
        cut_squared_(cut * cut) {}

  unsigned operator()(Vec3 nearest) const {
    unsigned count = 0;
    for (int i = -images_[0]; i <= images_[0]; ++i) {
      for (int j = -images_[1]; j <= images_[1]; ++j) {
        for (int k = -images_[2]; k <= images_[2]; ++k) {
          const Vec3 image = nearest + Vec3{i * period_.x, j * period_.y, k * period_.z};
          count += norm_squared(image) <= cut_squared_;
        }
      }
    }
    return count;
  }

 private:
  Vec3 period_;
  int images_[3];
  double cut_squared_;
};

}  // namespace

std::vector<unsigned> coordination_numbers(const Packing& packing, double cut) {
  assert(cut > 0);
  const std::vector<Vec3>& centres = packing.centres;
  const auto n = static_cast<std::uint32_t>(centres.size());
  std::vector<unsigned> numbers(n, 0);
  CellGrid grid;
  // A little wider than the cut, so that rounding in the grid loses no centre just at it.
  grid.build(packing.container, 1.0001 * cut, n, [&](std::uint32_t i) { return centres[i]; });
  const ImagesWithin images_within(packing.container, cut);
  const auto count_neighbours = [&](const auto& box) {
    for (std::uint32_t i = 0; i < n; ++i) {
      grid.for_each_near(centres[i], [&](std::uint32_t j) {
        numbers[i] += images_within(separation(box, centres[i], centres[j]));
      });
      --numbers[i];  // itself
    }
  };
  std::visit(count_neighbours, packing.container);
  return numbers;
}

double coordination(const Packing& packing, double cut) {
  assert(!packing.centres.empty());
  std::uint64_t neighbours = 0;
  for (const unsigned number : coordination_numbers(packing, cut)) neighbours += number;
  return static_cast<double>(neighbours) / static_cast<double>(packing.centres.size());
}

std::vector<double> height_histogram(const Packing& packing, double bin_width) {
  assert(bin_width > 0 && !packing.centres.empty());
  const auto bin = [&](double z) { return static_cast<std::size_t>(z / bin_width); };
  std::vector<std::uint64_t> counts(bin(top_height(packing)) + 1, 0);
  for (const Vec3& centre : packing.centres) ++counts[bin(centre.z)];
  std::vector<double> fractions;
  fractions.reserve(counts.size());
  for (const std::uint64_t count : counts) {
    fractions.push_back(static_cast<double>(count) / static_cast<double>(packing.centres.size()));
  }
  return fractions;
}

}  // namespace jostle
