#include "structure/order/crystal_order.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/structure/order/close_packings.hpp"
#include "tests/structure/random_points.hpp"
#include "tests/structure/reference_deposit.hpp"
#include "tests/structure/voids/voronoi_points.hpp"

using namespace jostle;

namespace {

constexpr std::size_t layer_size = 144;

std::size_t count(const std::vector<CrystalOrder>& orders, CrystalOrder order) {
  return static_cast<std::size_t>(std::count(orders.begin(), orders.end(), order));
}

// Order of each layer of a stacking: equal neighbours above and below make hcp, different ones fcc;
// the ends are undefined.
std::vector<CrystalOrder> expected_layers(const std::string& stacking) {
  std::vector<CrystalOrder> layers(stacking.size(), CrystalOrder::disordered);
  for (std::size_t k = 1; k + 1 < stacking.size(); ++k) {
    layers[k] = stacking[k - 1] == stacking[k + 1] ? CrystalOrder::hcp : CrystalOrder::fcc;
  }
  return layers;
}

}  // namespace

TEST_CASE("Perfect and noisy crystals are recognised, every sphere") {
  const double noise = GENERATE(0, 1e-13, 1e-6, 1e-3, 1e-2);
  CAPTURE(noise);
  const Packing cubic = shaken(fcc_points(), noise), hexagonal = shaken(hcp_points(), noise);
  CHECK(count(crystal_order(cubic), CrystalOrder::fcc) == cubic.centres.size());
  CHECK(count(crystal_order(hexagonal), CrystalOrder::hcp) == hexagonal.centres.size());
}

TEST_CASE("A crystal at any density is one") {
  // The cut follows the distance of neighbours: spheres need not touch.
  Packing loose = hcp_points();
  const auto box = std::get<FullyPeriodicBox>(loose.container);
  loose.container = FullyPeriodicBox{1.1 * box.width_x, 1.1 * box.width_y, 1.1 * box.height};
  for (Vec3& r : loose.centres) r = 1.1 * r;
  CHECK(count(crystal_order(loose), CrystalOrder::hcp) == loose.centres.size());
}

TEST_CASE("In a mixed stacking every layer is what its neighbours make it") {
  const std::string stacking = GENERATE(as<std::string>{}, "ABABABABCABCABC", "ABCBABCACB", "ABC");
  const double noise = GENERATE(0, 1e-2);
  CAPTURE(stacking, noise);
  const Packing packing = shaken(stacked_layers(stacking), noise);
  const std::vector<CrystalOrder> orders = crystal_order(packing);
  const std::vector<CrystalOrder> layers = expected_layers(stacking);
  for (std::size_t i = 0; i < orders.size(); ++i) CHECK(orders[i] == layers[i / layer_size]);
}

TEST_CASE("A poured bed and points at random are disordered") {
  // By definition no lattice: fewer than one sphere in a hundred may look like one by chance.
  const Packing deposit = reference_deposit();
  CHECK(count(crystal_order(deposit), CrystalOrder::disordered) > 0.99 * 4096);
  const Packing points = random_points(FullyPeriodicBox{10, 10, 10}, 10, 1000);
  CHECK(count(crystal_order(points), CrystalOrder::disordered) > 990);
}

TEST_CASE("An icosahedron, bcc and too few neighbours are disordered") {
  Packing bcc{FullyPeriodicBox{4, 4, 4}, {}};
  for (int k = 0; k < 64; ++k) {
    const Vec3 corner{1.0 * (k % 4), 1.0 * (k / 4 % 4), 1.0 * (k / 16)};
    bcc.centres.push_back(corner);
    bcc.centres.push_back(corner + Vec3{0.5, 0.5, 0.5});
  }
  CHECK(count(crystal_order(bcc), CrystalOrder::disordered) == 128);

  const Packing few{WalledBox{9, 9}, {{1, 1, 1}, {2, 1, 1}, {3, 1, 1}}};
  CHECK(count(crystal_order(few), CrystalOrder::disordered) == 3);
  CHECK(crystal_order(Packing{WalledBox{9, 9}, {}}).empty());
}
