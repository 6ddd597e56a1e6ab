#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <utility>

#include "tests/engine/monte_carlo/rejection_free/bound_cases.hpp"
#include "tests/engine/sample_packings.hpp"

using namespace jostle;

namespace {

// A bed let down from random places, and still creeping.
template <class Box>
std::vector<PackedCentre> bed(const Box& box, std::uint32_t n) {
  return let_down<EqualSpheres>(random_packing(box, n, 20, 9), 3000);
}

template <class Box, class Directions>
void check_bounds_of(const Box& box, const std::vector<PackedCentre>& centres,
                     const Kind<Directions>& kind) {
  auto tables = tables_for<Box, Directions>(box);
  tables.build(kind.bins(), centres);
  RandomStream random(stream_key(48, 0, 0, Purpose::start));
  const auto n = static_cast<std::uint32_t>(centres.size());
  const Tried tried = try_steps(box, kind, tables, n, random);
  CHECK(tried.wrong == 0);
  // A step longer than a sphere is wide may pass it by, and nothing bounds it.
  if (tables.bins().longest < 2) CHECK(tried.beyond > static_cast<int>(10 * centres.size()));
  // The bounds pay: some of the remaining steps are free.
  CHECK(tried.possible_within > 0);
}

template <class Box>
void check_bounds(const Box& box, std::uint32_t n) {
  const auto centres = bed(box, n);
  for (const PolarMove& move : {PolarMove{}, PolarMove{0.4, 1.5, ThetaLaw::linear},
                                PolarMove{0.1, 0.2, ThetaLaw::exponential}, PolarMove{0.01},
                                PolarMove{1.2}, PolarMove{2.5}}) {
    check_bounds_of(box, centres, Kind<PolarDirections>{move});
  }
  for (const double step : {0.1, 0.02, 0.3, 0.7}) {
    check_bounds_of(box, centres, Kind<CubicDirections>{MetropolisMove{step}});
  }
}

template <class Directions>
void check_function_of_centres(const Kind<Directions>& kind) {
  constexpr int n_sectors = Directions::n_sectors;
  const PeriodicBox box{4, 5};
  auto moved = tables_for<PeriodicBox, Directions>(box);
  auto fresh = tables_for<PeriodicBox, Directions>(box);
  moved.build(kind.bins(), bed(box, 100));
  RandomStream random(stream_key(49, 0, 0, Purpose::start));
  int moves = 0;
  for (int trial = 0; trial < 200'000; ++trial) {
    const auto i = static_cast<std::uint32_t>(random.integer_below(100));
    const Vec3 step{0.2 * random.uniform() - 0.1, 0.2 * random.uniform() - 0.1,
                    0.2 * random.uniform() - 0.1};
    const Vec3 target = wrapped(box, unpacked(moved.centres()[i]) + step);
    if (norm_squared(step) > 0.01 || !possible<EqualSpheres>(box, moved.centres(), i, step))
      continue;
    moved.move(i, packed(target));
    ++moves;
  }
  CHECK(moves > 1000);
  fresh.build(kind.bins(), moved.centres());
  CHECK(fresh.weights().total() == moved.weights().total());
  for (std::uint32_t i = 0; i < 100; ++i) {
    CHECK(fresh.weights().weight(i) == moved.weights().weight(i));
    for (int bin = 0; bin < n_rings * n_sectors; ++bin) {
      const int ring = bin / n_sectors, sector = bin % n_sectors;
      REQUIRE(fresh.row(i).bound(ring, sector) == moved.row(i).bound(ring, sector));
    }
  }
}

// The weight of a sector covers its bins, and hardly more.
template <class Box, class Directions>
void check_weights_of(const Box& box, const std::vector<PackedCentre>& centres,
                      const Kind<Directions>& kind) {
  auto tables = tables_for<Box, Directions>(box);
  tables.build(kind.bins(), centres);
  double excess = 0, all = 0;
  for (std::uint32_t i = 0; i < centres.size(); ++i) {
    std::int32_t state_before = 0;
    for (int sector = 0; sector < Directions::n_sectors; ++sector) {
      double sum = 0;
      for (int ring = 0; ring < n_rings; ++ring) {
        const double ratio = kind.ratio(tables.row(i).bound(ring, sector));
        const double size =
            std::is_same_v<Directions, PolarDirections> ? ratio : std::pow(ratio, 3);
        sum += size * tables.bins().parts[ring] * whole_weight;
      }
      const std::int32_t weight =
          tables.row(i).up_to[sector] - std::exchange(state_before, tables.row(i).up_to[sector]);
      REQUIRE(weight >= sum * (1 - 1e-12));
      excess += weight - sum;
      all += sum;
    }
    REQUIRE(state_before == static_cast<std::int32_t>(tables.weights().weight(i)));
  }
  CHECK(excess < 1e-3 * all);
}

// Single precision rejects and lets pass as double precision does, near contact too.
template <class Box>
void check_blocked(const Box& box, std::uint32_t n) {
  const auto centres = bed(box, n);
  const Kind<PolarDirections> kind;
  auto tables = tables_for<Box, PolarDirections>(box);
  tables.build(kind.bins(), centres);
  const PackedBox<Box> packed_box(box);
  RandomStream random(stream_key(51, 0, 0, Purpose::start));
  std::uint64_t tests = 0;
  int blocked = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    const Vec3 own = unpacked(centres[i]);
    for (std::uint32_t j = 0; j < n; ++j) {
      const Vec3 displacement = separation(box, unpacked(centres[j]), own);
      const double distance = std::sqrt(norm_squared(displacement));
      if (i == j || distance > 1.09) continue;
      for (const double beyond : {1e-3, 1e-5, 3e-6, 1e-6, 1e-7, 1e-9, 1e-12, 0.0, -1e-12, -1e-9,
                                  -1e-7, -1e-6, -3e-6, -1e-5, -1e-3}) {
        const double length = distance - 1 + beyond;
        const Vec3 step = (length / distance) * displacement;
        const PackedCentre target =
            packed_box.wrapped({centres[i].xy + Pair{step.x, step.y}, centres[i].z + step.z, 0});
        bool expected = false;
        for (std::uint32_t k = 0; k < n; ++k) {
          expected = expected || (k != i && distance_squared(packed_box, target, centres[k]) < 1.0);
        }
        REQUIRE(tables.blocked(i, step, target, tests) == expected);
        blocked += expected;
      }
    }
  }
  CHECK(blocked > static_cast<int>(n));
}

}  // namespace

