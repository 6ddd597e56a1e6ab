#include "ensemble/fitting_report.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "ensemble/realization.hpp"
#include "small_plans.hpp"
#include "structure/observables.hpp"

namespace jostle {
namespace {

double corrected_fraction(const Packing& packing) {
  return Observer({CorrectedFraction{}}, packing)(packing).front();
}

// Its first row, and then its record of a fitting.
struct FirstRow {
  TapRow row;
  std::optional<FittingReport> fitting;
};
FirstRow start_of(const Plan& plan) {
  Realization realization(plan, 0);
  Slice slice;
  while (!slice.row) slice = realization.advance(1'000'000);
  return {*slice.row, realization.state().fitting};
}

}  // namespace

TEST_CASE("The report of a fitting lists moves and the fractions before and after") {
  // A column of ten in the middle of 8 x 8, and one sphere that straddles a wall at their <Z>.
  Packing poured{PeriodicBox{8, 8}, {}};
  for (int i = 0; i < 10; ++i) poured.centres.push_back({4, 4, 0.5 + i});
  poured.centres.push_back({0.2, 4, 5});
  Packing fitted{WalledBox{8, 8}, poured.centres};
  fitted.centres.back() = {0.5, 4, 11};
  const FittingReport report = fitting_report(poured, fitted);
  CHECK(report.spheres_moved == 1);
  CHECK(report.mean_rise == 6);
  CHECK(report.corrected_fraction_before == corrected_fraction(poured));
  CHECK(report.corrected_fraction_after == corrected_fraction(fitted));
  // Six spheres between 2 and 8 diameters, in a column 4 x 4: a quarter of the width off the walls.
  CHECK(report.central_fraction_before == Approx(6 * sphere_volume / (4 * 4 * 6)));
  CHECK(report.central_fraction_after == Approx(6 * sphere_volume / (4 * 4 * 6)));

  // 7 R off the walls of a box wide enough.
  poured.container = PeriodicBox{20, 20};
  fitted.container = WalledBox{20, 20};
  CHECK(fitting_report(poured, fitted).central_fraction_before ==
        Approx(6 * sphere_volume / (13 * 13 * 6)));

  // Between plates 20 apart the periodic width does not matter.
  poured.container = Plates{4, 20};
  fitted.container = Plates{4, 20};
  poured.centres.back() = fitted.centres.back() = {2, 10, 5};
  for (int i = 0; i < 10; ++i) poured.centres[i] = fitted.centres[i] = {2, 10, 0.5 + i};
  CHECK(fitting_report(poured, fitted).central_fraction_before ==
        Approx(7 * sphere_volume / (4 * 13 * 6)));

  // A layer: no height between 4 R and 0.8 x 2<Z>.
  const Packing layer{PeriodicBox{8, 8}, {{4, 4, 0.5}}},
      walled_layer{WalledBox{8, 8}, layer.centres};
  const FittingReport idle = fitting_report(layer, walled_layer);
  CHECK(idle.spheres_moved == 0);
  CHECK(idle.mean_rise == 0);
  CHECK(std::isnan(idle.central_fraction_before));
}

TEST_CASE("A realization reports the fitting of its start, and of no other start") {
  Plan plan = small_plan();
  CHECK_FALSE(start_of(plan).fitting);
  plan.container = WalledBox{4.5, 4.2};
  plan.start = FittedPour{};
  const FirstRow start = start_of(plan);
  RandomStream random(stream_key(plan.seed, plan.point_id, 0, Purpose::start));
  Packing poured;
  const Packing fitted =
      make_start(plan.start, plan.container, plan.n_spheres, random, {}, &poured);
  CHECK(start.fitting == fitting_report(poured, fitted));
  CHECK(diagnostic(start.row, "sweeps") == 0);

  // A relaxation before tap 0 on request, and the report is that of the fitting still.
  monte_carlo(plan).relax_start =
      Relaxation{.move = PolarMove{}, .stop = {.rule = SweepsStop{.sweeps = 11}}};
  const FirstRow relaxed = start_of(plan);
  CHECK(diagnostic(relaxed.row, "sweeps") == 11);
  CHECK(relaxed.fitting == start.fitting);
}

}  // namespace jostle
