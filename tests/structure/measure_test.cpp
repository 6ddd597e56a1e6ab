#include "structure/measure.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string_view>

#include "engine/bed/boundary.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/bed/slab.hpp"
#include "reference_deposit.hpp"
#include "structure/density/profiles.hpp"
#include "structure/voids/pores.hpp"
#include "structure/voids/voronoi.hpp"
#include "tests/structure/random_points.hpp"

using namespace jostle;

namespace {

constexpr StreamKey points{20'261};

const Measurement& part(const std::vector<Measurement>& all, std::string_view name) {
  const auto found = std::ranges::find(all, name, &Measurement::part);
  REQUIRE(found != all.end());
  return *found;
}

double single(const Measurement& measurement, const std::string& name) {
  const MeasuredQuantity* quantity = measurement.find(name);
  REQUIRE(quantity != nullptr);
  REQUIRE(quantity->places.empty());
  REQUIRE(quantity->values.size() == 1);
  return quantity->values[0];
}

const std::vector<double>& values_of(const Measurement& measurement, std::string_view name) {
  const MeasuredQuantity* quantity = measurement.find(name);
  REQUIRE(quantity != nullptr);
  return quantity->values;
}

std::vector<double> places(const Measurement& measurement, const std::string& name) {
  const auto found = std::ranges::find(measurement.places, name, &Places::name);
  REQUIRE(found != measurement.places.end());
  return std::get<std::vector<double>>(found->values);
}

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double value : values) total += value;
  return total;
}

/// Spheres far apart in a box without gravity, and one pair.
Packing lone_pair() {
  return {FullyPeriodicBox{4, 5, 6}, {{1, 1, 1}, {2.1, 1, 1}}};
}

/// Touching spheres on an fcc lattice that fills a fully periodic box of 4 cubic cells a side.
Packing fcc() {
  const double a = std::numbers::sqrt2;
  Packing packing{FullyPeriodicBox{4 * a, 4 * a, 4 * a}, {}};
  for (int i = 0; i < 8 * 8 * 8; ++i) {
    const int x = i % 8, y = i / 8 % 8, z = i / 64;
    if ((x + y + z) % 2 == 0) packing.centres.push_back({x * a / 2, y * a / 2, z * a / 2});
  }
  return packing;
}

/// The first points that are at least 0.7 apart, at most so many.
Packing spread(const Packing& all, std::size_t most) {
  Packing kept{all.container, {}};
  for (const Vec3& r : all.centres) {
    const bool is_free = std::ranges::none_of(kept.centres, [&](Vec3 neighbour) {
      return norm_squared(separation(Boundary(all.container), r, neighbour)) < 0.49;
    });
    if (is_free && kept.centres.size() < most) kept.centres.push_back(r);
  }
  return kept;
}

}  // namespace

TEST_CASE("Every quantity of every part has its places and is finite where it must be") {
  const std::vector<Measurement> all = measure(reference_deposit(), all_structure(), points);
  CHECK(all.size() == 13);
  for (const Measurement& measurement : all) {
    INFO(measurement.part);
    CHECK(measurement.refused.empty());
    CHECK_FALSE(measurement.quantities.empty());
    for (const MeasuredQuantity& quantity : measurement.quantities) {
      INFO(quantity.name);
      CHECK_FALSE(quantity.long_name.empty());
      std::size_t n = 1;
      if (!quantity.places.empty()) {
        const auto found = std::ranges::find(measurement.places, quantity.places, &Places::name);
        REQUIRE(found != measurement.places.end());
        n = found->size();
      }
      CHECK(quantity.values.size() == n);
      // A bin without a sphere or a wave vector, few gaps of a deposit that touches exactly, and no
      // sphere that is held where the tolerance is below its rounding.
      const bool may_lack = quantity.name.ends_with("_at_height") ||
                            quantity.name == "exponent_from_gap" || quantity.name == "s" ||
                            quantity.name == "backbone_z_of_gap" ||
                            quantity.name == "rattlers_of_gap";
      for (const double value : quantity.values) CHECK((may_lack || std::isfinite(value)));
    }
  }
}

