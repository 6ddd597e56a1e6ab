#include "structure/order/neighbours.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/structure/random_points.hpp"

using namespace jostle;

namespace {

// The ways from sphere i to all centres and images within the cut, spelt out.
std::vector<Neighbour> by_brute_force(const Packing& packing, std::uint32_t i, double cut) {
  const auto* full = std::get_if<FullyPeriodicBox>(&packing.container);
  const int along_y =
      full != nullptr || std::holds_alternative<PeriodicBox>(packing.container) ? 3 : 0;
  const int along_x = std::holds_alternative<Plates>(packing.container) ? 3 : along_y;
  const int vertical = full != nullptr ? 3 : 0;
  const double a = width_x(packing.container), b = width_y(packing.container);
  const double c = full != nullptr ? full->height : 0;
  std::vector<Neighbour> found;
  for (std::uint32_t j = 0; j < packing.centres.size(); ++j) {
    for (int u = -along_x; u <= along_x; ++u) {
      for (int v = -along_y; v <= along_y; ++v) {
        for (int w = -vertical; w <= vertical; ++w) {
          if (i == j && u == 0 && v == 0 && w == 0) continue;
          const Vec3 way = packing.centres[j] - packing.centres[i] + Vec3{u * a, v * b, w * c};
          if (norm_squared(way) <= cut * cut) found.push_back({j, way, norm_squared(way)});
        }
      }
    }
  }
  std::sort(found.begin(), found.end(), [](const Neighbour& first, const Neighbour& second) {
    return first.distance_squared < second.distance_squared;
  });
  return found;
}

// Without the sphere's own images, and those beyond 1.5 of spheres that are there already.
std::vector<Neighbour> spheres_only(const std::vector<Neighbour>& all, std::uint32_t i) {
  std::vector<Neighbour> found;
  for (const Neighbour& neighbour : all) {
    const bool repeats = std::any_of(found.begin(), found.end(), [&](const Neighbour& copy) {
      return copy.sphere == neighbour.sphere;
    });
    if (neighbour.sphere != i && (!repeats || neighbour.distance_squared <= 1.5 * 1.5))
      found.push_back(neighbour);
  }
  return found;
}

// Sphere and way, to 1e-7: images at one distance come in any order.
using Key = std::array<long, 4>;
std::vector<Key> keys(std::span<const Neighbour> neighbours) {
  std::vector<Key> all;
  for (const Neighbour& neighbour : neighbours) {
    const Vec3 way = 1e7 * neighbour.way;
    all.push_back({neighbour.sphere, std::lround(way.x), std::lround(way.y), std::lround(way.z)});
  }
  std::sort(all.begin(), all.end());
  return all;
}

bool nearest_first(std::span<const Neighbour> neighbours) {
  return std::is_sorted(neighbours.begin(), neighbours.end(),
                        [](const Neighbour& first, const Neighbour& second) {
                          return first.distance_squared < second.distance_squared;
                        });
}

struct Room {
  Container container;
  double height;
};

const std::vector<Room> rooms = {
    {PeriodicBox{8, 6.5}, 5},
    {PeriodicBox{2.02, 3.1}, 9},
    {PeriodicBox{40, 40}, 2},
    {WalledBox{5, 7}, 5},
    {WalledBox{1.05, 4}, 9},
    {Cylinder{6}, 5},
    {Cylinder{1.2}, 20},
    {Plates{6, 3}, 6},
    {FullyPeriodicBox{6, 5, 4}, 4},
    {FullyPeriodicBox{2.02, 2.3, 3.3}, 3.3},
};

}  // namespace

TEST_CASE("Neighbours by cells are those of all pairs and images, the nearest first") {
  const std::size_t room = GENERATE(range(std::size_t{0}, rooms.size()));
  const double cut = GENERATE(0.4, 1.05, 2.1, 4.5);
  CAPTURE(room, cut);
  const Packing packing = random_points(rooms[room].container, rooms[room].height, 150);
  const NeighbourTable table = neighbours_within(packing, cut);
  REQUIRE(table.size() == packing.centres.size());
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    CHECK(nearest_first(table.neighbours_of(i)));
    CHECK(keys(table.neighbours_of(i)) == keys(by_brute_force(packing, i, cut)));
  }
}

