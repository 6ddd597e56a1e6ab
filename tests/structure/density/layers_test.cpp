#include "structure/density/layers.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "engine/bed/boundary.hpp"
#include "structure/snapshot_statistics.hpp"
#include "tests/structure/density/profile_samples.hpp"
#include "tests/structure/reference_deposit.hpp"

using namespace jostle;

namespace {

const double row = std::sqrt(3.0) / 2;

Packing crystal(const Container& container, std::uint32_t n, Lattice lattice = Lattice::hcp) {
  RandomStream random(stream_key(71, 0, 0, Purpose::start));
  return make_start(Crystal{.lattice = lattice}, container, n, random);
}

// Close-packed layers in the order ABC: fcc along (111), 12 x 14 spheres a layer.
Packing fcc_along_111(int n_layers) {
  Packing packing{PeriodicBox{12, 14 * row}, {}};
  for (int layer = 0; layer < n_layers; ++layer) {
    for (int j = 0; j < 14; ++j) {
      for (int i = 0; i < 12; ++i) {
        const double shift = layer % 3;
        packing.centres.push_back({std::fmod(i + 0.5 * (j % 2) + 0.5 * shift, 12.0),
                                   std::fmod((j + shift / 3) * row, 14 * row),
                                   0.5 + layer * std::sqrt(2.0 / 3)});
      }
    }
  }
  return packing;
}

// Every height displaced evenly by up to `amplitude`.
Packing shaken(Packing packing, double amplitude) {
  RandomStream random(stream_key(72, 0, 0, Purpose::resampling));
  for (Vec3& centre : packing.centres) centre.z += amplitude * (2 * random.uniform() - 1);
  return packing;
}

const PeriodicBox commensurate{12, 14 * row};

}  // namespace

TEST_CASE("A sphere far above its bed adds no layer that has grown, and takes no memory") {
  Packing packing = crystal(commensurate, 168 * 8);
  packing.centres.push_back({1, 1, 1e17});
  CHECK(grown_layers(packing) == 8);
  CHECK(layers(packing, LayerRule{}.tolerance, 10).size() == 10);
}

TEST_CASE("All full layers of a close-packed crystal have grown") {
  CHECK(grown_layers(crystal(commensurate, 168 * 8)) == 8);
  CHECK(grown_layers(fcc_along_111(9)) == 9);
  // A partial layer on top does not count: the crystal of Rosato et al. has 20.57.
  CHECK(grown_layers(crystal(commensurate, 3456)) == 20);
  CHECK(layers(crystal(commensurate, 3456)).size() == 21);
  // Between walls layers are full when no more spheres fit.
  for (const double width : {5.0, 9.3, 16.0}) {
    CAPTURE(width);
    for (const Container& container : {Container{WalledBox{width, width}}, {Cylinder{width}}}) {
      const Packing packing = crystal(container, 2000);
      const std::vector<Layer> all = layers(packing);
      const std::size_t grown = grown_layers(packing);
      CHECK(grown + 1 >= all.size());
      CHECK(grown <= all.size());
    }
  }
}

TEST_CASE("Layers of a crystal lie at the heights of hcp and are full") {
  const Packing packing = crystal(commensurate, 168 * 5);
  const std::vector<Layer> all = layers(packing);
  REQUIRE(all.size() == 5);
  for (std::size_t k = 0; k < 5; ++k) {
    CHECK(all[k].height == hcp_layer_height(k));
    CHECK(all[k].height == Approx(packing.centres[168 * k].z).epsilon(1e-14));
    CHECK(all[k].filling == Approx(1).epsilon(1e-12));
    CHECK(all[k].share == 1);
  }
  // n(z) is 1/5 in the five bins that hold a layer.
  const std::vector<double> n = height_histogram(packing);
  for (std::size_t k = 0; k < 5; ++k) {
    CHECK(n[static_cast<std::size_t>(hcp_layer_height(k) / 0.1)] == Approx(0.2).epsilon(1e-14));
  }
}

namespace {

// Places of a triangular lattice of spacing 1 in a footprint that centres can reach, the most over
// 60 x 60 places of its corner: by brute force.
std::size_t most_places(const Container& container, bool rows_along_y) {
  const Boundary boundary(container);
  std::size_t most = 0;
  for (int a = 0; a < 60; ++a) {
    for (int b = 0; b < 60; ++b) {
      std::size_t places = 0;
      for (int j = -14; j < 14; ++j) {
        for (int i = -14; i < 14; ++i) {
          const double longitudinal = boundary.axis() + i + 0.5 * (j % 2 != 0) + a / 60.0;
          const double across = boundary.axis() + row * (j + 2 * b / 60.0);
          const Vec3 place =
              rows_along_y ? Vec3{across, longitudinal, 0.5} : Vec3{longitudinal, across, 0.5};
          places += boundary_depth(boundary, place) <= 1e-9;
        }
      }
      most = std::max(most, places);
    }
  }
  return most;
}

}  // namespace

