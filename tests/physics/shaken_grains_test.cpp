#include <catch2/catch.hpp>
#include <cmath>

#include "short_scene.hpp"

using namespace jostle;

// One ordering of fig. 15, on a floor of a fortieth of the paper's area, springs ten times softer
// and a second of vibration. The seed is the shipped scene's.
TEST_CASE("Rosato & Dybenko: shaking hard enough to throw the bed densifies it, gently it does not",
          "[slow]") {
  const auto gain = [](double amplitude, double frequency) {
    const nlohmann::json vibration = {
        {"amplitude", amplitude}, {"frequency", frequency}, {"cycles", int(frequency)}};
    const Plan plan =
        short_plan("rosato-dybenko-2010/fig15.json",
                   {{"container", {{"width", 4}}},
                    {"spheres", 150},
                    {"engine",
                     {{"discrete_element",
                       {{"contact", {{"walton_braun", {{"stiffness", 1e4}}}}},
                        {"rest", {{"timed", {{"seconds", 1}}}}}}}}},
                    {"protocol", {{{"tap", {{"vibration", vibration}}}, {"count", 1}}}},
                    {"snapshots", {{"taps", {1}}, {"bin_width", 1}}}});
    const Records records = run_records(plan, 24);
    // Collisions distribute the energy that the floor puts into vertical motion. Beds scatter: one
    // of these 24 has more lateral motion at the floor.
    Moments excess;
    std::size_t bed = 0;
    for (const auto& [id, record] : records) {
      const SnapshotRecord& shaken = record.snapshots.at(0);
      REQUIRE(shaken.driven_lateral.size() > 3);
      excess.add(shaken.driven_vertical[0] - shaken.driven_lateral[0]);
      if (amplitude > 0.05 && bed++ < 4)
        CHECK(shaken.driven_lateral[0] < shaken.driven_vertical[0]);
    }
    CAPTURE(excess.mean(), excess.standard_error());
    if (amplitude > 0.05) CHECK(excess.mean() > 3 * excess.standard_error());
    return series_of(plan, records, "bulk_fraction");
  };
  const Series gentle = gain(0.02, 10), strong = gain(0.06, 45);  // Gamma = 0.16 and 9.8
  // A bed gains some 0.01 or, where it orders, some 0.1: four beds determine the mean poorly.
  Moments rises;
  for (std::size_t r = 0; r < gentle.size(); ++r)
    rises.add((strong[r][1] - strong[r][0]) - (gentle[r][1] - gentle[r][0]));
  CAPTURE(rises.mean(), rises.standard_error(), change(gentle, 0, 1).mean());
  CHECK(rises.mean() > 3 * rises.standard_error());
  CHECK(std::abs(change(gentle, 0, 1).mean()) < 0.005);
  for (std::size_t r = 0; r < gentle.size(); ++r) CHECK(gentle[r][0] == strong[r][0]);  // matched
}

TEST_CASE("Rosato & Dybenko: poured grains lie looser with more friction", "[statistics]") {
  // Fig. 7, one realization after the other from the same column.
  const auto poured = [](double friction) {
    const Plan plan = short_plan(
        "rosato-dybenko-2010/fig7-9.json",
        {{"container", {{"width", 4}}},
         {"spheres", 256},
         {"streams", "matched"},
         {"observe", {"bulk_fraction"}},
         {"engine",
          {{"discrete_element",
            {{"contact", {{"walton_braun", {{"stiffness", 1e4}, {"friction", friction}}}}},
             {"rest", {{"timed", {{"seconds", 2}}}}}}}}},
         {"snapshots", nullptr}});
    return run_series(plan, 6, "bulk_fraction");
  };
  const Series smooth = poured(0), rough = poured(0.5);
  Moments loss;
  for (std::size_t r = 0; r < rough.size(); ++r) loss.add(smooth[r][0] - rough[r][0]);
  CAPTURE(loss.mean(), loss.standard_error());
  CHECK(loss.mean() > 3 * loss.standard_error());  // [4]
}

TEST_CASE("Tapped grains without friction end denser than Monte Carlo beds from the same pours",
          "[slow]") {
  const auto tapped = [](const nlohmann::json& engine) {
    const Plan plan =
        short_plan("both-engines.json", {{"container", {{"width", 5}}},
                                         {"spheres", 300},
                                         {"observe", {"bulk_fraction"}},
                                         {"protocol", {{{"tap", {{"lift", 0.25}}}, {"count", 8}}}},
                                         {"engine", engine},
                                         {"snapshots", nullptr}});
    return run_series(plan, 6, "bulk_fraction");
  };
  const Series trials =
      tapped({{"discrete_element", nullptr}, {"monte_carlo", nlohmann::json::object()}});
  const Series grains =
      tapped({{"discrete_element",
               {{"contact", {{"walton_braun", {{"stiffness", 1e4}, {"friction", 0}}}}},
                {"rest", {{"timed", {{"seconds", 0.5}}}}}}}});
  Moments rises;
  for (std::size_t r = 0; r < grains.size(); ++r) rises.add(grains[r][8] - trials[r][8]);
  CAPTURE(rises.mean(), rises.standard_error());
  CHECK(rises.mean() > 3 * rises.standard_error());  // [6]
}
