#include <catch2/catch.hpp>

#include "short_scene.hpp"

using namespace jostle;

TEST_CASE("Rosato et al.: random positions settle to a bulk fraction of 0.56 to 0.58",
          "[statistics]") {
  // At full size: 3456 spheres on 12 x 12 diameters, no tap.
  const Plan plan = short_plan("rosato-dybenko-2010/fig4.json",
                               {{"protocol", nlohmann::json::array()}, {"snapshots", nullptr}});
  Moments poured;
  for (const auto& values : run_series(plan, 3, "bulk_fraction")) poured.add(values.at(0));
  CAPTURE(poured.mean(), poured.standard_error());
  CHECK(poured.mean() > 0.56);
  CHECK(poured.mean() < 0.58);
}
