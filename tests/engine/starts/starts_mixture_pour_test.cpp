#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "engine/starts/pour_bed.hpp"
#include "engine/starts/pour_descent.hpp"
#include "engine/starts/starts.hpp"
#include "tests/engine/starts/starts_supports.hpp"
#include "tests/engine/starts/steepest_descent_twin.hpp"

namespace jostle {
namespace {

StartSpheres with_diameters(const std::vector<double>& diameters,
                            PourOrder order = PourOrder::random) {
  return {static_cast<std::uint32_t>(diameters.size()), std::make_shared<const Sizes>(diameters),
          order};
}

Packing poured(const Container& container, const StartSpheres& spheres, std::uint64_t seed = 1) {
  RandomStream random(stream_key(seed, 0, 0, Purpose::start));
  return make_start(SteepestDescentPour{}, container, spheres, random);
}

// n spheres of diameters 1 and `ratio`: every fourth is large.
std::vector<double> two_sizes(std::size_t n, double ratio, double small = 1) {
  std::vector<double> diameters(n, small);
  for (std::size_t i = 0; i < n; i += 4) diameters[i] = ratio * small;
  return diameters;
}

// Spheres that neither rest on the floor nor are carried by their contacts.
std::size_t unsupported(const Packing& packing) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    if (packing.centres[i].z <= packing.radius(i) + 1e-12) continue;
    if (!carried(contacts(packing, i))) ++count;
  }
  return count;
}

Vec3 rest_from(PourBed& bed, std::uint32_t sphere, double x, double y) {
  bed.next(sphere);
  const auto start = bed.drop_point(x, y);
  REQUIRE(start);
  const auto rest = descend(bed, *start);
  REQUIRE(rest);
  return *rest;
}

Packing doubled(Packing packing) {
  for (Vec3& r : packing.centres) r = 2.0 * r;
  return packing;
}

}  // namespace

TEST_CASE("Poured spheres of several sizes do not overlap, and are carried") {
  for (const double ratio : {1.4, 3.0, 6.0, 10.0}) {
    const double width = 2.6 * ratio;
    for (const Container& container :
         {Container{PeriodicBox{width, width + 1}}, Container{WalledBox{width, 1.7 * ratio}},
          Container{Cylinder{width}}, Container{Plates{width, 1.7 * ratio}}}) {
      for (const PourOrder order : {PourOrder::random, PourOrder::as_listed, PourOrder::large_first,
                                    PourOrder::small_first}) {
        CAPTURE(ratio, container.index(), static_cast<int>(order));
        const Packing packing = poured(container, with_diameters(two_sizes(160, ratio), order));
        CHECK(deepest_overlap_brute_force(packing).depth <= 1e-12);
        CHECK(unsupported(packing) == 0);
      }
    }
  }
}

TEST_CASE("Spheres of several sizes come to rest where a brute-force descent does") {
  constexpr std::uint32_t n = 60;
  for (const double ratio : {1.4, 3.0, 6.0}) {
    const double width = 2.3 * ratio;
    for (const Container& container :
         {Container{PeriodicBox{width, width + 1}}, Container{WalledBox{width, width}},
          Container{Cylinder{width}}, Container{Plates{width, width}}}) {
      const StartSpheres spheres = with_diameters(two_sizes(n, ratio));
      PourBed bed(container, spheres.sizes);
      std::vector<double> in_bed;
      std::uint32_t compared = 0;
      RandomStream random(stream_key(11, 0, 0, Purpose::start));
      for (const std::uint32_t sphere : pour_sequence(spheres, random)) {
        const double radius = spheres.sizes->radius(sphere);
        bed.next(sphere);
        std::optional<Vec3> start;
        while (!start) {
          const double share_x = random.uniform(), share_y = random.uniform();
          start = bed.drop_point_of_shares(share_x, share_y);
        }
        const auto rest = descend(bed, *start);
        REQUIRE(rest);
        const Packing obstacles{container, bed.centres(),
                                in_bed.empty() ? nullptr : std::make_shared<const Sizes>(in_bed)};
        if (const auto twin = SteepestDescentTwin(obstacles, radius).rest(*start)) {
          const Vec3 offset = separation(Boundary(container), *rest, *twin);
          CAPTURE(ratio, container.index(), in_bed.size(), rest->x, rest->y, rest->z, twin->x,
                  twin->y, twin->z);
          CHECK(std::sqrt(norm_squared(offset)) < 1e-9);
          ++compared;
        }
        bed.add(*rest);
        in_bed.push_back(2 * radius);
      }
      // Spheres in corners rest exactly on one another.
      CHECK(compared >= n - 6);
    }
  }
}

