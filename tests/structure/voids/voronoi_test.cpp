#include "structure/voids/voronoi.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "tests/structure/reference_deposit.hpp"
#include "tests/structure/voids/voronoi_points.hpp"

using namespace jostle;

namespace {

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double mean_faces(const VoronoiCells& cells, double least_area) {
  double faces = 0;
  for (std::uint32_t i = 0; i < cells.size(); ++i) faces += n_faces(cells, i, least_area);
  return faces / static_cast<double>(cells.size());
}

// Cells against the table that voro++ printed, with six digits.
void check_table(const VoronoiCells& cells, const std::string& name, double unit) {
  const auto rows = rows_of(name);
  REQUIRE(rows.size() == cells.size());
  for (const auto& row : rows) {
    const auto i = static_cast<std::uint32_t>(row[0]);
    CAPTURE(i);
    CHECK(cells.volumes[i] == Approx(row[1] * unit * unit * unit).epsilon(2e-5));
    CHECK(cells.faces_of(i).size() == static_cast<std::size_t>(row[2]));
    CHECK(cells.surfaces[i] == Approx(row[3] * unit * unit).epsilon(2e-5));
    CHECK(cells.vertices_of(i).size() == static_cast<std::size_t>(row[4]));
  }
}

struct Mean {
  double value, error;
};
template <class Of>
Mean mean_over(const VoronoiCells& cells, Of value_of) {
  double first = 0, second = 0;
  const auto n = static_cast<double>(cells.size());
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    const double x = value_of(i);
    first += x / n;
    second += x * x / n;
  }
  return {first, std::sqrt((second - first * first) / n)};
}

}  // namespace

TEST_CASE("Voronoi cells are those that voro++ prints") {
  check_table(voronoi_cells(poisson_points()), "poisson4000_voro.csv", 1);
  check_table(voronoi_cells(reference_deposit()), "dep_L32_N4096_s1_voro.csv", sphere_radius);
}

TEST_CASE("Voronoi cells fill their container") {
  const Packing deposit = reference_deposit();
  double top = 0;
  for (const Vec3& r : deposit.centres) top = std::max(top, r.z);
  CHECK(sum(voronoi_cells(deposit).volumes) == Approx(16 * 16 * (top + 0.5)).epsilon(1e-10));
  CHECK(sum(voronoi_cells(deposit, 40).volumes) == Approx(16 * 16 * 40).epsilon(1e-10));
  CHECK_THROWS_AS(voronoi_cells(deposit, 10), std::invalid_argument);

  Packing walled{WalledBox{9, 7}, {}};
  Packing tube{Cylinder{6}, {}};
  RandomStream random(stream_key(64, 0, 0, Purpose::start));
  while (tube.centres.size() < 300) {
    const double x = random.uniform(), y = random.uniform(), z = 0.5 + 9 * random.uniform();
    walled.centres.push_back({0.5 + 8 * x, 0.5 + 6 * y, z});
    const Vec3 r{6 * x, 6 * y, z};
    if (std::hypot(r.x - 3, r.y - 3) < 2.5) tube.centres.push_back(r);
  }
  CHECK(sum(voronoi_cells(walled, 10).volumes) == Approx(9 * 7 * 10).epsilon(1e-10));
  walled.container = Plates{9, 7};
  CHECK(sum(voronoi_cells(walled, 10).volumes) == Approx(9 * 7 * 10).epsilon(1e-10));
  // Planes touch the tube from outside: the cells reach beyond it, a little.
  const double excess = sum(voronoi_cells(tube, 10).volumes) / (9 * 3.14159265358979 * 10);
  CHECK(excess > 1);
  CHECK(excess < 1.1);
}

TEST_CASE("Voronoi cells of random points have the exact means") {
  // Poisson cells of unit intensity: Meijering 1953; within 3 standard errors.
  const VoronoiCells cells = voronoi_cells(poisson_points());
  const auto close = [](Mean found, double exact) {
    CHECK(std::abs(found.value - exact) <= 3 * found.error);
    CHECK(found.error < 0.01 * exact);
  };
  close(mean_over(cells, [&](std::uint32_t i) { return n_faces(cells, i); }), 15.53545746435112);
  close(mean_over(cells, [&](std::uint32_t i) { return cells.vertices_of(i).size(); }),
        27.07091492870224);
  close(mean_over(cells, [&](std::uint32_t i) { return cells.surfaces[i]; }), 5.820872595052582);
}

TEST_CASE("Cells of close-packed crystals have twelve faces beyond a threshold, with any noise") {
  for (const Packing& crystal : {fcc_points(), hcp_points()}) {
    for (const double noise : {0.0, 1e-15, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-6, 1e-3}) {
      CAPTURE(noise);
      const VoronoiCells cells = voronoi_cells(with_noise(crystal, noise));
      CHECK(cells.inconsistent == 0);
      CHECK(mean_faces(cells, 1e-3) == 12);
      for (const double volume : cells.volumes) {
        CHECK(volume == Approx(0.7071067811865475).epsilon(1e-12 + 10 * noise));
      }
      if (noise >= 1e-6) CHECK(mean_faces(cells, 0) == Approx(14).margin(0.2));
    }
  }
}

TEST_CASE("Local fractions and free volumes are those of the cells") {
  const VoronoiCells cells = voronoi_cells(fcc_points());
  for (const double fraction : local_fractions(cells)) {
    CHECK(fraction == Approx(0.74048048969306).epsilon(1e-12));
  }
  for (const double free : free_volumes(cells)) {
    CHECK(free == Approx(0.3504744742356591).epsilon(1e-12));
  }
}

TEST_CASE("The cell of a lone sphere is its container") {
  const Packing lone{WalledBox{3, 4}, {{1, 2, 0.5}}};
  const VoronoiCells cells = voronoi_cells(lone);
  CHECK(cells.volumes.at(0) == Approx(12).epsilon(1e-12));
  CHECK(cells.cut.at(0) == 1);
  CHECK(cells.faces_of(0).size() == 6);
}
