#include "structure/order/bond_order.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/structure/order/close_packings.hpp"
#include "tests/structure/random_points.hpp"
#include "tests/structure/voids/voronoi_points.hpp"

using namespace jostle;

namespace {

// A sphere and those around it, far from any wall: the bonds of sphere 0.
BondOrder order_of(const std::vector<Vec3>& neighbours) {
  Packing packing{WalledBox{40, 40}, {{20, 20, 20}}};
  for (const Vec3& way : neighbours)
    packing.centres.push_back({20 + way.x, 20 + way.y, 20 + way.z});
  return bond_order(nearest_neighbours(packing, static_cast<std::uint32_t>(neighbours.size())))[0];
}

std::vector<Vec3> icosahedron() {
  const double g = std::numbers::phi;
  std::vector<Vec3> corners;
  for (const double a : {-0.5, 0.5}) {
    for (const double b : {-0.5 * g, 0.5 * g}) {
      corners.insert(corners.end(), {{0, a, b}, {a, b, 0}, {b, 0, a}});
    }
  }
  return corners;
}

std::vector<Vec3> bcc_neighbours() {
  std::vector<Vec3> neighbours;
  for (const double a : {-0.6, 0.6}) {
    neighbours.insert(neighbours.end(), {{2 * a, 0, 0}, {0, 2 * a, 0}, {0, 0, 2 * a}});
    for (const double b : {-0.6, 0.6}) {
      for (const double c : {-0.6, 0.6}) neighbours.push_back({a, b, c});
    }
  }
  return neighbours;
}

Vec3 turned(Vec3 r) {
  // About (1, 2, 2) / 3 by the angle of cosine 0.28 and sine 0.96.
  const Vec3 axis{1.0 / 3, 2.0 / 3, 2.0 / 3};
  return 0.28 * r + 0.96 * cross(axis, r) + (0.72 * dot(axis, r)) * axis;
}

std::vector<Vec3> turned(std::vector<Vec3> all) {
  for (Vec3& r : all) r = turned(r);
  return all;
}

double legendre(int l, double x) {
  const double x2 = x * x;
  return l == 4 ? ((35 * x2 - 30) * x2 + 3) / 8 : (((231 * x2 - 315) * x2 + 105) * x2 - 5) / 16;
}

// q_l of l = 4 or 6 from the angles between bonds alone: by the addition theorem its square is the
// mean of P_l(cos) over all pairs of bonds.
double steinhardt(std::span<const Neighbour> neighbours, int l) {
  double sum = 0;
  for (const Neighbour& first : neighbours) {
    for (const Neighbour& second : neighbours) {
      const double lengths = std::sqrt(norm_squared(first.way) * norm_squared(second.way));
      sum += legendre(l, dot(first.way, second.way) / lengths);
    }
  }
  return std::sqrt(sum) / static_cast<double>(neighbours.size());
}

void check(const BondOrder& order, const BondOrder& expected) {
  CHECK(order.q4 == Approx(expected.q4).margin(1e-12).epsilon(0));
  CHECK(order.q6 == Approx(expected.q6).margin(1e-12).epsilon(0));
  CHECK(order.w4 == Approx(expected.w4).margin(1e-11).epsilon(0));
  CHECK(order.w6 == Approx(expected.w6).margin(1e-11).epsilon(0));
}

// From sums over the bonds with scipy's spherical harmonics and sympy's exact 3j symbols. In closed
// form: fcc q4 = sqrt(7 / 192), q6 = sqrt(169 / 512); hcp q4 = 7 / 72; icosahedron q6 = sqrt(11) /
// 5, w6 = -11 / sqrt(4199).
const BondOrder fcc{0.190940653956493, 0.574524259714070, -0.159317373133081, -0.013160600730647};
const BondOrder hcp{0.097222222222222, 0.484761685223683, 0.134097046880302, -0.012441959464886};
const BondOrder bcc{0.036369648372665, 0.510688230856951, 0.159317373133081, 0.013160600730647};
const BondOrder icosahedral{0, 0.663324958071080, 0, -0.169753894958368};

}  // namespace

TEST_CASE("Perfect crystals and the icosahedron have their bond order, however turned") {
  check(fcc, {std::sqrt(7.0 / 192), std::sqrt(169.0 / 512), fcc.w4, fcc.w6});
  check(icosahedral, {0, std::sqrt(11.0) / 5, 0, -11 / std::sqrt(4199.0)});
  check(order_of(icosahedron()), icosahedral);
  check(order_of(turned(icosahedron())), icosahedral);
  check(order_of(bcc_neighbours()), bcc);
  check(order_of(turned(bcc_neighbours())), bcc);

  const Packing cubic = fcc_points(), hexagonal = hcp_points();
  for (const BondOrder& order : bond_order(nearest_neighbours(cubic))) check(order, fcc);
  for (const BondOrder& order : bond_order(neighbours_within(cubic, 1.2))) check(order, fcc);
  for (const BondOrder& order : bond_order(nearest_neighbours(hexagonal))) check(order, hcp);
  // Cubic layers seen along the threefold axis; those at the floor and the top have too few
  // neighbours.
  const Packing layers = stacked_layers("ABCABC");
  const std::vector<BondOrder> orders = bond_order(nearest_neighbours(layers));
  for (std::size_t i = 144; i < 5 * 144; ++i) check(orders[i], fcc);
}

TEST_CASE("q4 and q6 of any packing are those of the angles between its bonds") {
  const Packing packing = random_points(PeriodicBox{6, 7}, 8, 300);
  for (const NeighbourTable& table :
       {nearest_neighbours(packing, 12), neighbours_within(packing, 1.3)}) {
    const std::vector<BondOrder> orders = bond_order(table);
    REQUIRE(orders.size() == 300);
    for (std::size_t i = 0; i < table.size(); ++i) {
      if (table.neighbours_of(i).empty()) {
        CHECK(std::isnan(orders[i].q6));
        CHECK(std::isnan(orders[i].w6));
        continue;
      }
      CHECK(orders[i].q4 == Approx(steinhardt(table.neighbours_of(i), 4)).margin(1e-10).epsilon(0));
      CHECK(orders[i].q6 == Approx(steinhardt(table.neighbours_of(i), 6)).margin(1e-10).epsilon(0));
    }
  }
}

TEST_CASE("Bond order does not depend on how a packing is turned") {
  Packing packing = random_points(WalledBox{9, 9}, 9, 250);
  const std::vector<BondOrder> order_before = bond_order(nearest_neighbours(packing));
  packing.container = WalledBox{60, 60};
  for (Vec3& r : packing.centres) r = turned(r) + Vec3{30, 30, 30};
  const std::vector<BondOrder> order_after = bond_order(nearest_neighbours(packing));
  for (std::size_t i = 0; i < order_before.size(); ++i) check(order_after[i], order_before[i]);
}

TEST_CASE("A single bond has q 1, and as w the 3j symbol of three zeros") {
  // Along z only q_l0 is there: w_l = (l l l; 0 0 0), whose squares are 18 / 1001 and 400 / 46189.
  const BondOrder single = order_of({{0.6, 0, 0.8}}), two = order_of({{0, 0, 1}, {0, 0, -1}});
  const BondOrder expected{1, 1, std::sqrt(18.0 / 1001), -std::sqrt(400.0 / 46189)};
  check(single, expected);
  check(two, expected);
}