TEST_CASE("Parts of the reference deposit agree with what its maker and voro++ measured") {
  const Packing deposit = reference_deposit();
  const nlohmann::json measured = reference_measurements();
  const std::vector<Measurement> all = measure(deposit, all_structure(), points);

  const Measurement& profile = part(all, "profile");
  double solids = sum(values_of(profile, "phi")) * 0.1 * footprint_area(deposit.container);
  CHECK(solids == Approx(4096 * std::numbers::pi / 6).epsilon(1e-12));
  CHECK(single(profile, "phi_region") == Approx(solids_fraction(deposit, {1, 10})).epsilon(1e-12));
  const Measurement& layers = part(all, "layers");
  CHECK(sum(values_of(layers, "n")) == Approx(1).epsilon(1e-12));
  CHECK(places(layers, "layer_height")[1] == Approx(0.5 + std::sqrt(2.0 / 3)).epsilon(1e-14));

  const Measurement& coordination = part(all, "coordination");
  CHECK(sum(values_of(coordination, "neighbour_share")) == Approx(1).epsilon(1e-12));
  // The first cut of the curve that is the cut of the counts.
  CHECK(values_of(coordination, "n_c_of_cut")[5] ==
        Approx(single(coordination, "n_c")).epsilon(1e-12));

  const Measurement& cells = part(all, "voronoi");
  CHECK(std::abs(single(cells, "volume_excess")) < 1e-10);
  CHECK(sum(values_of(cells, "face_share")) == Approx(1).epsilon(1e-12));
  CHECK(sum(values_of(cells, "free_volume_density")) * 0.02 +
            single(cells, "free_volume_beyond") ==
        Approx(1).epsilon(1e-12));
  CHECK(sum(values_of(cells, "local_fraction_density")) * 0.01 == Approx(1).epsilon(1e-12));
  CHECK(single(cells, "mean_free_volume") ==
        Approx(single(cells, "mean_volume") / (std::numbers::pi / 6) - 1).epsilon(1e-12));

  const Measurement& found = part(all, "pores");
  const double number = sum(values_of(found, "rho_xi")) * 0.02;
  CHECK(number == Approx(single(found, "n_pores")).epsilon(1e-3));
  const std::vector<double> xi = places(found, "xi");
  for (std::size_t k = 0; k < xi.size(); ++k) {
    const double rho_xi = values_of(found, "rho_xi")[k];
    CHECK(values_of(found, "v_rho_v")[k] == Approx(xi[k] / 3 * rho_xi).epsilon(1e-9).margin(1e-9));
  }

  const Measurement& voids = part(all, "void_probability");
  CHECK(single(voids, "phi") == Approx(solids_fraction(deposit, {1, 10})).epsilon(1e-12));
  CHECK(values_of(voids, "p0")[0] == 1);
  for (std::size_t k = 1; k <= 20; ++k) {  // eq. 8, but for spheres at the region's ends
    CHECK(values_of(voids, "p0")[k] == Approx(values_of(voids, "p0_gotoh")[k]).margin(2e-3));
  }
}

TEST_CASE("A perfect crystal is one everywhere") {
  StructureSettings settings = all_structure();
  settings.profile.reset();
  settings.sides.reset();
  settings.layers.reset();
  const std::vector<Measurement> all = measure(fcc(), settings, points);
  CHECK(single(part(all, "coordination"), "n_c") == 12);
  CHECK(single(part(all, "order"), "fcc") == 1);
  CHECK(single(part(all, "order"), "q6") == Approx(0.57452426).epsilon(1e-7));
  CHECK(single(part(all, "voronoi"), "mean_faces") == 12);
  // Cells of one size: no noise is printed as a variance, and no ratio of it.
  CHECK(single(part(all, "voronoi"), "sigma_free_volume") == 0);
  for (const double variance : values_of(part(all, "clusters"), "variance")) CHECK(variance == 0);
  for (const double ratio : values_of(part(all, "clusters"), "relative_variance")) {
    CHECK(std::isnan(ratio));
  }
  CHECK(single(part(all, "voronoi"), "mean_free_volume") ==
        Approx(3 * std::numbers::sqrt2 / std::numbers::pi - 1).epsilon(1e-9));
  // Two tetrahedral sites and one octahedral a sphere.
  CHECK(single(part(all, "pores"), "tetrahedral") == Approx(2.0 / 3).epsilon(1e-12));
  CHECK(single(part(all, "pores"), "octahedral") == Approx(1.0 / 3).epsilon(1e-12));
  CHECK(single(part(all, "void_probability"), "phi") ==
        Approx(std::numbers::pi / std::numbers::sqrt2 / 3).epsilon(1e-9));
  CHECK(single(part(all, "holes"), "unclassified") == 0);
  // Two tetrahedra and one octahedron, that is two half-octahedra, a sphere.
  CHECK(values_of(part(all, "holes"), "number_fraction")[0] == Approx(0.5).epsilon(1e-12));
  CHECK(values_of(part(all, "holes"), "number_fraction")[1] == Approx(0.5).epsilon(1e-12));
}

