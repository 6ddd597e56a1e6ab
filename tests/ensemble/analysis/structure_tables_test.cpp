#include "ensemble/analysis/structure_tables.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string_view>

#include "fitting/models/models.hpp"
#include "structure/density/gradient.hpp"

namespace jostle {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const Quantity& quantity(const Table& table, std::string_view name) {
  for (const Quantity& quantity : table.quantities) {
    if (quantity.name == name) return quantity;
  }
  FAIL("no " << name);
  return table.quantities.front();
}

const std::vector<double>& numbers(const Table& table, std::string_view name) {
  return std::get<std::vector<double>>(quantity(table, name).values);
}

/// Heights of 1, 2, .. and a value at each, and one single value.
Measurement measurement(const std::vector<double>& places, double value) {
  Measurement measurement{.part = "layers"};
  std::vector<double> heights;
  for (std::size_t k = 0; k < places.size(); ++k) heights.push_back(static_cast<double>(k + 1));
  measurement.places = {{"height", heights, "diameter", "height"}};
  measurement.quantities = {
      {.name = "n", .places = "height", .values = places, .long_name = "ends in nothing"},
      {.name = "share",
       .places = "height",
       .values = places,
       .long_name = "ends in no value",
       .beyond = nan},
      {.name = "lateral", .values = {value}, .long_name = "one value", .with_change = true}};
  return measurement;
}

/// Realizations whose curve of `part` is `curve` times 1 + 0.01 (r - 1), r = 0, 1, 2.
EnsembleStructure three_curves(const char* part, const char* places, const char* name,
                               const std::vector<double>& abscissae,
                               const std::vector<double>& curve, const char* counted = nullptr,
                               double number = 0, double spread = 0.01) {
  EnsembleStructure structure{.taps = {0}, .packings = {{}}};
  for (int r = 0; r < 3; ++r) {
    Measurement measurement{.part = part};
    measurement.places = {{places, abscissae, "1", "places"}};
    std::vector<double> values = curve;
    for (double& value : values) value *= 1 + spread * (r - 1);
    measurement.quantities = {
        {.name = name, .places = places, .values = values, .long_name = "a curve"}};
    if (counted != nullptr) measurement.quantities.push_back({.name = counted, .values = {number}});
    structure.packings[0].push_back({measurement});
  }
  return structure;
}

}  // namespace

TEST_CASE("A mean counts its packings if some may have no value") {
  EnsembleStructure structure{.taps = {0, 10}, .packings = {}};
  const auto measurement_with = [](double value) {
    Measurement measurement{.part = "gaps"};
    measurement.quantities = {{.name = "z", .values = {value}, .with_packings = true},
                              {.name = "rattlers", .values = {1}}};
    return std::vector{measurement};
  };
  structure.packings = {{measurement_with(6), measurement_with(nan), measurement_with(7)},
                        {measurement_with(nan), measurement_with(nan), {}}};
  const Table table = structure_tables("", structure, {}).at(0);
  CHECK(numbers(table, "z")[0] == 6.5);
  CHECK(std::isnan(numbers(table, "z")[1]));
  CHECK(std::get<std::vector<std::uint64_t>>(quantity(table, "z_packings").values) ==
        std::vector<std::uint64_t>{2, 0});
  CHECK(std::get<std::vector<std::uint64_t>>(quantity(table, "realizations").values) ==
        std::vector<std::uint64_t>{3, 2});
  for (const Quantity& quantity : table.quantities) CHECK(quantity.name != "rattlers_packings");
}

