#include "structure/observables.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <string>

#include "engine/bed/slab.hpp"
#include "reference_deposit.hpp"

using namespace jostle;

TEST_CASE("Observables of the reference deposit are what its maker measured") {
  const Packing deposit = reference_deposit();
  const auto reference = reference_measurements();
  REQUIRE(deposit.centres.size() == reference.at("N"));
  const double mean_z = reference.at("mean_z_over_R").get<double>() * sphere_radius;
  // The range printed with the measurements, about 8 R to (4/3) <Z>.
  const HeightWindow bulk{reference.at("zwin").at(0).get<double>() * sphere_radius,
                          reference.at("zwin").at(1).get<double>() * sphere_radius};

  const Observer observer({MeanHeight{}, BottomFraction{}, BulkFraction{.window = bulk}}, deposit);
  const std::vector<double> values = observer(deposit);
  // Margins: half a unit of the last digit printed.
  CHECK(values[0] == Approx(mean_z).margin(0.5e-4 * sphere_radius).epsilon(0));
  CHECK(values[1] == Approx(reference.at("phi_b_0_4R").get<double>()).margin(0.5e-5).epsilon(0));
  CHECK(values[2] == Approx(reference.at("phi_bulk").get<double>()).margin(0.5e-5).epsilon(0));
}

TEST_CASE("Labels name what is measured of spheres of several sizes") {
  CHECK(label(MeanHeight{}).long_name == "mean height of the sphere centres <Z>");
  CHECK(label(MeanHeight{}, Spheres::several_sizes).long_name ==
        "mean height of the sphere centres <Z>, weighted by the volumes of the spheres");
  CHECK(label(LaceyIndex{.cell = 2.5, .kind = "large"}).long_name ==
        "Lacey's mixing index of kind large on cells of 2.5 d; its random state has fixed numbers "
        "of spheres");
  CHECK(
      label(LaceyIndex{}).long_name.find("the kind of the largest mean diameter on cells of 3 d") !=
      std::string::npos);
}

TEST_CASE("The corrected fraction counts the solids of the first radius 16/11 times") {
  const Packing deposit = reference_deposit();

  SECTION("up to 26 R, as Philippe & Bideau, it makes 0.5845 of the deposit's 0.5772") {
    const CorrectedFraction up_to_26_radii{.depth = 13 / (2 * mean_height(deposit))};
    const double corrected = Observer({up_to_26_radii}, deposit)(deposit).front();
    CHECK(solids_fraction(deposit, {0, 13}) == Approx(0.5772).margin(0.5e-4).epsilon(0));
    CHECK(corrected == Approx(0.5845).margin(0.5e-4).epsilon(0));
  }
  SECTION("by default up to 0.9 x 2<Z>") {
    const double corrected = Observer({CorrectedFraction{}}, deposit)(deposit).front();
    const double top = 0.9 * 2 * mean_height(deposit);
    double solid = 0;
    for (const Vec3& centre : deposit.centres) {
      solid += 16.0 / 11 * sphere_volume_in_slab(centre.z, 0, 0.5) +
               sphere_volume_in_slab(centre.z, 0.5, top);
    }
    CHECK(corrected == Approx(solid / (16 * 16 * top)).epsilon(1e-12));
  }
  SECTION("wholly, where the window ends below the first radius") {
    const double depth = 0.25 / (2 * mean_height(deposit));
    const double corrected = Observer({CorrectedFraction{depth}}, deposit)(deposit).front();
    CHECK(corrected == Approx(16.0 / 11 * solids_fraction(deposit, {0, 0.25})).epsilon(1e-12));
  }
}

TEST_CASE("Quantile windows are those of the starting packing and stay for the run") {
  const Packing start = reference_deposit();
  const std::vector<Observable> observables = {
      MeanHeight{}, BulkFraction{}, BulkFraction{.name = "middle", .window = HeightWindow{3, 9}}};
  const Observer observer(observables, start);
  REQUIRE(observer.windows().size() == 3);
  CHECK(observer.windows()[0] == HeightWindow{0, 0});
  CHECK(observer.windows()[1] == resolve(QuantileWindow{0.2, 0.8}, start));
  CHECK(observer.windows()[2] == HeightWindow{3, 9});

  Packing lifted = start;
  for (Vec3& centre : lifted.centres) centre.z += 1;
  const std::vector<double> values = observer(lifted);
  CHECK(values[1] == solids_fraction(lifted, observer.windows()[1]));
  CHECK(values[2] == solids_fraction(lifted, {3, 9}));

  const Observer tapered({BulkFraction{.taper = 0.8165}}, start);
  CHECK(tapered(lifted)[0] == tapered_solids_fraction(lifted, observer.windows()[1], 0.8165));

  const Observer resumed(observables, observer.windows());
  CHECK(resumed(lifted) == values);
}

TEST_CASE("Labels name every observable, with its units and source") {
  const std::vector<Observable> observables = {MeanHeight{}, BottomFraction{}, CorrectedFraction{},
                                               BulkFraction{}, BulkFraction{.name = "deep"}};
  std::set<std::string> names;
  for (const Observable& observable : observables) {
    const Column text = label(observable);
    names.insert(text.name);
    CHECK(text.units == (std::holds_alternative<MeanHeight>(observable) ? "diameter" : "1"));
    CHECK_FALSE(text.long_name.empty());
    CHECK_FALSE(text.source.empty());
  }
  CHECK(names == std::set<std::string>{"mean_height", "bottom_fraction", "corrected_fraction",
                                       "bulk_fraction", "deep"});
}
