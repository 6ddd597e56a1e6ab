#include "engine/bed/boundary.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "engine/bed/random.hpp"

using namespace jostle;

namespace {

std::vector<Container> containers() {
  return {PeriodicBox{4, 5.1}, WalledBox{4, 3.3}, Cylinder{4.7}, FullyPeriodicBox{4, 5.1, 6.3},
          Plates{4, 3.3}};
}

}  // namespace

TEST_CASE("A boundary knows the ends of each container") {
  const Boundary periodic(PeriodicBox{4, 5});
  CHECK(periodic.periodic_sides());
  CHECK(periodic.has_floor());
  CHECK_FALSE(periodic.has_walls());
  CHECK(periodic.periods() == Vec3{4, 5, 0});
  CHECK(std::isinf(periodic.height));
  CHECK(periodic.margin_x() == 0);

  const Boundary walled(WalledBox{4, 5});
  CHECK(walled.planes_x());
  CHECK(walled.planes_y());
  CHECK(walled.has_floor());
  CHECK(walled.periods() == Vec3{});
  CHECK(walled.width_y == 5);
  CHECK(walled.margin_x() == sphere_radius);
  CHECK(walled.margin_y() == sphere_radius);

  const Boundary tube(Cylinder{7});
  CHECK(tube.tube);
  CHECK_FALSE(tube.planes_x());
  CHECK(tube.has_walls());
  CHECK(tube.has_floor());
  CHECK(tube.periods() == Vec3{});
  CHECK(tube.axis() == 3.5);
  CHECK(tube.width_y == 7);

  CHECK(has_one_width(Cylinder{7}));
  CHECK_FALSE(has_one_width(WalledBox{7, 7}));
  CHECK_FALSE(has_one_width(PeriodicBox{7, 7}));
  CHECK_FALSE(has_one_width(FullyPeriodicBox{7, 7, 7}));

  const Boundary plates(Plates{5, 4});
  CHECK(plates.periodic_x);
  CHECK(plates.planes_y());
  CHECK_FALSE(plates.periodic_sides());
  CHECK(plates.has_walls());
  CHECK(plates.has_floor());
  CHECK(plates.periods() == Vec3{5, 0, 0});
  CHECK(plates.margin_x() == 0);
  CHECK(plates.margin_y() == sphere_radius);
  std::vector<std::string> faces;
  for (const Face& face : Faces(plates)) faces.emplace_back(face.name);
  CHECK(faces == std::vector<std::string>{"floor", "y_min", "y_max"});
  CHECK(footprint_area(plates, 1) == 10);
  CHECK(in_footprint(plates, {0.1, 1, 3}, 1));
  CHECK_FALSE(in_footprint(plates, {2, 0.9, 3}, 1));

  const Boundary bulk(FullyPeriodicBox{4, 5, 6});
  CHECK_FALSE(bulk.has_floor());
  CHECK_FALSE(bulk.has_walls());
  CHECK(bulk.periods() == Vec3{4, 5, 6});
  CHECK(bulk.height == 6);
}

TEST_CASE("A boundary wraps, compares and clears as the container's own functions, bit for bit") {
  RandomStream random(stream_key(81, 0, 0, Purpose::start));
  for (const Container& container : containers()) {
    CAPTURE(container.index());
    const Boundary boundary(container);
    int clear = 0, blocked = 0;
    std::visit(
        [&](const auto& box) {
          for (int draw = 0; draw < 20'000; ++draw) {
            const auto point = [&] {
              const auto coordinate_in = [&](double width) {
                return width * (3 * random.uniform() - 1);
              };
              const double x = coordinate_in(boundary.width_x), y = coordinate_in(boundary.width_y);
              return Vec3{x, y, coordinate_in(6.3)};
            };
            const Vec3 r = wrapped(box, point()), neighbour = wrapped(box, point());
            REQUIRE(wrapped(boundary, r) == r);
            const Vec3 moved = r + Vec3{0.3, -0.3, 0.2};
            REQUIRE(wrapped(boundary, moved) == wrapped(box, moved));
            REQUIRE(separation(boundary, r, neighbour) == separation(box, r, neighbour));
            REQUIRE(clear_of_boundaries(boundary, r) == clear_of_boundaries(box, r));
            if (boundary.periodic_z) {
              REQUIRE(boundary_depth(boundary, r) == 0);
            } else {
              // Within rounding of touching both answers are valid.
              const double depth = boundary_depth(boundary, r);
              if (std::abs(depth) > 1e-12) REQUIRE((depth > 0) != clear_of_boundaries(box, r));
            }
            ++(clear_of_boundaries(boundary, r) ? clear : blocked);
          }
        },
        container);
    CHECK(clear > 100);
    if (boundary.has_floor()) CHECK(blocked > 100);
  }
}

TEST_CASE("The nearest face of a container is as deep as its boundary, and normals point inwards") {
  RandomStream random(stream_key(82, 0, 0, Purpose::start));
  for (const Container& container : containers()) {
    CAPTURE(container.index());
    const Boundary boundary(container);
    const Faces faces(boundary);
    for (int draw = 0; draw < 2000 && faces.size() > 0; ++draw) {
      const auto coordinate_in = [&](double width) {
        return width * (1.2 * random.uniform() - 0.1);
      };
      const double x = coordinate_in(boundary.width_x), y = coordinate_in(boundary.width_y),
                   z = coordinate_in(5);
      const Vec3 r{x, y, z};
      double least = 100;
      for (const Face& face : faces) {
        CAPTURE(face.name, r.x, r.y, r.z);
        const auto [distance, normal] = face.nearest(r);
        least = std::min(least, distance);
        REQUIRE(norm_squared(normal) == Approx(1));
        // A step along the normal leads away from the face by its length; so does a velocity.
        REQUIRE(face.distance(r + 1e-3 * normal) - distance == Approx(1e-3).epsilon(1e-9));
        REQUIRE(face.recession(r, 2.0 * normal) == Approx(2));
        REQUIRE(face.distance(r - distance * normal) == Approx(0).margin(1e-12));
      }
      REQUIRE(sphere_radius - least == Approx(boundary_depth(boundary, r)).margin(1e-12));
    }
  }
}
