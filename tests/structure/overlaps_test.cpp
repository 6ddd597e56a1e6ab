// Results of measure() for spheres that overlap slightly, like those of discrete elements.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "engine/bed/slab.hpp"
#include "engine/discrete_element/grain_loop.hpp"
#include "engine/starts/starts.hpp"
#include "structure/measure.hpp"
#include "tests/structure/order/close_packings.hpp"
#include "tests/structure/voids/voronoi_points.hpp"

using namespace jostle;

namespace {

constexpr StreamKey points{20'262};

const Measurement& part(const std::vector<Measurement>& all, std::string_view name) {
  const auto found = std::ranges::find(all, name, &Measurement::part);
  REQUIRE(found != all.end());
  INFO(name << ": " << found->refused);
  REQUIRE(found->refused.empty());
  return *found;
}

const std::vector<double>& values_of(const Measurement& measurement, std::string_view name) {
  const MeasuredQuantity* quantity = measurement.find(name);
  REQUIRE(quantity != nullptr);
  return quantity->values;
}

double single(const Measurement& measurement, std::string_view name) {
  REQUIRE(values_of(measurement, name).size() == 1);
  return values_of(measurement, name)[0];
}

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double value : values) total += value;
  return total;
}

/// Touching fcc in a fully periodic box of 5 cubic cells a side, all lengths times `scale`.
Packing pressed_fcc(double scale) {
  Packing packing = fcc_points();
  const double width = scale * 5 * std::numbers::sqrt2;
  packing.container = FullyPeriodicBox{width, width, width};
  for (Vec3& r : packing.centres) r = scale * r;
  return packing;
}

StructureSettings without_floor() {
  StructureSettings settings = all_structure();
  settings.profile.reset();
  settings.sides.reset();
  settings.layers.reset();
  return settings;
}

/// Part beyond a plane of a sphere that reaches so deep through it.
double cap_volume(double depth) {
  return std::numbers::pi * depth * depth * (3 * sphere_radius - depth) / 3;
}

/// Common volume of two spheres that overlap.
double lens_volume(double overlap) {
  return 2 * cap_volume(overlap / 2);
}

/// A bed poured and come to rest between walls, on springs so soft that spheres lie some 1e-2 in
/// one another.
Packing soft_bed() {
  DiscreteElement engine;
  engine.spheres = LinearSpringDashpot{.stiffness = 2e3, .restitution = 0.5};
  const WalledBox box{6, 6};
  RandomStream random(stream_key(7, 0, 0, Purpose::start));
  GrainLoop loop(box, reduced(engine));
  loop.load(make_start(SteepestDescentPour{}, box, 300, random));
  loop.run(8000);
  REQUIRE(loop.is_sound());
  Packing bed;
  loop.store(bed);
  return bed;
}

double neighbours_by_all_pairs(const Packing& packing, double cut) {
  double pairs = 0;
  for (std::size_t i = 0; i < packing.centres.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      pairs += norm_squared(packing.centres[i] - packing.centres[j]) <= cut * cut ? 1 : 0;
  return 2 * pairs / static_cast<double>(packing.centres.size());
}

}  // namespace

TEST_CASE("An fcc crystal pressed together has the structure of its lattice") {
  const double overlap = GENERATE(0, 1e-4, 1e-3, 1e-2);
  CAPTURE(overlap);
  const double distance = 1 - overlap,
               volume = distance * distance * distance / std::numbers::sqrt2;
  const std::vector<Measurement> all = measure(pressed_fcc(distance), without_floor(), points);

  CHECK(single(part(all, "coordination"), "n_c") == 12);
  CHECK(single(part(all, "gaps"), "contacts") == 12);
  CHECK(single(part(all, "order"), "fcc") == 1);
  CHECK(single(part(all, "order"), "q6") == Approx(0.57452426).epsilon(1e-7));
  const Measurement& cells = part(all, "voronoi");
  CHECK(single(cells, "mean_faces") == 12);
  CHECK(single(cells, "mean_volume") == Approx(volume).epsilon(1e-9));
  CHECK(single(cells, "mean_local_fraction") == Approx(sphere_volume / volume).epsilon(1e-9));
  CHECK(single(cells, "inconsistent_cells") == 0);
  // A last bin ends at 0.76, beyond all that cells of hard spheres have.
  CHECK(sum(values_of(cells, "local_fraction_density")) * 0.01 ==
        Approx(sphere_volume / volume < 0.76 ? 1 : 0).margin(1e-9));
  // Spheres count whole: their common volume counts twice.
  CHECK(single(part(all, "void_probability"), "phi") ==
        Approx(sphere_volume / volume).epsilon(1e-9));
  const double tetrahedral = std::sqrt(1.5) * distance - 1;
  const double octahedral = std::numbers::sqrt2 * distance - 1;
  const Measurement& found = part(all, "pores");
  CHECK(single(found, "tetrahedral") == Approx(2.0 / 3).epsilon(1e-12));
  CHECK(single(found, "octahedral") == Approx(1.0 / 3).epsilon(1e-12));
  CHECK(single(found, "nu") ==
        Approx((2 * std::pow(tetrahedral, 3) + std::pow(octahedral, 3)) / 3).epsilon(1e-6));
  CHECK(single(part(all, "holes"), "unclassified") == 0);
  CHECK(values_of(part(all, "holes"), "number_fraction")[0] == Approx(0.5).epsilon(1e-12));
}