TEST_CASE("The nearest neighbours are the first of all pairs and images") {
  const std::size_t room = GENERATE(range(std::size_t{0}, rooms.size()));
  CAPTURE(room);
  const Packing packing = random_points(rooms[room].container, rooms[room].height, 60);
  const NeighbourTable table = nearest_neighbours(packing, 12);
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    std::vector<Neighbour> expected = spheres_only(by_brute_force(packing, i, 1e9), i);
    expected.resize(12);
    CHECK(nearest_first(table.neighbours_of(i)));
    CHECK(table.neighbours_of(i)[11].distance_squared ==
          Approx(expected[11].distance_squared).epsilon(1e-12));
    expected.pop_back();  // the other of two images as far may be the last
    CHECK(keys(table.neighbours_of(i).first(11)) == keys(expected));
  }
}

TEST_CASE("The nearest neighbours of spheres far apart are found among periods that are narrow") {
  // Searched within a distance, each would meet 1e9 images.
  Packing packing{PeriodicBox{2.5, 3}, {}};
  for (int k = 0; k < 20; ++k)
    packing.centres.push_back(
        {std::fmod(1.7 * k, 2.5), std::fmod(2.3 * k, 3.0), 4000.0 * k * (k % 5 == 4 ? 1.01 : 1)});
  packing.centres.push_back({1.25, 1.5, 0.4});  // and one that touches the first from both sides
  packing.centres[0] = {0, 1.5, 0.4};
  const NeighbourTable table = nearest_neighbours(packing, 12);
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    std::vector<Neighbour> expected = spheres_only(by_brute_force(packing, i, 1e9), i);
    expected.resize(12);
    CHECK(nearest_first(table.neighbours_of(i)));
    CHECK(keys(table.neighbours_of(i)) == keys(expected));
  }
}

TEST_CASE("Where there are fewer spheres than asked for, all are neighbours") {
  const Packing three{WalledBox{20, 20}, {{1, 1, 0.5}, {19, 19, 9}, {5, 1, 0.5}}};
  const NeighbourTable table = nearest_neighbours(three, 12);
  REQUIRE(table.size() == 3);
  CHECK(table.neighbours_of(0)[0].sphere == 2);
  CHECK(table.neighbours_of(0)[1].sphere == 1);
  CHECK(table.neighbours_of(1).size() == 2);

  const Packing none{WalledBox{20, 20}, {}};
  CHECK(nearest_neighbours(none, 12).size() == 0);
  CHECK(neighbours_within(none, 2).size() == 0);

  // Images are no other spheres.
  const Packing alone{PeriodicBox{4, 5}, {{0, 0, 0.5}}};
  CHECK(nearest_neighbours(alone, 3).neighbours_of(0).empty());
  const Packing two{FullyPeriodicBox{4, 5, 6}, {{0, 0, 0}, {1, 1, 0.5}}};
  REQUIRE(nearest_neighbours(two).neighbours_of(0).size() == 1);
  CHECK(nearest_neighbours(two).neighbours_of(0)[0].distance_squared == 2.25);
  // In a narrow box a sphere can touch another one from both sides.
  const Packing packing{FullyPeriodicBox{2.1, 9, 9}, {{0, 0, 0}, {1.05, 0, 0}}};
  CHECK(nearest_neighbours(packing).neighbours_of(0).size() == 2);
}

TEST_CASE("A centre just at the cut is a neighbour, also across the seam and on cells' bounds") {
  // Points on a grid of spacing 1/2: distances are exact.
  Packing packing{FullyPeriodicBox{4, 4, 4}, {}};
  for (int k = 0; k < 512; ++k) {
    packing.centres.push_back({0.5 * (k % 8), 0.5 * (k / 8 % 8), 0.5 * (k / 64)});
  }
  const auto [cut, expected] =
      GENERATE(table<double, std::size_t>({{0.5, 6}, {1, 32}, {1.5, 122}, {2.5, 514}}));
  const NeighbourTable table = neighbours_within(packing, cut);
  for (std::size_t i = 0; i < table.size(); ++i) CHECK(table.neighbours_of(i).size() == expected);
}
