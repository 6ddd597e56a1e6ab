#include "structure/voids/bernal_holes.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "structure/voids/delaunay.hpp"
#include "tests/structure/reference_deposit.hpp"
#include "tests/structure/voids/regular_holes.hpp"
#include "tests/structure/voids/voronoi_points.hpp"

using namespace jostle;

namespace {

constexpr HoleKind kinds[] = {HoleKind::tetrahedron, HoleKind::half_octahedron,
                              HoleKind::trigonal_prism, HoleKind::tetragonal_dodecahedron,
                              HoleKind::archimedean_antiprism};
constexpr Region whole_bed{0, 1000, 0};

// The tip of the half-octahedron over a square, on the side away from `inside`.
Vec3 cap(Vec3 a, Vec3 b, Vec3 c, Vec3 inside) {
  const Vec3 middle = 0.5 * (a + c), normal = cross(b - a, c - b);
  const double side = dot(normal, middle - inside) > 0 ? 1 : -1;
  return middle + half_root_2 * side / std::sqrt(norm_squared(normal)) * normal;
}

HoleTable table_of(const Packing& packing) {
  return hole_table(bernal_holes(packing), packing.container, whole_bed);
}

using Counts = std::array<std::uint64_t, 5>;

}  // namespace

TEST_CASE("Every regular hole is made out, with and without noise") {
  const std::pair<std::vector<Vec3>, Counts> cases[] = {
      {tetrahedron(), {1, 0, 0, 0, 0}},  {half_octahedron(), {0, 1, 0, 0, 0}},
      {octahedron(), {0, 2, 0, 0, 0}},   {prism(), {0, 0, 1, 0, 0}},
      {dodecahedron(), {0, 0, 0, 1, 0}}, {antiprism(), {0, 0, 0, 0, 1}}};
  for (const auto& [corners, counts] : cases) {
    double volume = 0;
    for (std::size_t k = 0; k < 5; ++k)
      volume += static_cast<double>(counts[k]) * canonical_holes[k].volume;
    for (const double noise : {0.0, 1e-9, 1e-6, 1e-3, 1e-2}) {
      for (std::uint64_t trial = 0; trial < 50; ++trial) {
        CAPTURE(counts, noise, trial);
        const HoleTable table = table_of(shaken(within_walls(corners), noise, trial));
        REQUIRE(table.counts == counts);
        REQUIRE(table.volume() - table.unclassified_volume ==
                Approx(volume).epsilon(1e-5 + 10 * noise));
      }
    }
  }
}

TEST_CASE("Half-octahedra on the squares of prisms and antiprisms are holes of their own") {
  auto capped_prism = prism();
  const Vec3 inside = {0.5, 0.3, 0.5};
  for (const auto& [a, b, c] : {std::array{0, 1, 4}, std::array{1, 2, 5}, std::array{2, 0, 3}})
    capped_prism.push_back(cap(capped_prism[a], capped_prism[b], capped_prism[c], inside));
  auto capped_antiprism = antiprism();
  capped_antiprism.push_back(
      cap(capped_antiprism[0], capped_antiprism[1], capped_antiprism[2], {0, 0, 0.4}));
  capped_antiprism.push_back(
      cap(capped_antiprism[4], capped_antiprism[5], capped_antiprism[6], {0, 0, 0.4}));
  for (const double noise : {0.0, 1e-6, 1e-3}) {
    for (std::uint64_t trial = 0; trial < 50; ++trial) {
      CAPTURE(noise, trial);
      CHECK(table_of(shaken(within_walls(capped_prism), noise, trial)).counts ==
            Counts{0, 3, 1, 0, 0});
      CHECK(table_of(shaken(within_walls(capped_antiprism), noise, trial)).counts ==
            Counts{0, 2, 0, 0, 1});
    }
  }
}