TEST_CASE("Packing fractions count overlaps of two spheres twice") {
  // No point is in three of them: three centres are 0.549 from the middle between them.
  constexpr double distance = 0.95;
  const Packing packing = pressed_fcc(distance);
  StructureSettings settings;
  settings.void_probability.emplace();
  const double counted =
      single(part(measure(packing, settings, points), "void_probability"), "phi");
  const double volume = distance * distance * distance / std::numbers::sqrt2;
  const double expected = counted - 6 * lens_volume(1 - distance) / volume;

  RandomStream random(stream_key(8, 0, 0, Purpose::start));
  const double width = width_x(packing.container);
  constexpr int n = 40'000;
  int inside = 0;
  for (int k = 0; k < n; ++k) {
    const Vec3 r{width * random.uniform(), width * random.uniform(), width * random.uniform()};
    inside += std::ranges::any_of(packing.centres, [&](const Vec3& centre) {
      const Vec3 d = r - centre;
      const Vec3 nearest{std::remainder(d.x, width), std::remainder(d.y, width),
                         std::remainder(d.z, width)};
      return norm_squared(nearest) < sphere_radius * sphere_radius;
    });
  }
  const double filled = static_cast<double>(inside) / n;
  CHECK(std::abs(filled - expected) < 3 * std::sqrt(expected * (1 - expected) / n));
  CHECK(counted - filled > 6 * std::sqrt(expected * (1 - expected) / n));
}

TEST_CASE("Layers pressed into the floor are layers, and lose what is below it") {
  const double overlap = GENERATE(1e-4, 1e-3, 1e-2);
  CAPTURE(overlap);
  const double distance = 1 - overlap;
  Packing packing = stacked_layers("ABCABC");
  const auto box = std::get<PeriodicBox>(packing.container);
  packing.container = PeriodicBox{distance * box.width_x, distance * box.width_y};
  for (Vec3& r : packing.centres) r = distance * r;
  StructureSettings settings;
  settings.profile.emplace();
  settings.layers.emplace();
  settings.region = Region{0.5, 4, 0};
  const std::vector<Measurement> all = measure(packing, settings, points);
  CHECK(single(part(all, "layers"), "grown_layers") == 6);
  const double n = static_cast<double>(packing.centres.size());
  const double cap_sum = n / 6 * cap_volume(overlap / 2);
  CHECK(sum(values_of(part(all, "profile"), "phi")) * 0.1 * footprint_area(packing.container) ==
        Approx(n * sphere_volume - cap_sum).epsilon(1e-12));
}

TEST_CASE("Every part measures a bed of soft grains between walls") {
  const Packing bed = soft_bed();
  const double deepest = deepest_overlap_brute_force(bed).depth;
  CAPTURE(deepest);
  CHECK(deepest > 5e-3);
  CHECK(deepest < 5e-2);
  StructureSettings settings = all_structure();
  settings.structure_factor.reset();  // walls have no wave vectors
  settings.sides->reach = 1;
  settings.region = Region{1, 5, 0.5};
  const std::vector<Measurement> all = measure(bed, settings, points);
  for (const Measurement& measurement : all) {
    INFO(measurement.part << ": " << measurement.refused);
    CHECK(measurement.refused.empty());
  }

  CHECK(single(part(all, "coordination"), "n_c_all") ==
        Approx(neighbours_by_all_pairs(bed, 1.05)).epsilon(1e-12));
  const Measurement& cells = part(all, "voronoi");
  CHECK(std::abs(single(cells, "volume_excess")) < 1e-10);
  CHECK(single(cells, "inconsistent_cells") == 0);
  double cap_sum = 0;
  for (const Vec3& r : bed.centres) cap_sum += cap_volume(std::max(0.0, sphere_radius - r.z));
  CHECK(cap_sum > 0);
  CHECK(sum(values_of(part(all, "profile"), "phi")) * 0.1 * footprint_area(bed.container) ==
        Approx(300 * sphere_volume - cap_sum).epsilon(1e-12));
}

TEST_CASE("Spheres are measured down to half a diameter apart, and refused below") {
  CHECK_NOTHROW(measure(pressed_fcc(0.51), without_floor(), points));
  CHECK_THROWS_WITH(measure(pressed_fcc(0.49), without_floor(), points),
                    Catch::Matchers::Contains("apart, and their diameter is 1"));
}