TEST_CASE("Pairs of packings are pooled: a ratio of sums, with the jackknife over packings") {
  // Found and expected pairs of a bin; one packing expects none.
  const std::vector<std::pair<double, double>> pairs = {{3, 2}, {0, 0}, {40, 50}, {11, 8}};
  EnsembleStructure structure{.taps = {0}, .packings = {{}}};
  for (const auto& [found, expected] : pairs) {
    Measurement measurement{.part = "pair_correlation"};
    measurement.places = {{"r", std::vector<double>{0.5}, "diameter", "distance"}};
    measurement.quantities = {
        {.name = "g",
         .places = "r",
         .values = {found / expected},
         .pooling = Pooling::weighted,
         .weights = {expected},
         .beyond = nan},
        {.name = "centres", .values = {expected}, .pooling = Pooling::sum},
        {.name = "packings", .values = {expected > 0 ? 1.0 : 0.0}, .pooling = Pooling::sum}};
    structure.packings[0].push_back({measurement});
  }
  const Table table = structure_tables("", structure, {}).at(0);
  CHECK(numbers(table, "g")[0] == Approx(54.0 / 60));
  CHECK(numbers(table, "centres")[0] == 60);
  CHECK(numbers(table, "packings")[0] == 3);
  const double expected[] = {51.0 / 58, 14.0 / 10, 43.0 / 52};
  const double mean = (expected[0] + expected[1] + expected[2]) / 3;
  double squares = 0;
  for (const double g : expected) squares += (g - mean) * (g - mean);
  CHECK(numbers(table, "g_error")[0] == Approx(std::sqrt(squares * 2 / 3)));
  for (const Quantity& quantity : table.quantities) CHECK(quantity.name != "centres_error");
  // 60 pairs are enough for a bin.
  for (const auto& [name, text] : table.notes) CHECK(name != "few_pairs");
  structure.packings[0].resize(2);
  const Table few = structure_tables("", structure, {}).at(0);
  REQUIRE(few.notes.size() == 1);
  CHECK(few.notes[0].second.find("tap 0: 2 central spheres in 1 packings, about 2 pairs") == 0);
}

TEST_CASE("Averages over packings of unequal height, with the errors of realizations") {
  EnsembleStructure structure;
  structure.taps = {0, 10};
  structure.packings = {{{measurement({1, 2, 3}, 5)}, {measurement({3, 6}, 7)}, {}},
                        {{measurement({1}, 6)}, {measurement({2}, 11)}, {measurement({3}, 1)}}};
  const std::vector<Table> tables = structure_tables("p/", structure, {});
  REQUIRE(tables.size() == 1);
  const Table& table = tables[0];
  CHECK(table.name == "p/layers");
  REQUIRE(table.axes.size() == 2);
  CHECK(table.axes[0].name == "tap");
  CHECK(std::get<std::vector<double>>(table.axes[1].values) == std::vector<double>{1, 2, 3});
  CHECK(quantity(table, "n").axes == std::vector<std::string>{"tap", "height"});
  CHECK(std::get<std::vector<std::uint64_t>>(quantity(table, "realizations").values) ==
        std::vector<std::uint64_t>{2, 3});
  CHECK(numbers(table, "n") == std::vector<double>{2, 4, 1.5, 2, 0, 0});
  const std::vector<double>& share = numbers(table, "share");
  CHECK(share[1] == 4);
  CHECK(share[2] == 3);  // share of the one packing that is so high
  CHECK(share[3] == 2);
  CHECK(std::isnan(share[4]));
  // 1 and 3: deviation sqrt 2, over sqrt 2. 1, 2 and 3: 1 over sqrt 3. One value: none.
  CHECK(numbers(table, "n_error")[0] == Approx(1).epsilon(1e-14));
  CHECK(numbers(table, "n_error")[3] == Approx(1 / std::sqrt(3.0)).epsilon(1e-14));
  CHECK(std::isnan(numbers(table, "share_error")[2]));
  // Changes by realization: 1 and 4; the third has no start.
  CHECK(numbers(table, "lateral_change") == std::vector<double>{0, 2.5});
  CHECK(numbers(table, "lateral_change_error")[1] == Approx(1.5).epsilon(1e-14));
  CHECK(quantity(table, "lateral_change").long_name == "one value, change since tap 0");
}

