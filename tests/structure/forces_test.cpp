#include "structure/forces.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "engine/bed/boundary.hpp"

using namespace jostle;

namespace {

// Three spheres in a corner, with forces on slanted normals.
const Packing corner{WalledBox{4, 4}, {{0.4, 1, 0.5}, {1.1, 1.5, 0.9}, {2, 2, 3}}};
const std::vector<Contact> contacts = {{.first = 0,
                                        .second = 1,
                                        .overlap = 0.02,
                                        .normal_force = 3,
                                        .normal = {-0.6, 0, -0.8},
                                        .tangential_force = {0.8, 1, -0.6}},
                                       {.first = 0,
                                        .second = 3,
                                        .overlap = 0,
                                        .normal_force = 5,
                                        .normal = {0, 0, 1},
                                        .tangential_force = {0.5, -0.25, 0}},
                                       {.first = 0,
                                        .second = 4,
                                        .overlap = 0.1,
                                        .normal_force = 2,
                                        .normal = {1, 0, 0},
                                        .tangential_force = {0, 0, 0.75}},
                                       {.first = 1,
                                        .second = 4,
                                        .overlap = 0.05,
                                        .normal_force = 1,
                                        .normal = {1, 0, 0},
                                        .tangential_force = {0, 0.5, 0.25}}};

}  // namespace

TEST_CASE("the walls press and rub with the sums of their contacts") {
  const BedForces forces = bed_forces(corner, contacts);
  REQUIRE(wall_names(corner.container) ==
          std::vector<std::string>{"floor", "x_min", "x_max", "y_min", "y_max"});
  CHECK(forces.walls ==
        std::vector<WallForce>{{5, {0.5, -0.25, 0}}, {3, {0, 0.5, 1}}, {0, {}}, {0, {}}, {0, {}}});
  CHECK(wall_names(Plates{}) == std::vector<std::string>{"floor", "y_min", "y_max"});
  CHECK(wall_names(Cylinder{}) == std::vector<std::string>{"floor", "tube"});
  CHECK(wall_names(PeriodicBox{}) == std::vector<std::string>{"floor"});
  CHECK(wall_names(FullyPeriodicBox{}).empty());
}

TEST_CASE("the force-moment tensor is the sum of arm times force") {
  const BedForces forces = bed_forces(corner, contacts);
  // Its trace is that of the normal forces: the distance of the centres times each.
  double trace = 0;
  for (const Contact& contact : contacts)
    trace +=
        contact.normal_force * (contact.second < 3 ? 1 - contact.overlap : 0.5 - contact.overlap);
  CHECK(forces.moment[0] + forces.moment[4] + forces.moment[8] == Approx(trace));
  // By hand: x times x, and x times z.
  CHECK(forces.moment[0] == Approx(0.98 * -0.6 * (3 * -0.6 + 0.8) + 0.4 * 2 + 0.45 * 1));
  CHECK(forces.moment[2] == Approx(0.98 * -0.6 * (3 * -0.8 - 0.6) + 0.4 * 0.75 + 0.45 * 0.25));
  CHECK(forces.moment[6] == Approx(0.98 * -0.8 * (3 * -0.6 + 0.8) + 0.5 * 0.5));

  const std::vector<ForceMoment> moments = force_moments(contacts, 3);
  REQUIRE(moments.size() == 3);
  for (std::size_t k = 0; k < 9; ++k)
    CHECK(moments[0][k] + moments[1][k] + moments[2][k] == Approx(forces.moment[k]));
  CHECK(moments[2] == ForceMoment{});
}

// Radii 0.3, 0.9 and 0.5: a contact divides the line of the centres as the radii do.
TEST_CASE("the force-moment tensor of spheres of several sizes has the arms of their radii") {
  Packing mixed = corner;
  mixed.sizes = std::make_shared<const Sizes>(std::vector{0.6, 1.8, 1.0});
  const BedForces forces = bed_forces(mixed, contacts);
  const auto radius = [&](std::uint32_t i) { return i < 3 ? mixed.sizes->radius(i) : 0; };
  double trace = 0;
  for (const Contact& contact : contacts)
    trace +=
        contact.normal_force * (radius(contact.first) + radius(contact.second) - contact.overlap);
  CHECK(forces.moment[0] + forces.moment[4] + forces.moment[8] == Approx(trace));
  const std::vector<ForceMoment> moments = force_moments(contacts, 3, mixed.sizes.get());
  for (std::size_t k = 0; k < 9; ++k)
    CHECK(moments[0][k] + moments[1][k] + moments[2][k] == Approx(forces.moment[k]));
  double of_first = 0;
  for (const Contact& contact : contacts) {
    const double reach = radius(contact.first) + radius(contact.second);
    const double share = (reach - contact.overlap) / reach;
    if (contact.first == 0 || contact.second == 0) of_first += contact.normal_force * share * 0.3;
  }
  CHECK(moments[0][0] + moments[0][4] + moments[0][8] == Approx(of_first));
}

TEST_CASE("granular temperature is the variance of velocities by height") {
  const Packing bed{
      PeriodicBox{4, 4},
      {{1, 1, 0.51}, {2, 1, 0.52}, {3, 1, 0.55}, {1, 2, 1.42}, {1, 2, 1.48}, {1, 2, 2.3}}};
  std::vector<Vec3> velocities = {{1, 0, 2}, {-1, 0, 2}, {0, 3, 5},
                                  {7, 7, 7}, {7, 7, 9},  {1, 2, 3}};
  const GranularTemperature found = granular_temperature(bed, velocities, 0.1);
  REQUIRE(found.lateral.size() == 15);  // up to the last bin with two
  for (std::size_t k = 0; k < 15; ++k) {
    CAPTURE(k);
    CHECK(std::isnan(found.lateral[k]) == (k != 5 && k != 14));
    CHECK(std::isnan(found.vertical[k]) == (k != 5 && k != 14));
  }
  CHECK(found.lateral[5] == Approx(0.5 * (1 + 3)));  // variances 1 along x, 3 along y
  CHECK(found.vertical[5] == Approx(3));
  CHECK(found.lateral[14] == 0);
  CHECK(found.vertical[14] == Approx(2));
  // Against a bed that moves as a whole.
  for (Vec3& velocity : velocities) velocity = velocity + Vec3{10, -20, 30};
  const GranularTemperature moved = granular_temperature(bed, velocities, 0.1);
  CHECK(moved.lateral[5] == Approx(found.lateral[5]));
  CHECK(moved.vertical[14] == Approx(found.vertical[14]));
}
