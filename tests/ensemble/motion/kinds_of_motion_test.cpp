// The motion of the kinds of a mixture.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string_view>

#include "engine/bed/boundary.hpp"
#include "ensemble/analysis/motion/motion_tables.hpp"
#include "ensemble/motion/motion_records.hpp"
#include "tests/ensemble/noise.hpp"

using namespace jostle;

namespace {

constexpr std::size_t n_small = 4000, n_large = 1000, n = n_small + n_large + 1;
constexpr std::size_t n_taps = 16, n_realizations = 6;

MotionSettings by_kind() {
  return {.origins = {0}, .lags = {1, 4, 16}, .overlap_lengths = {0.3}, .layers = 2, .kinds = 3};
}

/// Spheres of two kinds and one intruder, at random in a box; overlaps do not matter.
Packing mixture(RandomStream& random) {
  Packing bed{PeriodicBox{20, 20}, {}};
  std::vector<double> diameters(n_small, 1.0);
  diameters.insert(diameters.end(), n_large, 1.5);
  diameters.push_back(3);
  std::vector<std::uint32_t> kinds(n_small, 0);
  kinds.insert(kinds.end(), n_large, 1);
  kinds.push_back(2);
  for (std::size_t i = 0; i < n; ++i)
    bed.centres.push_back({20 * random.uniform(), 20 * random.uniform(), 30 * random.uniform()});
  bed.sizes = std::make_shared<const Sizes>(
      diameters, kinds, std::vector<SphereKind>{{"small", 1}, {"large", 1}, {"intruder", 1}});
  return bed;
}

/// Random walks with steps of 0.1 for small spheres and 0.05 for large ones, which also settle by
/// 0.02 in a tap; the intruder rises by 0.03 in a tap.
struct Walk {
  MotionState state;
  std::vector<std::vector<Vec3>> moved;  // [lag, sphere], sums of steps
};

Walk walk(const MotionSettings& settings, std::uint64_t realization) {
  RandomStream random = test_stream(500 + realization);
  Packing bed = mixture(random);
  Walk found;
  std::vector<Vec3> sums(n);
  follow_motion(settings, bed, 0, found.state);
  for (std::uint64_t tap = 1; tap <= n_taps; ++tap) {
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t kind = bed.sizes->kind(i);
      const double step = kind == 0 ? 0.1 : kind == 1 ? 0.05 : 0;
      const Vec3 way{step * noise(random), step * noise(random),
                     step * noise(random) + (kind == 1   ? -0.02
                                             : kind == 2 ? 0.03
                                                         : 0)};
      bed.centres[i] = wrapped(Boundary(bed.container), bed.centres[i] + way);
      sums[i] = sums[i] + way;
    }
    follow_motion(settings, bed, tap, found.state);
    if (std::ranges::binary_search(settings.lags, tap)) found.moved.push_back(sums);
  }
  return found;
}

std::vector<Walk> walks() {
  std::vector<Walk> all;
  for (std::uint32_t r = 0; r < n_realizations; ++r) all.push_back(walk(by_kind(), r));
  return all;
}

MotionRecords records_of(const std::vector<Walk>& all) {
  MotionRecords records(by_kind(), n, n_realizations);
  for (std::uint32_t r = 0; r < n_realizations; ++r)
    records.add(r, all[r].state, PeriodicBox{20, 20});
  return records;
}

constexpr std::size_t first_of_kind[] = {0, n_small, n_small + n_large, n};

/// The mean of a function of displacements over the spheres of a kind, 3: over all.
template <class Value>
double mean_of(const std::vector<Vec3>& moved, std::size_t kind, const Value& value) {
  const std::size_t first = kind == 3 ? 0 : first_of_kind[kind],
                    last = kind == 3 ? n : first_of_kind[kind + 1];
  double sum = 0;
  for (std::size_t i = first; i < last; ++i) sum += value(moved[i]);
  return sum / static_cast<double>(last - first);
}

const std::vector<double>& column(const Table& table, std::string_view name) {
  const auto found = std::ranges::find(table.quantities, name, &Quantity::name);
  REQUIRE(found != table.quantities.end());
  return std::get<std::vector<double>>(found->values);
}

}  // namespace