TEST_CASE(
    "A part that all packings refuse has a reason, and other parts use the packings that do not") {
  Measurement refused{.part = "layers", .refused = "no floor"};
  EnsembleStructure structure{.taps = {0}, .packings = {{{refused}, {refused}}}};
  Table table = structure_tables("", structure, {}).at(0);
  CHECK(table.quantities.empty());
  REQUIRE(table.notes.size() == 1);
  CHECK(table.notes[0] == std::pair<std::string, std::string>{"refused", "no floor"});
  structure.packings[0].push_back({measurement({1}, 2)});
  table = structure_tables("", structure, {}).at(0);
  CHECK(table.notes.at(0).first == "refused_by_some");
  CHECK(numbers(table, "n") == std::vector<double>{1});
  CHECK(structure_tables("", {.taps = {0}, .packings = {{{}}}}, {}).empty());
}

TEST_CASE("The laws of the papers are found in curves and counts, with jackknife errors") {
  const StructureSettings settings = all_structure();
  std::vector<double> abscissae, curve;
  for (int k = 0; k < 160; ++k) {
    abscissae.push_back(0.05 + 0.1 * k);
    const double in_radii = 2 * abscissae.back();
    const double truth[] = {0.61, 0.001, 2, 24};
    // Below the range of the law the curve is different.
    curve.push_back(
        abscissae.back() < GradientRange{}.low ? 0.1 : DensityProfile().value(in_radii, truth));
  }
  Table table =
      structure_tables("", three_curves("profile", "height", "phi", abscissae, curve), settings)
          .at(0);
  CHECK(std::get<std::vector<std::string>>(quantity(table, "eq7_status").values)[0] == "converged");
  CHECK(numbers(table, "eq7_phi_0")[0] == Approx(0.61).epsilon(1e-7));
  CHECK(numbers(table, "eq7_alpha")[0] == Approx(0.001).epsilon(1e-5));
  CHECK(numbers(table, "eq7_z_star")[0] == Approx(24).epsilon(1e-7));
  // Curves that differ by a factor: so do Phi_0 and alpha, and z* not at all.
  CHECK(numbers(table, "eq7_phi_0_error")[0] == Approx(0.61 * 0.01 / std::sqrt(3.0)).epsilon(1e-4));
  CHECK(numbers(table, "eq7_z_star_error")[0] < 1e-6);
  // For a bed that ends 1.5 d above the layers at the floor nothing but its surface would be
  // fitted.
  std::vector<double> shallow;
  for (const double height : abscissae) {
    const double truth[] = {0.61, 0.001, 2, 2 * (GradientRange{}.low + 1.5)};
    shallow.push_back(DensityProfile().value(2 * height, truth));
  }
  table =
      structure_tables("", three_curves("profile", "height", "phi", abscissae, shallow), settings)
          .at(0);
  CHECK(std::get<std::vector<std::string>>(quantity(table, "eq7_status").values)[0] ==
        "the surface is less than 2 d above the layers at the floor");
  CHECK(std::isnan(numbers(table, "eq7_phi_0")[0]));
  CHECK(std::isnan(numbers(table, "eq7_phi_0_error")[0]));

  // The expected counts of an exponential tail; below the tail the counts are different.
  std::vector<double> xi, rho;
  for (int k = 0; k < 75; ++k) {
    const double low = std::pow(0.02 * k, 3), high = std::pow(0.02 * (k + 1), 3);
    xi.push_back(0.01 + 0.02 * k);
    const double v = xi.back() * xi.back() * xi.back();
    const double tail = 4e4 * 0.08 * (std::exp(-low / 0.08) - std::exp(-high / 0.08));
    rho.push_back(v < 0.15 ? 1 : tail / 0.02);
  }
  table = structure_tables("", three_curves("pores", "xi", "rho_xi", xi, rho), settings).at(0);
  CHECK(numbers(table, "tail_v0")[0] == Approx(0.08).epsilon(1e-7));
  CHECK(numbers(table, "tail_a")[0] == Approx(4e4).epsilon(1e-6));
  const double error = 400 / std::sqrt(3.0);
  CHECK(numbers(table, "tail_a_error")[0] == Approx(error).epsilon(1e-6));
  // Student's t of 2 degrees of freedom.
  CHECK(numbers(table, "tail_a_low_95")[0] == Approx(4e4 - 4.30265 * error).epsilon(1e-6));
  CHECK(numbers(table, "tail_a_high_95")[0] == Approx(4e4 + 4.30265 * error).epsilon(1e-6));
  CHECK(numbers(table, "tail_p")[0] > 0.99);
  // For amplitudes that differ by their own size the interval ends where amplitudes do.
  const Table scattered =
      structure_tables("", three_curves("pores", "xi", "rho_xi", xi, rho, nullptr, 0, 0.8),
                       settings)
          .at(0);
  CHECK(numbers(scattered, "tail_a")[0] == Approx(4e4).epsilon(1e-6));
  CHECK(numbers(scattered, "tail_a_low_95")[0] == 0);
  CHECK(numbers(scattered, "tail_a_high_95")[0] > 1e5);
  CHECK(std::get<std::vector<std::string>>(quantity(table, "tail_status").values)[0].find(
            " is not rejected: F test over ") != std::string::npos);

  std::vector<double> free, density;
  for (int k = 0; k < 100; ++k) {
    free.push_back(0.01 + 0.02 * k);
    const double t = free.back() - least_free_volume;
    const double truth[] = {1, 0.4, 14};
    density.push_back(t > 0 ? KGamma().value(t, truth) : 0);
  }
  EnsembleStructure cells =
      three_curves("voronoi", "free_volume", "free_volume_density", free, density, "n_cells", 4000);
  table = structure_tables("", cells, settings).at(0);
  // The density at the middle of a bin is that of the bin to second order in its width.
  CHECK(numbers(table, "k_gamma_k")[0] == Approx(14).epsilon(0.01));
  CHECK(numbers(table, "k_gamma_mean")[0] == Approx(0.4).epsilon(1e-4));
  CHECK(std::get<std::vector<std::string>>(quantity(table, "normal_status").values)[0] ==
        "no packing");

  std::vector<double> faces, shares;
  for (int k = 0; k < 20; ++k) {
    const double truth[] = {1, 13.9, 1.5};
    faces.push_back(k);
    shares.push_back(Normal().value(k, truth));
  }
  table = structure_tables(
              "", three_curves("voronoi", "faces", "face_share", faces, shares, "n_cells", 4000),
              settings)
              .at(0);
  CHECK(numbers(table, "normal_mean")[0] == Approx(13.9).epsilon(1e-4));
  CHECK(numbers(table, "normal_width")[0] == Approx(1.5).epsilon(1e-3));
}

TEST_CASE("A curve that no law can have is not fitted, with a reason") {
  const StructureSettings settings = all_structure();
  const auto status = [&](const EnsembleStructure& structure, const std::string& name) {
    const Table table = structure_tables("", structure, settings).at(0);
    CHECK(std::isnan(numbers(table, name)[0]));
    const std::string prefix = name.substr(0, name.rfind('_'));
    return std::get<std::vector<std::string>>(quantity(table, prefix + "_status").values)[0];
  };
  // All cells of a perfect crystal have twelve faces; a region with a single pore.
  std::vector<double> faces(13, 0.0), abscissae(13);
  for (int k = 0; k < 13; ++k) abscissae[k] = k;
  faces[12] = 1;
  CHECK(status(three_curves("voronoi", "faces", "face_share", abscissae, faces, "n_cells", 1000),
               "normal_mean") == "too few places that hold anything");
  std::vector<double> rho(75, 0.0), xi(75);
  for (int k = 0; k < 75; ++k) xi[k] = 0.01 + 0.02 * k;
  rho[30] = 80;
  CHECK(status(three_curves("pores", "xi", "rho_xi", xi, rho), "tail_v0") ==
        "too few places that hold anything");
}

}  // namespace jostle
