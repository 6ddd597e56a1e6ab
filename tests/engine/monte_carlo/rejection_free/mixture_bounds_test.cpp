#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <span>

#include "tests/engine/monte_carlo/rejection_free/bound_cases.hpp"
#include "tests/engine/sample_packings.hpp"

// Bounds of rejection-free sampling for spheres of several sizes.
using namespace jostle;

namespace {

constexpr std::array ratios = {1.4, 3.0, 10.0};

// Two spheres that do not overlap, above the floor, the second within reach of a step of the first:
// now in contact to rounding, now at the end of the longest step.
std::vector<PackedCentre> random_pair(const PeriodicBox& box, double radius, double second,
                                      double longest, RandomStream& random) {
  const double touching = radius + second, u = random.uniform();
  const double gap = u < 0.5   ? std::pow(10.0, -12 * random.uniform()) * longest
                     : u < 0.6 ? longest * (1 + 1e-4 * (random.uniform() - 0.5))
                               : longest * random.uniform();
  const double downward = 1.2 * random.uniform() - 0.2, across = std::sqrt(1 - downward * downward);
  const double azimuth = 2 * std::numbers::pi * random.uniform();
  const double distance = touching * (1 + 1e-15) + gap;
  const Vec3 start{box.width_x * random.uniform(), box.width_y * random.uniform(),
                   2.2 * touching + 2 * longest};
  const Vec3 end =
      start + distance * Vec3{across * std::cos(azimuth), across * std::sin(azimuth), -downward};
  return {packed_sphere(start, radius), packed_sphere(wrapped(box, end), second)};
}

// Steps past random pairs of spheres, of the smallest possible diameters, the largest, and between.
template <class Directions>
Tried try_pairs(double ratio, double step_over_least, int draws) {
  RandomStream random(stream_key(81, static_cast<std::uint64_t>(10 * ratio), 0, Purpose::start));
  Tried tried;
  for (int draw = 0; draw < draws; ++draw) {
    const double smallest =
        random.uniform() < 0.3 ? 0.2 : 0.2 * std::pow(50.0 / ratio, random.uniform());
    const auto diameter = [&] {
      const double u = random.uniform();
      return smallest * (u < 0.3 ? 1 : u < 0.6 ? ratio : std::pow(ratio, random.uniform()));
    };
    const double width = 2.1 * ratio * smallest + 8 * step_over_least * smallest;
    const PeriodicBox box{width, 1.1 * width};
    auto tables = tables_for<PeriodicBox, Directions, SeveralSizes>(box);
    Kind<Directions> kind;
    kind.move.max_step = step_over_least * smallest;
    const auto bins = Kind<Directions>{kind.move}.bins();
    for (int pair = 0; pair < 20; ++pair) {
      tables.build(bins,
                   random_pair(box, 0.5 * diameter(), 0.5 * diameter(), bins.longest, random));
      tried += try_steps(box, Kind<Directions>{kind.move}, tables, 1, random);
    }
  }
  return tried;
}

template <class Directions>
void check_pairs(int draws, int least_beyond) {
  for (const double ratio : ratios) {
    Tried all;
    for (const double step : {1e-5, 1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3, 0.6, 1.0, 2.0}) {
      CAPTURE(ratio, step);
      const Tried tried = try_pairs<Directions>(ratio, step, draws);
      CHECK(tried.wrong == 0);
      CHECK(tried.possible_within > 0);
      all += tried;
    }
    CHECK(all.beyond >= least_beyond);
  }
}

template <class Box>
std::vector<PackedCentre> mixed_bed(const Box& box, double ratio, double largest, std::uint32_t n) {
  const std::vector<double> diameters = graded_diameters(n, largest / ratio, ratio);
  double cubes = 0;
  for (const double d : diameters) cubes += d * d * d;
  const double height = 8 * cubes * sphere_volume / footprint_area(box);
  return let_down<SeveralSizes>(random_mixture(box, diameters, height, 9), 2000);
}

template <class Box>
void check_beds(const Box& box, double largest) {
  for (const double ratio : ratios) {
    const auto centres = mixed_bed(box, ratio, largest, 85);
    const double least = largest / ratio;
    RandomStream random(stream_key(82, 0, 0, Purpose::start));
    const auto check = [&]<class Directions>(const Kind<Directions>& kind) {
      CAPTURE(box.extent().x, ratio, kind.move.max_step);
      auto tables = tables_for<Box, Directions, SeveralSizes>(box);
      tables.build(kind.bins(), centres);
      const Tried tried = try_steps(box, kind, tables, 85, random);
      CHECK(tried.wrong == 0);
      if (tables.bins().longest < 1.9 * least) CHECK(tried.beyond > 850);
      CHECK(tried.possible_within > 0);
    };
    for (const double step : {0.01, 0.1, 0.4, 1.2, 2.0}) {
      check(Kind<PolarDirections>{PolarMove{step * least, 1.2}});
      check(Kind<CubicDirections>{MetropolisMove{0.7 * step * least}});
    }
  }
}

}  // namespace

