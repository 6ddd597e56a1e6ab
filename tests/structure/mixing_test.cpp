#include "structure/mixing.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "engine/bed/random.hpp"
#include "structure/observables.hpp"
#include "structure/snapshot_statistics.hpp"

using namespace jostle;

namespace {

/// n spheres on a lattice in a box of 6 x 6, `upper` selects those of kind 1 by height.
Packing layered(std::uint32_t n_layers, const std::function<std::uint32_t(std::size_t)>& kind_of,
                double large = 1) {
  Packing packing{PeriodicBox{6, 6}, {}};
  std::vector<double> diameters;
  std::vector<std::uint32_t> kinds;
  for (std::uint32_t layer = 0; layer < n_layers; ++layer) {
    for (int x = 0; x < 6; ++x) {
      for (int y = 0; y < 6; ++y) {
        const std::uint32_t kind = kind_of(packing.centres.size());
        packing.centres.push_back({x + 0.5, y + 0.5, layer + 0.5});
        kinds.push_back(kind);
        diameters.push_back(kind == 1 ? large : 1);
      }
    }
  }
  packing.sizes = std::make_shared<const Sizes>(
      diameters, kinds, std::vector<SphereKind>{{"small", 1}, {"large", 1}});
  return packing;
}

double observed(const Packing& packing, const Observable& observable) {
  return Observer({observable}, packing)(packing).at(0);
}

}  // namespace

TEST_CASE("kinds apart: S is 1 or -1 and Lacey's index 0") {
  const std::size_t n = 12 * 36;
  const Packing upward = layered(12, [&](std::size_t i) { return i < n / 2 ? 0u : 1u; });
  const Packing downward = layered(12, [&](std::size_t i) { return i < n / 2 ? 1u : 0u; });
  CHECK(segregation(upward, 1, 0) == Approx(1).epsilon(1e-12));
  CHECK(segregation(downward, 1, 0) == Approx(-1).epsilon(1e-12));
  CHECK(kind_height(upward, 0) == Approx(3));
  CHECK(kind_height(upward, 1) == Approx(9));
  CHECK(lacey_index(upward, 1, 2) == Approx(0).margin(1e-12));
  CHECK(lacey_index(upward, 0, 2) == Approx(0).margin(1e-12));
}

TEST_CASE("kinds side by side are apart for Lacey's index and not for S") {
  const Packing sides = layered(12, [](std::size_t i) { return i / 6 % 6 < 3 ? 0u : 1u; });
  CHECK(segregation(sides, 1, 0) == Approx(0).margin(1e-12));
  CHECK(lacey_index(sides, 1, 3) == Approx(0).margin(1e-12));
  CHECK(lacey_index(sides, 1, 6) > 0.9);  // a cell as wide as the box sees both
}

TEST_CASE("beds labelled at random have Lacey's index 1 and S 0 on average") {
  RandomStream random(stream_key(21, 0, 0, Purpose::start));
  const std::size_t n = 12 * 36, n_large = 100;
  std::vector<std::uint32_t> labels(n, 0);
  std::fill_n(labels.begin(), n_large, 1u);
  for (const double cell : {1.5, 2.0, 3.0}) {
    double index = 0, squared = 0, s = 0;
    constexpr int beds = 400;
    for (int bed = 0; bed < beds; ++bed) {
      for (std::size_t left = n; left > 1; --left)
        std::swap(labels[left - 1], labels[random.integer_below(left)]);
      const Packing packing = layered(12, [&](std::size_t i) { return labels[i]; });
      const double lacey = lacey_index(packing, 1, cell);
      index += lacey / beds;
      squared += lacey * lacey / beds;
      s += segregation(packing, 1, 0) / beds;
    }
    // Four standard errors.
    CHECK(std::abs(index - 1) < 4 * std::sqrt((squared - index * index) / beds));
    const double error = 2 * std::sqrt(11.9 / n_large / (1 - 1.0 * n_large / n)) / 12;
    CHECK(std::abs(s) < 4 * error / std::sqrt(double{beds}));
  }
}

TEST_CASE("heights of kinds are weighted by volume and average to <Z>") {
  Packing packing{PeriodicBox{9, 9}, {{1, 1, 1}, {4, 4, 3}, {7, 7, 5}}};
  packing.sizes = std::make_shared<const Sizes>(std::vector<double>{2, 1, 1},
                                                std::vector<std::uint32_t>{0, 0, 1},
                                                std::vector<SphereKind>{{"a", 1}, {"b", 9}});
  CHECK(kind_height(packing, 0) == Approx((8 * 1 + 3) / 9.0));
  CHECK(kind_height(packing, 1) == 5);
  CHECK((9 * kind_height(packing, 0) + kind_height(packing, 1)) / 10 ==
        Approx(mean_height(packing)));
  CHECK(segregation(packing, 1, 0) == Approx(2 * (5 - 11 / 9.0) / (2 * mean_height(packing))));
}