TEST_CASE("A large sphere that rolls off a small one lands beside it") {
  // Both rest on the floor and touch: the horizontal distance is 2 sqrt(R r).
  for (const double ratio : {1.0, 1.4, 3.0, 6.0, 10.0}) {
    const double small = 0.5, large = 0.5 * ratio;
    const StartSpheres spheres = with_diameters({2 * small, 2 * large});
    PourBed bed(PeriodicBox{50, 50}, spheres.sizes);
    bed.next(0);
    bed.add({20, 20, small});
    const Vec3 rest = rest_from(bed, 1, 20.03, 20.04);
    CHECK(rest.z == Approx(large).epsilon(1e-14));
    const double dx = rest.x - 20, dy = rest.y - 20, lateral = std::sqrt(dx * dx + dy * dy);
    CHECK(lateral == Approx(2 * std::sqrt(large * small)).epsilon(1e-12));
    CHECK(dx / lateral == Approx(0.6).epsilon(1e-9));
  }
}

TEST_CASE("A small sphere sifts through three large ones that touch, from a ratio of 6.46") {
  for (const double ratio : {6.4, 7.0}) {
    const double large = ratio / 2;
    const StartSpheres spheres = with_diameters({2 * large, 2 * large, 2 * large, 1});
    PourBed bed(WalledBox{50, 50}, spheres.sizes);
    const std::vector<Vec3> corners = {{20, 20, large},
                                       {20 + 2 * large, 20, large},
                                       {20 + large, 20 + std::sqrt(3.0) * large, large}};
    for (std::uint32_t i = 0; i < 3; ++i) {
      bed.next(i);
      bed.add(corners[i]);
    }
    const Vec3 rest = rest_from(bed, 3, 20 + 0.9 * large, 20 + 0.5 * large);
    if (ratio > 6.46) {
      CHECK(rest.z == 0.5);
    } else {
      // On all three: over the middle of their triangle.
      const double reach = large + 0.5, across = 2 * large / std::sqrt(3.0);
      CHECK(rest.z == Approx(large + std::sqrt(reach * reach - across * across)).epsilon(1e-12));
      CHECK(rest.x == Approx(20 + large).epsilon(1e-9));
    }
  }
}

TEST_CASE("Sizes of diameter 1 are poured to the bits of equal spheres") {
  for (const Container& container :
       {Container{PeriodicBox{5, 6}}, Container{WalledBox{5, 4.5}}, Container{Cylinder{5.5}},
        Container{Cylinder{1.8}}, Container{WalledBox{1.3, 4}}, Container{Plates{5, 4.5}}}) {
    const StartSpheres spheres = with_diameters(std::vector<double>(200, 1), PourOrder::as_listed);
    RandomStream random(stream_key(1, 0, 0, Purpose::start));
    const Packing equal = make_start(SteepestDescentPour{}, container, 200, random);
    CHECK(poured(container, spheres).centres == equal.centres);
  }
}

TEST_CASE("All lengths doubled give a pour with its centres doubled, bit for bit") {
  const std::vector<double> diameters = two_sizes(150, 4, 0.9);
  std::vector<double> twice;
  for (const double diameter : diameters) twice.push_back(2 * diameter);
  const std::vector<std::pair<Container, Container>> pairs = {
      {PeriodicBox{8.3, 9.1}, PeriodicBox{16.6, 18.2}},
      {WalledBox{8.3, 9.1}, WalledBox{16.6, 18.2}},
      {Cylinder{9.1}, Cylinder{18.2}},
      {Plates{8.3, 9.1}, Plates{16.6, 18.2}}};
  for (const auto& [single, wide] : pairs) {
    CHECK(poured(wide, with_diameters(twice)).centres ==
          doubled(poured(single, with_diameters(diameters))).centres);
  }
}