TEST_CASE("Parts that a container does not have are refused, and others are measured") {
  const std::vector<Measurement> all = measure(fcc(), all_structure(), points);
  CHECK(part(all, "profile").refused.find("floor") != std::string::npos);
  CHECK(part(all, "sides").refused.find("floor") != std::string::npos);
  CHECK(part(all, "layers").refused.find("floor") != std::string::npos);
  CHECK(part(all, "coordination").refused.empty());

  StructureSettings high = all_structure();
  high.region = Region{5, 5, 0};
  const std::vector<Measurement> empty = measure(reference_deposit(), high, points);
  CHECK(part(empty, "pores").refused.find("region") != std::string::npos);
  CHECK(part(empty, "layers").refused.empty());
}

TEST_CASE(
    "A region beyond a periodic box, or without a sphere, is refused by all that count in it") {
  const auto refused_everywhere = [](const Packing& packing, const Region& region) {
    StructureSettings settings = all_structure();
    settings.region = region;
    for (const Measurement& measurement : measure(packing, settings, points)) {
      INFO(measurement.part);
      const bool counts = measurement.part != "profile" && measurement.part != "sides" &&
                          measurement.part != "layers" && measurement.part != "pair_correlation";
      if (counts) CHECK(measurement.refused.find("region") != std::string::npos);
      if (!counts && has_gravity(packing.container)) CHECK(measurement.refused.empty());
    }
  };
  refused_everywhere(fcc(), {0, 26, 0});
  refused_everywhere(fcc(), {5, 8, 0});
  refused_everywhere(reference_deposit(), {50, 60, 0});
  // A region as narrow as one centre's place is counted, and soon.
  Packing walled = reference_deposit();
  walled.container = WalledBox{16, 16};
  StructureSettings narrow;
  narrow.void_probability.emplace();
  narrow.region = Region{1, 10, 7.9};
  CHECK(part(measure(walled, narrow, points), "void_probability").refused.empty());
}

TEST_CASE("A sphere far above its bed is named, not filled with bins") {
  Packing packing = reference_deposit();
  packing.centres.push_back({8, 8, 2e8});
  StructureSettings settings;
  settings.profile.emplace();
  settings.layers.emplace();
  settings.region = Region{1, 10, 0};
  for (const Measurement& measurement : measure(packing, settings, points)) {
    CHECK(measurement.refused.find("more than 409700 bins") != std::string::npos);
  }
}

TEST_CASE("Rattlers count in a region without a backbone if the packing has one") {
  const auto rattlers = [](const Packing& packing) {
    StructureSettings settings;
    settings.gaps.emplace();
    settings.region = Region{39, 41, 0};
    return part(measure(packing, settings, points), "gaps").find("rattlers")->value_at(0);
  };
  Packing bed = reference_deposit();
  bed.centres.push_back({4, 4, 40});  // it touches nothing
  CHECK(rattlers(bed) == 1);
  CHECK(std::isnan(rattlers({bed.container, {{4, 4, 40}, {9, 9, 10}}})));
}

TEST_CASE("Only what has settings is measured") {
  StructureSettings settings;
  CHECK(measure(fcc(), settings, points).empty());
  settings.order.emplace();
  const std::vector<Measurement> measurements = measure(fcc(), settings, points);
  REQUIRE(measurements.size() == 1);
  CHECK(measurements[0].part == "order");
}

TEST_CASE("Spheres inside one another are refused, as of a file in other units") {
  Packing packing = fcc();
  for (Vec3& r : packing.centres) r = 0.4 * r;
  packing.container = FullyPeriodicBox{3, 3, 3};
  CHECK_THROWS_WITH(measure(packing, all_structure(), points),
                    Catch::Matchers::Contains("must be in diameters"));
  for (Vec3& r : packing.centres) r = 100.0 * r;
  packing.container = FullyPeriodicBox{300, 300, 300};
  CHECK_THROWS_WITH(measure(packing, all_structure(), points),
                    Catch::Matchers::Contains("must be in diameters"));
}