TEST_CASE("every step beyond its bound overlaps, periodic") {
  check_bounds(PeriodicBox{4, 5}, 100);
  check_bounds(PeriodicBox{2.1, 2.3}, 30);
}

TEST_CASE("every step beyond its bound overlaps, between walls") {
  check_bounds(WalledBox{4, 3}, 70);
  check_bounds(WalledBox{1.1, 1.5}, 12);
}

TEST_CASE("every step beyond its bound overlaps, in a tube") {
  check_bounds(Cylinder{5}, 90);
  check_bounds(Plates{4, 4.2}, 90);
  check_bounds(Cylinder{1.2}, 12);
}

TEST_CASE("a sector weighs what its bins do") {
  const PeriodicBox box{4, 5};
  const auto centres = bed(box, 100);
  check_weights_of(box, centres, Kind<PolarDirections>{});
  check_weights_of(box, centres, Kind<CubicDirections>{});
}

TEST_CASE("single precision decides only what double precision would") {
  check_blocked(PeriodicBox{4, 5}, 100);
  check_blocked(WalledBox{40, 3}, 70);
  check_blocked(Cylinder{5}, 90);
  check_blocked(Plates{4, 4.2}, 90);
}

TEST_CASE("bounds are a function of the centres, whatever moves led there") {
  check_function_of_centres(Kind<PolarDirections>{});
  check_function_of_centres(Kind<CubicDirections>{});
}

TEST_CASE("a weight tree finds what adding up the weights finds") {
  RandomStream random(stream_key(50, 0, 0, Purpose::start));
  for (const std::size_t n : {1, 15, 16, 17, 256, 257, 5000}) {
    std::vector<std::uint32_t> weights(n);
    WeightTree tree;
    tree.assign(weights);
    CHECK(tree.total() == 0);
    for (std::uint32_t i = 0; i < n; ++i) {
      weights[i] = static_cast<std::uint32_t>(
          random.integer_below(4) == 0 ? 0 : random.integer_below(1u << 25));
      tree.set(i, weights[i]);
    }
    const std::uint64_t total = std::accumulate(weights.begin(), weights.end(), std::uint64_t{0});
    REQUIRE(tree.total() == total);
    for (int draw = 0; draw < 1000 && total > 0; ++draw) {
      const std::uint64_t target = draw == 0   ? 0
                                   : draw == 1 ? total - 1
                                               : random.integer_below(total);
      std::uint32_t i = 0;
      std::uint64_t rest = target;
      while (rest >= weights[i]) rest -= weights[i++];
      const WeightTree::Hit hit = tree.find(target);
      REQUIRE(hit.index == i);
      REQUIRE(hit.rest == rest);
    }
  }
}
