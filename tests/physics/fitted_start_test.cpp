#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "ensemble/realization.hpp"
#include "short_scene.hpp"
#include "structure/density/profiles.hpp"
#include "structure/observables.hpp"
#include "structure/voids/pores.hpp"

// The start of Philippe & Bideau's figures between walls, at full size: 4096 spheres on 16 x 16.

namespace jostle {
namespace {

constexpr WalledBox walls{16, 16};
constexpr std::uint32_t n_spheres = 4096;
constexpr std::uint64_t seed = 63051304;

struct Fitted {
  Packing poured, fitted;
};

Fitted fitted(std::uint64_t realization) {
  RandomStream random(stream_key(seed, 0, realization, Purpose::start));
  Fitted bed;
  bed.fitted = make_start(FittedPour{}, walls, n_spheres, random, {}, &bed.poured);
  return bed;
}

double corrected_fraction(const Packing& packing) {
  return Observer({CorrectedFraction{}}, packing)(packing).at(0);
}

// Mean volume of the pores in [PB]'s region, and the mean by which the large ones (v > 0.15) exceed
// 0.15: the maximum-likelihood v0 of an exponential tail.
struct PoreVolumes {
  double mean = 0, tail = 0;
};
PoreVolumes pore_volumes(const Packing& packing, double from_walls) {
  const std::vector<Pore> chosen =
      pores_in(pores(packing, voronoi_cells(packing)), walls, {1, 10, from_walls});
  constexpr double tail_start = 0.15;
  Moments tail;
  for (const Pore& pore : chosen) {
    const double volume = std::pow(pore.radius / sphere_radius, 3);
    if (volume > tail_start) tail.add(volume - tail_start);
  }
  return {mean_pore_volume(chosen), tail.mean()};
}

// Packing fraction farther than 7 R from every wall.
double middle_fraction(const Packing& packing) {
  const std::array<double, 2> edges{7 * sphere_radius, 0.5 * walls.width_x};
  return wall_profile({walls, packing.centres}, edges, {1, 10}).values.at(0);
}

// True if the mean is `reference`, known to half a unit of its last digit, within 3 errors.
void check_mean(const Moments& run, double reference, double reference_error) {
  CAPTURE(run.mean(), run.standard_error(), reference, reference_error);
  const double error = std::hypot(run.standard_error(), reference_error);
  CHECK(std::abs(run.mean() - reference) <= 3 * error);
}

}  // namespace

TEST_CASE("Fitted between walls, a pour keeps its packing fraction and pores inside",
          "[statistics]") {
  Moments fraction, mean, tail, change_of_mean, change_of_tail;
  for (std::uint64_t realization = 0; realization < 6; ++realization) {
    const Fitted bed = fitted(realization);
    CHECK(deepest_overlap(bed.fitted).depth <= overlap_bound(bed.fitted));
    // To the bit where no sphere moved nor came, which is everywhere but at the walls and on top.
    CHECK(middle_fraction(bed.fitted) == middle_fraction(bed.poured));
    const PoreVolumes deep_before = pore_volumes(bed.poured, 3), deep = pore_volumes(bed.fitted, 3);
    CHECK(deep.mean == Approx(deep_before.mean).epsilon(1e-9));
    CHECK(deep.tail == Approx(deep_before.tail).epsilon(1e-9));
    // In [PB]'s region, from 2 R off the walls on.
    const PoreVolumes volumes_before = pore_volumes(bed.poured, 1),
                      volumes_after = pore_volumes(bed.fitted, 1);
    fraction.add(middle_fraction(bed.fitted));
    mean.add(volumes_after.mean);
    tail.add(volumes_after.tail);
    change_of_mean.add(volumes_after.mean - volumes_before.mean);
    change_of_tail.add(volumes_after.tail - volumes_before.tail);
  }
  // Periodic pours, by an independent program, and nu of a prototype's.
  check_mean(fraction, 0.5809, 0.0004);
  check_mean(mean, 0.125, 0.0005);
  // Near walls a pore or two in a hundred changes; the mean by less than the error of one pour.
  CAPTURE(change_of_mean.mean(), mean.sigma(), change_of_tail.mean(), tail.sigma());
  CHECK(std::abs(change_of_mean.mean()) < mean.sigma());
  CHECK(std::abs(change_of_tail.mean()) < tail.sigma());
}

TEST_CASE("Fitted between walls, a pour is thin at the walls", "[statistics]") {
  // A prototype of the rule: slabs of 0.1 d around the distances.
  constexpr std::array<double, 5> prototype{0.006, 0.09, 0.25, 0.42, 0.54};
  constexpr std::array<std::size_t, 5> slabs{0, 2, 4, 6, 8};
  std::array<Moments, 5> fractions;
  Moments moved, corrected;
  for (std::uint64_t realization = 0; realization < 6; ++realization) {
    const Fitted bed = fitted(realization);
    const std::vector<double> edges = even_edges(0, walls.width_x, 0.1);
    const Profile profile =
        mean_transverse_profile(bed.fitted, edges, transverse_window(bed.fitted));
    for (std::size_t k = 0; k < slabs.size(); ++k) {
      const double near = profile.values.at(slabs[k]);
      const double far = profile.values.at(profile.size() - 1 - slabs[k]);
      fractions[k].add(0.5 * (near + far));
    }
    double count = 0;
    for (std::size_t i = 0; i < n_spheres; ++i) {
      count += bed.fitted.centres[i] == bed.poured.centres[i] ? 0 : 1;
    }
    moved.add(count);
    corrected.add(corrected_fraction(bed.fitted));
  }
  // The prototype's figures come from one bed: its error is that of one bed here, and of rounding.
  const auto check = [](const Moments& run, double prototype_value, double rounding) {
    const double of_one_bed = run.standard_error() * std::sqrt(static_cast<double>(run.count()));
    check_mean(run, prototype_value, std::hypot(of_one_bed, rounding));
  };
  check(fractions[0], prototype[0], 0.0005);
  for (std::size_t k = 1; k < slabs.size(); ++k) check(fractions[k], prototype[k], 0.005);
  check(moved, 499, 0.5);
  check(corrected, 0.515, 0.0005);
}

TEST_CASE("The first tap fills the layers at the walls of a fitted pour, and the next does not",
          "[slow]") {
  // The shipped scene, epsilon = 0.02.
  constexpr std::uint64_t taps = 2;
  const Plan plan = short_plan("philippe-bideau-2001/fig10.json",
                               {{"protocol", {{{"tap", {{"dilate", 0.02}}}, {"count", taps}}}},
                                {"snapshots", {{"taps", {0, 1, 2}}, {"keep", {"positions"}}}}});
  std::array<Moments, taps + 1> lateral, central, corrected;
  std::array<Moments, taps> lateral_jump, central_jump;
  for (std::uint32_t r = 0; r < 4; ++r) {
    std::array<LateralCentral, taps + 1> phi;
    for (Realization realization(plan, r); !realization.finished();) {
      const Slice slice = realization.advance(4'000'000);
      if (!slice.row) continue;
      const std::uint64_t tap = slice.row->tap;
      // Nothing relaxes before tap 0.
      CHECK((diagnostic(*slice.row, "sweeps") == 0) == (tap == 0));
      const Packing bed{plan.container, slice.snapshot->centres};
      phi.at(tap) = lateral_and_central(bed, transverse_window(bed));
      lateral.at(tap).add(phi.at(tap).lateral);
      central.at(tap).add(phi.at(tap).central);
      corrected.at(tap).add(corrected_fraction(bed));
    }
    for (std::size_t tap = 0; tap < taps; ++tap) {
      lateral_jump.at(tap).add(phi.at(tap + 1).lateral - phi.at(tap).lateral);
      central_jump.at(tap).add(phi.at(tap + 1).central - phi.at(tap).central);
    }
  }
  // A prototype of the rule, one bed.
  const auto check = [](const Moments& run, double prototype) {
    check_mean(run, prototype, std::hypot(2 * run.standard_error(), 0.0005));
  };
  check(corrected[0], 0.515);
  check(corrected[1], 0.531);
  check(lateral[0], 0.468);
  check(lateral[1], 0.503);
  check(central[0], 0.545);
  check(central[1], 0.553);
  // The jump of fig. 8.
  const auto beyond = [](const Moments& larger, const Moments& smaller) {
    const double error = std::hypot(larger.standard_error(), smaller.standard_error());
    CAPTURE(larger.mean(), smaller.mean(), error);
    CHECK(larger.mean() - smaller.mean() > 3 * error);
  };
  beyond(lateral_jump[0], central_jump[0]);
  beyond(lateral_jump[0], lateral_jump[1]);
}

}  // namespace jostle