TEST_CASE("Small beds of any sizes, narrow and degenerate ones too, are poured without overlap") {
  for (std::uint64_t seed = 0; seed < 250; ++seed) {
    RandomStream random(stream_key(seed, 0, 0, Purpose::sizes));
    const double least = 0.2 + 0.8 * random.uniform(), ratio = 1 + 9 * random.uniform();
    const bool two = random.integer_below(2) == 0;
    std::vector<double> diameters;
    for (int i = 0; i < 60; ++i) {
      const double u = random.uniform();
      diameters.push_back(least * (two ? (u < 0.7 ? 1 : ratio) : 1 + (ratio - 1) * u * u));
    }
    const double largest = *std::ranges::max_element(diameters);
    // Every other container is as narrow as its largest sphere, or half a diameter wider.
    const double width =
        largest * (seed % 2 == 0 ? 1 + 2 * random.uniform()
                                 : 1 + 0.5 * static_cast<double>(random.integer_below(3)));
    const Container container = seed % 3 == 0
                                    ? Container{PeriodicBox{width + 1.001 * largest, 2.5 * largest}}
                                : seed % 3 == 1 ? Container{WalledBox{width, 2.2 * largest}}
                                                : Container{Cylinder{width}};
    CAPTURE(seed, container.index(), width, largest);
    const auto order = static_cast<PourOrder>(random.integer_below(4));
    const Packing packing = poured(container, with_diameters(diameters, order), seed);
    CHECK(deepest_overlap_brute_force(packing).depth <= 1e-12);
  }
}

TEST_CASE("In a tube a sphere rests on another on the axis, at any angle") {
  for (const double room : {2.0, 1e-4}) {
    const StartSpheres spheres = with_diameters({3, 3 - room});
    PourBed bed(Cylinder{3}, spheres.sizes);
    bed.next(0);
    bed.add({1.5, 1.5, 1.5});
    const Vec3 rest = rest_from(bed, 1, 1.5 + 0.2 * room, 1.5);
    const double reach = 3 - 0.5 * room, across = 0.5 * room;
    CHECK(rest.x == Approx(1.5 + across).epsilon(1e-9));
    CHECK(rest.z == Approx(1.5 + std::sqrt(reach * reach - across * across)).epsilon(1e-9));
  }
}

TEST_CASE("A sphere with a place is poured first, from there") {
  StartSpheres spheres = with_diameters(two_sizes(40, 3));
  spheres.placed = {{8, 4.25, 3.5}};
  for (const Container& container :
       {Container{PeriodicBox{8, 7}}, Container{WalledBox{8, 7}}, Container{Cylinder{8}}}) {
    CHECK(poured(container, spheres).centres[8] == Vec3{4.25, 3.5, 1.5});
  }
  spheres.placed = {{8, 1.2, 3.5}};
  CHECK_THROWS_WITH(poured(WalledBox{8, 7}, spheres), Catch::Contains("overlaps a side"));
  CHECK(poured(PeriodicBox{8, 7}, spheres).centres[8] == Vec3{1.2, 3.5, 1.5});
}

TEST_CASE("Large spheres that are poured first lie as they do without the small ones") {
  const std::vector<double> diameters = two_sizes(80, 2.5);
  const Packing mixture =
      poured(PeriodicBox{7, 8}, with_diameters(diameters, PourOrder::large_first));
  const Packing large =
      poured(PeriodicBox{7, 8}, with_diameters(std::vector<double>(20, 2.5), PourOrder::as_listed));
  for (std::size_t i = 0; i < 20; ++i) {
    CHECK(std::sqrt(norm_squared(mixture.centres[4 * i] - large.centres[i])) < 1e-9);
  }
}

TEST_CASE("Fitted pours and crystals reject spheres of several sizes by name") {
  const StartSpheres spheres = with_diameters({1, 1.4});
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  CHECK_THROWS_WITH(make_start(FittedPour{}, WalledBox{8, 8}, spheres, random),
                    Catch::Contains("a fitted pour requires equal spheres"));
  CHECK_THROWS_WITH(make_start(Crystal{}, WalledBox{8, 8}, spheres, random),
                    Catch::Contains("a crystal requires equal spheres"));
}

}  // namespace jostle