TEST_CASE("A full layer between walls and in a tube has the filling 1") {
  for (const Container& container : {Container{WalledBox{5, 5}},
                                     {WalledBox{7, 7}},
                                     {WalledBox{4.3, 7.9}},
                                     {WalledBox{9.3, 6.5}},
                                     {WalledBox{1, 6}},
                                     {Cylinder{1}},
                                     {Cylinder{3}},
                                     {Cylinder{5}},
                                     {Cylinder{5.6}},
                                     {Cylinder{9.3}}}) {
    const auto filling = static_cast<double>(layers({container, {{0.5, 0.5, 0.5}}})[0].filling);
    CAPTURE(width_x(container), width_y(container));
    CHECK(1 / filling ==
          Approx(std::max(most_places(container, false), most_places(container, true)))
              .epsilon(1e-9));
  }
  // Between plates a row along them closes over the period: one row, three of them, and five rows
  // of 6 after which rows across the gap hold 5 and 4 by turns.
  const auto places = [](double gap) {
    return 1 / static_cast<double>(layers({Plates{6, gap}, {{0.5, 0.5, 0.5}}})[0].filling);
  };
  CHECK(places(1) == Approx(6));
  CHECK(places(1 + std::sqrt(3.0) + 0.001) == Approx(18));
  CHECK(places(5) == Approx(4.5 * 6 * 2 / std::sqrt(3.0)));
  // The layers of crystals: a lattice with a row along x, and the next in its holes.
  for (const double width : {5.0, 7.0, 9.3, 16.0}) {
    const Packing between_walls = crystal(WalledBox{width, width}, 2000);
    const std::vector<Layer> all = layers(between_walls);
    CHECK(all[0].filling == Approx(1).epsilon(1e-12));
    CHECK(all[1].filling > 0.8);
    for (const Layer& layer : all) CHECK(layer.filling < 1 + 1e-12);
    for (const Layer& layer : layers(crystal(Cylinder{width}, 2000))) {
      CHECK(layer.filling < 1 + 1e-12);
    }
  }
}

TEST_CASE("Layers that lie a little closer than those of hcp are followed to the top") {
  Packing packing = crystal(commensurate, 168 * 15);
  for (Vec3& centre : packing.centres) centre.z = 0.5 + 0.97 * (centre.z - 0.5);
  CHECK(grown_layers(packing) == 15);
  CHECK(grown_layers(shaken(packing, 0.08)) == 15);
  const std::vector<Layer> all = layers(packing);
  CHECK(all[14].found == Approx(0.5 + 0.97 * 14 * std::sqrt(2.0 / 3)).epsilon(1e-12));
  CHECK(all[14].height == hcp_layer_height(14));
}

TEST_CASE("Layers of another spacing are none after the floor's") {
  CHECK(grown_layers(crystal(PeriodicBox{12, 12}, 144 * 6, Lattice::fcc)) == 1);
}

TEST_CASE("A pour has grown no layers but at most the floor's") {
  CHECK(grown_layers(reference_deposit()) <= 1);
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    CHECK(grown_layers(poured(PeriodicBox{10, 10}, 800, seed)) <= 1);
    CHECK(grown_layers(poured(WalledBox{10, 10}, 700, seed)) <= 1);
    CHECK(grown_layers(poured(Cylinder{10}, 600, seed)) <= 1);
  }
}

TEST_CASE("Layers are counted from the floor up to the first that is disordered") {
  Packing packing = crystal(commensurate, 168 * 10);
  for (const double amplitude : {1e-9, 0.05, 0.1}) {
    CHECK(grown_layers(shaken(packing, amplitude)) == 10);
  }
  // Spread evenly over +- 0.3, a third lies within 0.1.
  CHECK(grown_layers(shaken(packing, 0.3)) == 0);
  // Spread evenly over +- 0.125, four fifths do: what counts is the share asked for.
  CHECK(grown_layers(shaken(packing, 0.125)) == 10);
  CHECK(grown_layers(shaken(packing, 0.125), {.least_share = 0.95}) == 0);
  CHECK(grown_layers(shaken(packing, 0.3), {.tolerance = 0.31}) == 10);

  SECTION("even if there are more above") {
    for (std::size_t i = 168 * 4; i < 168 * 5; ++i) {
      packing.centres[i].z += 0.0047 * static_cast<double>(i - 168 * 4) - 0.4;
    }
    const std::vector<Layer> all = layers(packing);
    CHECK(all[4].share < 0.3);
    CHECK(all[5].share > 0.9);
    CHECK(grown_layers(packing) == 4);
  }
  SECTION("or that is not full") {
    // Take every second sphere of layer 6 out.
    for (std::size_t i = 168 * 6; i < 168 * 7; i += 2) packing.centres[i].z = 20;
    CHECK(grown_layers(packing) == 6);
    CHECK(grown_layers(packing, {.least_filling = 0.4}) == 10);
  }
}

TEST_CASE("Without a floor or spheres there are no layers") {
  CHECK_THROWS_AS(layers({FullyPeriodicBox{4, 4, 4}, {{1, 1, 1}}}), std::invalid_argument);
  CHECK(grown_layers({PeriodicBox{4, 4}, {}}) == 0);
}