TEST_CASE("The region follows a bed lower than Philippe and Bideau's") {
  const Region full = bulk_of(reference_deposit());
  CHECK(full == pore_region);
  Packing low{PeriodicBox{8, 8}, {}};
  for (int i = 0; i < 49; ++i) low.centres.push_back({1.1 * (i % 7), 1.1 * (i / 7), 2.5});
  CHECK(bulk_of(low) == Region{1, 4, 1});
  CHECK(bulk_of(fcc()) == Region{0, 4 * std::numbers::sqrt2, 0});
}

TEST_CASE("In a cylinder cells at the curved wall are left out and their excess is reported") {
  Packing tube{Cylinder{6}, {}};
  for (int i = 0; i < 4 * 5 * 5; ++i) {
    const Vec3 r{0.9 + 1.05 * (i % 5), 0.9 + 1.05 * (i / 5 % 5), 0.5 + 1.05 * (i / 25)};
    const double x = r.x - 3, y = r.y - 3;
    if (x * x + y * y <= 2.5 * 2.5) tube.centres.push_back(r);
  }
  StructureSettings settings;
  settings.voronoi.emplace();
  settings.sides.emplace();
  settings.sides->reach = 1;
  settings.region = Region{0.6, 3, 0.5};
  const std::vector<Measurement> all = measure(tube, settings, points);
  CHECK(single(part(all, "voronoi"), "volume_excess") > 0.001);
  CHECK(single(part(all, "voronoi"), "n_cells") < static_cast<double>(tube.centres.size()) / 2);
  const Measurement& sides = part(all, "sides");
  CHECK(sides.find("phi_radial") != nullptr);
  CHECK(sides.find("phi_x") == nullptr);
  CHECK(sides.find("lateral")->with_change);
}

TEST_CASE("Spheres without twelve others have no bond order, whatever images there are") {
  StructureSettings settings;
  settings.order.emplace();
  const Measurement few = part(measure(lone_pair(), settings, points), "order");
  CHECK(single(few, "disordered") == 1);
  for (const char* name : {"q4", "q6", "w6"}) CHECK(std::isnan(single(few, name)));
  // A crystal in a box narrower than four spheres still has its own.
  const Measurement crystal = part(measure(fcc(), settings, points), "order");
  CHECK(single(crystal, "q6") == Approx(0.57452426).epsilon(1e-7));
}

TEST_CASE("Between close sides order has a note, and ratios of few clusters have no value") {
  StructureSettings settings;
  settings.order.emplace();
  settings.clusters.emplace();
  const auto measured = [&](const Container& container) {
    const double area = footprint_area(Boundary(container), 0.5);
    const auto n = static_cast<unsigned>(area * 19 * 1.2);
    return measure(spread(random_points(container, 20, 4 * n), n), settings, points);
  };
  const std::vector<Measurement> periodic = measured(PeriodicBox{6, 6});
  CHECK(single(part(periodic, "order"), "near_sides") == 0);
  CHECK(part(periodic, "order").notes.empty());
  const double bulk = single(part(periodic, "order"), "q6");
  for (const Container& container :
       {Container{WalledBox{3.2, 3.2}}, Container{WalledBox{4, 3.5}}, Container{Cylinder{4.5}}}) {
    const std::vector<Measurement> all = measured(container);
    const Measurement& order = part(all, "order");
    CHECK(single(order, "near_sides") > 0.5);
    REQUIRE(order.notes.size() == 1);
    CHECK(order.notes[0].first == "sides");
    // The note's 7 %; 3 errors of the few spheres.
    const double spheres = single(order, "n_spheres");
    CHECK(single(order, "q6") ==
          Approx(0.965 * bulk).margin(0.035 * bulk + 0.3 / std::sqrt(spheres)));
    const Measurement& clusters = part(all, "clusters");
    if (!clusters.refused.empty()) continue;
    for (std::size_t k = 0; k < values_of(clusters, "n_clusters").size(); ++k) {
      if (values_of(clusters, "n_clusters")[k] >= 10) continue;
      CHECK(std::isnan(values_of(clusters, "relative_variance")[k]));
    }
  }
}