TEST_CASE("no bound rejects a possible step past a sphere of another size") {
  check_pairs<PolarDirections>(25, 80'000);
  check_pairs<CubicDirections>(25, 80'000);
}

TEST_CASE("a million steps past spheres of other sizes: polar", "[slow]") {
  check_pairs<PolarDirections>(300, 1'000'000);
}

TEST_CASE("a million steps past spheres of other sizes: Metropolis", "[slow]") {
  check_pairs<CubicDirections>(300, 1'000'000);
}

TEST_CASE("every step beyond its bound overlaps in mixtures of all containers") {
  check_beds(PeriodicBox{6.2, 7}, 3);
  check_beds(PeriodicBox{20.01, 21}, 10);
  check_beds(WalledBox{3.1, 6}, 3);
  check_beds(Cylinder{5}, 2.5);
  check_beds(Plates{6.3, 4}, 3);
}

TEST_CASE("a sphere of ten diameters has bounds from hundreds of small ones") {
  // More obstacles than any fixed room: the lists are looked at in parts.
  const PeriodicBox box{20.5, 21};
  const Vec3 place{10, 10, 5};
  std::vector<Vec3> places = random_packing(box, 3500, 40, 4).centres;
  std::erase_if(places, [&](Vec3 r) { return overlaps(box, r, place, 5.5); });
  places.insert(places.begin(), place);
  std::vector<double> diameters(places.size(), 1.0);
  diameters[0] = 10;
  const auto centres =
      let_down<SeveralSizes>({box, places, std::make_shared<const Sizes>(diameters)}, 1500);
  const Vec3 large = unpacked(centres[0]);
  const auto near = std::ranges::count_if(centres, [&](const PackedCentre& second) {
    return norm_squared(separation(box, unpacked(second), large)) < 5.8 * 5.8;
  });
  REQUIRE(near > 2 * std::ptrdiff_t{most_in_the_way});
  RandomStream random(stream_key(83, 0, 0, Purpose::start));
  const auto check = [&]<class Directions>(const Kind<Directions>& kind) {
    auto tables = tables_for<PeriodicBox, Directions, SeveralSizes>(box);
    tables.build(kind.bins(), centres);
    for (int repeat = 0; repeat < 30; ++repeat) {
      CHECK(try_steps(box, kind, tables, 1, random).wrong == 0);
    }
    // Hardly a bin of the large sphere is open.
    const double weight = tables.weights().weight(0);
    CHECK(weight < 0.2 * n_ring_parts * Directions::n_sectors * whole_weight);
    for (const InstructionSet set : instruction_sets()) {
      BoundTables<PeriodicBox, Directions, SeveralSizes> remaining(box,
                                                                   rejection_free_kernels_for(set));
      remaining.build(kind.bins(), centres);
      CHECK(remaining.weights().total() == tables.weights().total());
      CHECK(remaining.weights().weight(0) == weight);
    }
  };
  check(Kind<PolarDirections>{PolarMove{0.3}});
  check(Kind<CubicDirections>{MetropolisMove{0.2}});
}

TEST_CASE("bounds of sizes of diameter 1 are those of equal spheres, bit for bit") {
  const PeriodicBox box{4, 5};
  const auto equal = let_down<EqualSpheres>(random_packing(box, 100, 20, 9), 3000);
  std::vector<PackedCentre> sized;
  for (const PackedCentre& centre : equal) sized.push_back(packed_sphere(unpacked(centre), 0.5));
  const auto compare = [&]<class Directions>(const Kind<Directions>& kind) {
    CAPTURE(kind.move.max_step);
    for (const InstructionSet set : instruction_sets()) {
      const RejectionFreeKernels kernels = rejection_free_kernels_for(set);
      BoundTables<PeriodicBox, Directions, EqualSpheres> expected(box, kernels);
      BoundTables<PeriodicBox, Directions, SeveralSizes> found(box, kernels);
      expected.build(kind.bins(), equal);
      found.build(kind.bins(), sized);
      for (std::uint32_t i = 0; i < equal.size(); ++i) {
        REQUIRE(std::ranges::equal(std::as_bytes(std::span(&expected.row(i), 1)),
                                   std::as_bytes(std::span(&found.row(i), 1))));
      }
    }
  };
  for (const double step : {1e-4, 0.01, 0.1, 0.3, 0.7, 1.5, 2.0}) {
    compare(Kind<PolarDirections>{PolarMove{step}});
    compare(Kind<CubicDirections>{MetropolisMove{step}});
  }
}

TEST_CASE("single precision decides for mixtures only what double precision would") {
  const auto check = [](const auto& box, double ratio) {
    using Box = std::decay_t<decltype(box)>;
    const auto centres = mixed_bed(box, ratio, 3, 60);
    const Kind<PolarDirections> kind{PolarMove{0.1 * 3 / ratio}};
    auto tables = tables_for<Box, PolarDirections, SeveralSizes>(box);
    tables.build(kind.bins(), centres);
    const PackedBox<Box, SeveralSizes> packed_box(box);
    std::uint64_t tests = 0;
    int blocked = 0;
    for (std::uint32_t i = 0; i < 60; ++i) {
      for (std::uint32_t j = 0; j < 60; ++j) {
        const Vec3 displacement = separation(box, unpacked(centres[j]), unpacked(centres[i]));
        const double distance = std::sqrt(norm_squared(displacement));
        const double touching = centres[i].radius + centres[j].radius;
        if (i == j || distance > touching + 0.9 * kind.move.max_step) continue;
        for (const double beyond : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-9, 1e-12, 0.0, -1e-12, -1e-9,
                                    -1e-7, -1e-6, -1e-5, -1e-4, -1e-3}) {
          const Vec3 step = ((distance - touching + beyond) / distance) * displacement;
          const PackedCentre target = packed_box.wrapped(
              {centres[i].xy + Pair{step.x, step.y}, centres[i].z + step.z, centres[i].radius});
          bool expected = false;
          for (std::uint32_t k = 0; k < 60; ++k) {
            expected =
                expected || (k != i && distance_squared(packed_box, target, centres[k]) <
                                           SeveralSizes::touching_squared(target, centres[k]));
          }
          REQUIRE(tables.blocked(i, step, target, tests) == expected);
          blocked += expected;
        }
      }
    }
    CHECK(blocked > 100);
  };
  for (const double ratio : ratios) {
    check(PeriodicBox{6.01, 7}, ratio);
    check(WalledBox{40, 4}, ratio);
    check(Cylinder{6}, ratio);
    check(Plates{6.01, 4}, ratio);
  }
}
