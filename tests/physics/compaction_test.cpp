#include <catch2/catch.hpp>

#include "short_scene.hpp"

using namespace jostle;

// Depths and densities are the papers'; the floors are a quarter of theirs, so spheres are too.

TEST_CASE("Philippe & Bideau: Phi_b rises with taps between walls", "[statistics]") {
  const Plan plan = short_plan("philippe-bideau-2001/fig2.json",
                               {{"container", {{"width", 8}}},
                                {"spheres", 1024},
                                {"protocol", {{{"tap", {{"dilate", 0.05}}}, {"count", 12}}}},
                                {"snapshots", nullptr}});
  // From tap 1: the first tap also undoes the fit between the walls.
  const Moments rise = change(run_series(plan, 6, "bottom_fraction"), 1, 12);
  CAPTURE(rise.mean(), rise.standard_error());
  CHECK(rise.mean() > 3 * rise.standard_error());
}

TEST_CASE("Philippe & Bideau: Phi_b rises with taps between periodic sides", "[statistics]") {
  const Plan plan = short_plan("philippe-bideau-2001/fig9.json",
                               {{"container", {{"width", 8}}},
                                {"spheres", 1024},
                                {"observe", {"bottom_fraction"}},
                                {"protocol", {{{"tap", {{"dilate", 0.05}}}, {"count", 25}}}},
                                {"snapshots", nullptr}});
  const Moments rise = change(run_series(plan, 8, "bottom_fraction"), 0, 25);
  CAPTURE(rise.mean(), rise.standard_error());
  CHECK(rise.mean() > 3 * rise.standard_error());
}

TEST_CASE("Rosato et al.: a poured bed lifted by 0.25 grows denser at the floor", "[statistics]") {
  const Plan plan = short_plan("rosato-dybenko-2010/fig6.json",
                               {{"container", {{"width", 6}}},
                                {"spheres", 864},
                                {"observe", {"bottom_fraction"}},
                                {"protocol", {{{"tap", {{"lift", 0.25}}}, {"count", 8}}}},
                                {"snapshots", nullptr}});
  const Moments rise = change(run_series(plan, 4, "bottom_fraction"), 0, 8);
  CAPTURE(rise.mean(), rise.standard_error());
  CHECK(rise.mean() > 3 * rise.standard_error());
}

TEST_CASE("Rosato et al.: a hexagonal crystal lifted by 0.25 loses density", "[statistics]") {
  const Plan plan = short_plan("rosato-dybenko-2010/fig5.json",
                               {{"container", {{"width", {6, 6.928203230275509}}}},
                                {"spheres", 960},
                                {"protocol", {{{"tap", {{"lift", 0.25}}}, {"count", 5}}}},
                                {"snapshots", nullptr}});
  const Moments fall = change(run_series(plan, 3, "bulk_fraction"), 0, 5);
  CAPTURE(fall.mean(), fall.standard_error());
  CHECK(fall.mean() < -3 * fall.standard_error());
}
