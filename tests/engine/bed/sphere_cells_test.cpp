#include "engine/bed/cells/sphere_cells.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/bed/geometry.hpp"
#include "engine/bed/random.hpp"

namespace jostle {
namespace {

// All images of all spheres within 1 of p, over a generous range of periods.
std::size_t by_all_images(const Container& container, const std::vector<Vec3>& centres, Vec3 p) {
  const auto* bulk = std::get_if<FullyPeriodicBox>(&container);
  const bool sides = bulk != nullptr || std::holds_alternative<PeriodicBox>(container);
  const int most_y = sides ? 2 : 0, most_x = std::holds_alternative<Plates>(container) ? 2 : most_y;
  std::size_t count = 0;
  for (const Vec3& r : centres) {
    for (int i = -most_x; i <= most_x; ++i) {
      for (int j = -most_y; j <= most_y; ++j) {
        for (int k = bulk != nullptr ? -2 : 0; k <= (bulk != nullptr ? 2 : 0); ++k) {
          const Vec3 image = {r.x + i * width_x(container), r.y + j * width_y(container),
                              r.z + (bulk != nullptr ? k * bulk->height : 0)};
          if (norm_squared(image - p) < 1) ++count;
        }
      }
    }
  }
  return count;
}

}  // namespace

TEST_CASE("Cells meet every image of every sphere near a point, also after moves") {
  RandomStream random(stream_key(7, 0, 0, Purpose::start));
  for (const Container& container :
       {Container{PeriodicBox{2.01, 3}}, Container{PeriodicBox{6.5, 9}},
        Container{WalledBox{1, 4.4}}, Container{Cylinder{5}},
        Container{FullyPeriodicBox{2.01, 4, 2.5}}, Container{Plates{2.01, 1.3}}}) {
    const auto* bulk = std::get_if<FullyPeriodicBox>(&container);
    const double height = bulk != nullptr ? bulk->height : 7;
    const auto draw = [&] {
      const double x = width_x(container) * random.uniform();
      const double y = width_y(container) * random.uniform();
      return Vec3{x, y, height * random.uniform()};
    };
    SphereCells cells(container, 200, height);
    for (int i = 0; i < 200; ++i) cells.insert(draw());
    for (int i = 0; i < 300; ++i) {
      cells.move(static_cast<std::uint32_t>(random.integer_below(200)), draw());
      const Vec3 p = draw();
      std::size_t count = 0;
      cells.any_near(p, 1, [&](std::uint32_t, Vec3 image) {
        if (norm_squared(image - p) < 1) ++count;
        return false;
      });
      CHECK(count == by_all_images(container, cells.centres(), p));
    }
  }
}

TEST_CASE("Cells of a vast and nearly empty container stay few") {
  SphereCells cells(PeriodicBox{1e7, 1e7}, 2, 1e5);
  cells.insert({1, 1, 0.5});
  cells.insert({9'999'999.5, 1, 99'999});
  bool met = false;
  cells.any_near({-0.5, 1, 99'999}, 1, [&](std::uint32_t sphere, Vec3 image) {
    met = met || (sphere == 1 && std::abs(image.x + 0.5) < 1e-6);
    return false;
  });
  CHECK(met);
}

}  // namespace jostle