TEST_CASE("Close packings have two tetrahedra and an octahedron, two halves, a sphere") {
  for (const Packing& crystal : {fcc_points(), hcp_points()}) {
    const auto* box = std::get_if<FullyPeriodicBox>(&crystal.container);
    const double all = box->width_x * box->width_y * box->height;
    for (const double noise : {0.0, 1e-9, 1e-6, 1e-3, 1e-2}) {
      CAPTURE(noise);
      const HoleTable table = table_of(with_noise(crystal, noise));
      const auto n = static_cast<std::uint64_t>(crystal.centres.size());
      CHECK(table.counts == Counts{2 * n, 2 * n, 0, 0, 0});
      CHECK(table.volume() == Approx(all).epsilon(1e-10));
      CHECK(table.unclassified_volume == Approx(0).margin(1e-10 * all));
      CHECK(table.number_fraction(HoleKind::tetrahedron) == 0.5);
      CHECK(table.volume_fraction(HoleKind::tetrahedron) == Approx(1 / 3.0).epsilon(1e-5 + noise));
    }
  }
}

TEST_CASE("Delaunay tetrahedra fill a periodic box") {
  const Packing points = poisson_points();
  const auto* box = std::get_if<FullyPeriodicBox>(&points.container);
  double volume = 0;
  for (const auto& tetrahedron : delaunay_tetrahedra(points)) volume += tetrahedron.volume;
  CHECK(volume == Approx(box->width_x * box->width_y * box->height).epsilon(1e-10));
  CHECK_THROWS_WITH(delaunay_tetrahedra({PeriodicBox{3, 8}, {{1, 1, 1}}}),
                    Catch::Matchers::Contains("at least 4 diameters"));
}

TEST_CASE("Table I has the volumes of the regular holes") {
  double all = 0;
  for (const CanonicalHole& hole : canonical_holes) all += hole.number_fraction * hole.volume;
  for (const CanonicalHole& hole : canonical_holes) {
    CHECK(hole.number_fraction * hole.volume / all == Approx(hole.volume_fraction).margin(2e-3));
  }
}

TEST_CASE("Holes of a deposit share out its space") {
  const Packing deposit = reference_deposit();
  const auto holes = bernal_holes(deposit);
  double tetrahedra = 0, slices = 0;
  for (const auto& tetrahedron : delaunay_tetrahedra(deposit)) tetrahedra += tetrahedron.volume;
  for (double low = 0; low < 20; ++low) {
    const Region slice{low, std::nextafter(low + 1, 0)};
    slices += hole_table(holes, deposit.container, slice).volume();
  }
  CHECK(slices == Approx(tetrahedra).epsilon(1e-12));
  const HoleTable table = hole_table(holes, deposit.container, pore_region);
  double numbers = 0, volumes = 0;
  for (const HoleKind kind : kinds) {
    numbers += table.number_fraction(kind);
    volumes += table.volume_fraction(kind);
    CHECK(table.counts[static_cast<std::size_t>(kind)] > 0);
  }
  CHECK(numbers == Approx(1).epsilon(1e-12));
  CHECK(volumes == Approx(1).epsilon(1e-12));
  // The order of table I, but for the two kinds that are rarest.
  CHECK(table.counts[0] > table.counts[1]);
  CHECK(table.counts[1] > table.counts[2]);
  CHECK(table.counts[2] > table.counts[3] + table.counts[4]);
  // More of the volume finds a hole as bonds may be longer.
  double unclassified = 1;
  for (const double last : {1.2, 1.4, 1.6}) {
    const auto found_holes =
        hole_table(bernal_holes(deposit, {.last = last}), deposit.container, pore_region);
    CHECK(found_holes.volume() == Approx(table.volume()).epsilon(0.01));
    CHECK(found_holes.unclassified_fraction() < unclassified);
    unclassified = found_holes.unclassified_fraction();
  }
  CHECK(unclassified < 0.05);
  // The region reaches over the whole width: holes across its ends nearly balance.
  CHECK(table.volume() == Approx(pore_region.volume(deposit.container)).epsilon(0.02));
}