TEST_CASE("observables of kinds are found by names, or by mean diameters") {
  const Packing packing = layered(
      4, [](std::size_t i) { return i < 72 ? 0u : 1u; }, 1.5);
  CHECK(largest_kind(*packing.sizes) == 1);
  CHECK(smallest_kind(*packing.sizes) == 0);
  CHECK(observed(packing, KindHeight{"large"}) == kind_height(packing, 1));
  CHECK(observed(packing, Segregation{}) == segregation(packing, 1, 0));
  CHECK(observed(packing, Segregation{"small", "large"}) == segregation(packing, 0, 1));
  CHECK(observed(packing, LaceyIndex{2, std::nullopt}) == lacey_index(packing, 1, 2));
  CHECK(label(KindHeight{"large"}).name == "height_large");
  CHECK(label(LaceyIndex{2, "small"}).name == "lacey_index_small");
  CHECK(label(Segregation{}).name == "segregation");
  CHECK(observed(packing, MeanHeight{}) == mean_height(packing));
}

TEST_CASE("kinds that an observable leaves open are those of the laws, in every bed") {
  const std::vector<MixtureKind> kinds = {{"middle", 5, NormalDiameter{1, 0.3}},
                                          {"a", 5, LognormalDiameter{1.1, 0.3}},
                                          {"b", 5, UniformDiameter{0.8, 1.4}},
                                          {"c", 5, FixedDiameter{0.9}},
                                          {"d", 5, ListedDiameters{{0.8, 1}}}};
  const std::vector<Observable> chosen = with_kinds(
      {Segregation{}, Segregation{"middle", std::nullopt}, LaceyIndex{}, MeanHeight{}}, kinds);
  CHECK(chosen == std::vector<Observable>{Segregation{"a", "d"}, Segregation{"middle", "d"},
                                          LaceyIndex{.kind = "a"}, MeanHeight{}});
  CHECK(with_kinds({Segregation{}}, {}) == std::vector<Observable>{Segregation{}});
}

TEST_CASE("two kinds of one mean diameter are two kinds") {
  const Packing packing = layered(4, [](std::size_t i) { return i < 72 ? 0u : 1u; });
  CHECK(largest_kind(*packing.sizes) == 0);
  CHECK(smallest_kind(*packing.sizes) == 1);
  CHECK(observed(packing, Segregation{}) == Approx(-1));
}

TEST_CASE("observables of equal spheres reject mixtures by name, and the other way round") {
  const Packing mixture = layered(
      4, [](std::size_t i) { return i < 72 ? 0u : 1u; }, 1.5);
  Packing equal = mixture;
  equal.sizes = nullptr;
  for (const Observable& observable :
       {Observable{CorrectedFraction{}}, Observable{CrystallineFraction{}},
        Observable{GrownLayers{}}, Observable{OrderedHeight{}}}) {
    CHECK_THROWS_WITH(
        observed(mixture, observable),
        Catch::Matchers::StartsWith(label(observable).name + " is defined for equal"));
    CHECK_NOTHROW(observed(equal, observable));
  }
  for (const Observable& observable :
       {Observable{KindHeight{"large"}}, Observable{Segregation{}}, Observable{LaceyIndex{}}}) {
    CHECK_THROWS_WITH(observed(equal, observable),
                      Catch::Matchers::Contains("is measured of kinds of spheres"));
    CHECK_NOTHROW(observed(mixture, observable));
  }
  CHECK_THROWS_WITH(observed(mixture, KindHeight{"huge"}),
                    Catch::Matchers::Contains("no kind of spheres is named \"huge\""));
}

TEST_CASE("coordination of a mixture is counted at the sum of two radii") {
  Packing packing{PeriodicBox{9, 9}, {{1, 1, 1}, {2.5, 1, 1}, {3.52, 1, 1}}};
  packing.sizes = std::make_shared<const Sizes>(std::vector<double>{2, 1, 1});
  CHECK(coordination_numbers(packing, 1.0) == std::vector<unsigned>{1, 1, 0});
  CHECK(coordination_numbers(packing, 1.05) == std::vector<unsigned>{1, 2, 1});
}