TEST_CASE("The motion of kinds adds up to that of the bed") {
  const MotionRecords found = records_of(walks());
  constexpr double counts[] = {n_small, n_large, 1};
  for (const auto& [kinds, bed] : {std::pair{"kind_mean_displacement", "mean_displacement"},
                                   std::pair{"kind_square_displacement", "square_displacement"}}) {
    for (std::size_t lag = 0; lag < 3; ++lag) {
      for (std::size_t direction = 0; direction < 3; ++direction) {
        double sum = 0;
        for (std::size_t kind = 0; kind < 3; ++kind)
          sum += counts[kind] * found.row(kinds, 0, lag, 3 * kind + direction)[2];
        CHECK(sum / n == Approx(found.row(bed, 0, lag, direction)[2]).epsilon(1e-12).margin(1e-14));
      }
    }
  }
}

TEST_CASE("The table of kinds has means over realizations of sums over their spheres") {
  const std::vector<Walk> all = walks();
  const auto tables = motion_tables("", records_of(all), {"small", "large", "intruder"});
  REQUIRE(tables.size() == 4);
  const Table& kinds = tables[3];
  CHECK(kinds.name == "kinds");
  CHECK(std::get<std::vector<std::string>>(kinds.axes[2].values) ==
        std::vector<std::string>{"small", "large", "intruder"});
  const std::vector<std::uint64_t> lags = by_kind().lags;
  const auto height = [](Vec3 d) { return d.z; };
  for (std::size_t l = 0; l < lags.size(); ++l) {
    for (std::size_t kind = 0; kind < 3; ++kind) {
      CAPTURE(l, kind);
      double rise = 0, rise_squares = 0, lateral = 0, vertical = 0;
      for (const Walk& walk : all) {
        const double bed = mean_of(walk.moved[l], 3, height);
        const double upward = mean_of(walk.moved[l], kind, height) - bed;
        rise += upward / n_realizations;
        rise_squares += upward * upward / n_realizations;
        lateral += mean_of(walk.moved[l], kind, [](Vec3 d) { return d.x * d.x + d.y * d.y; }) /
                   n_realizations;
        vertical +=
            mean_of(walk.moved[l], kind, [bed](Vec3 d) { return (d.z - bed) * (d.z - bed); }) /
            n_realizations;
      }
      const std::size_t index = 3 * l + kind;
      const double spread = std::sqrt(std::max(0.0, rise_squares - rise * rise));
      CHECK(column(kinds, "rise")[index] == Approx(rise).epsilon(1e-9).margin(1e-12));
      CHECK(column(kinds, "rise_error")[index] ==
            Approx(spread / std::sqrt(n_realizations - 1.0)).epsilon(1e-6).margin(1e-9));
      CHECK(column(kinds, "msd_lateral")[index] == Approx(lateral).epsilon(1e-9).margin(1e-18));
      CHECK(column(kinds, "msd_z_about_bed")[index] ==
            Approx(vertical).epsilon(1e-9).margin(1e-12));
      CHECK(column(kinds, "lateral_diffusivity")[index] ==
            Approx(lateral / (4 * static_cast<double>(lags[l]))).epsilon(1e-9).margin(1e-18));
    }
  }
  // Steps of variance s^2 in two directions have the diffusivity s^2 / 2 and the exponent 1.
  CHECK(column(kinds, "lateral_diffusivity")[0] == Approx(0.005).epsilon(0.05));
  CHECK(column(kinds, "lateral_diffusivity")[1] == Approx(0.00125).epsilon(0.1));
  const std::vector<double>& squares = column(kinds, "msd_lateral");
  for (std::size_t kind = 0; kind < 2; ++kind)
    CHECK(column(kinds, "lateral_exponent")[3 + kind] ==
          Approx(std::log(squares[6 + kind] / squares[kind]) / std::log(16.0)).epsilon(1e-9));
}

TEST_CASE("Motion that is not followed by kind has three tables") {
  MotionSettings settings = by_kind();
  settings.kinds = 0;
  CHECK(n_motion_values(settings) + 18 == n_motion_values(by_kind()));
  MotionRecords records(settings, n, 1);
  records.add(0, walk(settings, 0).state, PeriodicBox{20, 20});
  CHECK(motion_tables("", records).size() == 3);
  const MotionState state = walk(by_kind(), 0).state;
  MotionRecords with_kinds(by_kind(), n, 1);
  with_kinds.add(0, state, PeriodicBox{20, 20});
  for (std::size_t q = 0; q < records.values.size(); ++q) {
    if (motion_quantities[q].places != MotionPlaces::kind_directions)
      CHECK(records.values[q] == with_kinds.values[q]);
  }
}
