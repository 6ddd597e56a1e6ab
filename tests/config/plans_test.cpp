#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <map>

#include "tests/config/scene_files.hpp"
#include "tests/monte_carlo_plan.hpp"

namespace jostle {

TEST_CASE("A plan holds the values of the scene") {
  auto json = resolved(scene_of(text_of(good_scenes / "every_key.json")));
  json.erase("sweep");
  json["analyse"].erase("sweep");  // analysis over the sweep
  const auto plans = make_plans(scene_of(json.dump()), {});
  REQUIRE(plans.size() == 1);
  const Plan& plan = plans[0];
  CHECK(plan.seed == 18446744073709551615u);
  CHECK(plan.streams == Streams::matched);
  CHECK(plan.container == Container{WalledBox{12, 16.5}});
  CHECK(plan.n_spheres == 4096);
  CHECK(plan.start == Start{FittedPour{}});
  REQUIRE(plan.protocol.size() == 3 + 16 + 4 + 1);
  CHECK(plan.protocol[3] == Stage{Dilate{0.025 * 0.025}, 2});
  CHECK(plan.protocol[22] == Stage{Dilate{0.1}, 2});
  CHECK(total_taps(plan) == 100 + 10 + 10 + 2 * 16 + 2 * 4 + 1);
  CHECK(monte_carlo(plan).relax.stop.max_sweeps == 20'000);
  CHECK(monte_carlo(plan).relax.sampler == Sampler::rejection_free);
  CHECK(plan.observables.size() == 9);
  CHECK(plan.snapshots.taps == std::vector<std::uint64_t>{0, 1, 3, 10, 32, 100, 120});
  CHECK_FALSE(plan.snapshots.height_histogram);
  CHECK(plan.snapshots.bin_width == 0.05);
}

TEST_CASE("A sweep goes over both engines from a scene of either") {
  for (const char* engine : {"", R"("engine": "monte_carlo", "relax": {"polar": {}},)",
                             R"("engine": {"discrete_element": {}},)"}) {
    const auto plans = make_plans(scene_of(fmt::format(R"({{"seed": 1, {}
      "container": {{"sides": "periodic", "width": 3}}, "spheres": 20,
      "protocol": [{{"tap": {{"lift": 0.1}}, "count": 2}}],
      "sweep": {{"/engine": ["monte_carlo", {{"discrete_element": {{}}}}, "discrete_element"]}}}})",
                                                       engine)),
                                  {});
    REQUIRE(plans.size() == 3);
    CHECK(std::holds_alternative<MonteCarlo>(plans[0].engine));
    CHECK(std::holds_alternative<DiscreteElement>(plans[1].engine));
    CHECK(std::holds_alternative<DiscreteElement>(plans[2].engine));
  }
}

TEST_CASE("Every sweep point keeps the seed and the kind of streams") {
  const Scene scene = scene_of(text_of(good_scenes / "every_key.json"));
  const auto plans = make_plans(scene, {});
  REQUIRE(plans.size() == 4);
  for (const Plan& plan : plans) {
    CHECK(plan.seed == scene.seed);
    CHECK(plan.streams == Streams::matched);
  }
}

TEST_CASE("A packing file is loaded once for all points that name it") {
  const Scene scene = scene_of(R"({
    "seed": 1, "container": {"sides": "periodic", "width": 8}, "spheres": 2,
    "start": {"file": {"path": "a.h5", "point": 2, "realization": 3, "tap": 40}},
    "protocol": [{"tap": {"dilate": 0.02}, "count": 1}],
    "sweep": {"/protocol/0/tap/dilate": [0.01, 0.02], "/start/file/tap": [40, "last"]}})");
  std::map<PackingFile, int> loads;
  const auto load = [&](const PackingFile& file) {
    ++loads[file];
    return Packing{PeriodicBox{8, 8}, {{1, 1, 0.5}, {3, 3, file.tap ? 0.5 : 0.75}}};
  };
  const auto plans = make_plans(scene, load);
  REQUIRE(plans.size() == 4);
  CHECK(loads ==
        std::map<PackingFile, int>{{{"a.h5", 2, 3, 40, {}}, 1}, {{"a.h5", 2, 3, {}, {}}, 1}});
  const auto& first = std::get<GivenPacking>(plans[0].start);
  CHECK(first.centres == std::get<GivenPacking>(plans[2].start).centres);
  CHECK(first.centres->at(1) == Vec3{3, 3, 0.5});
  CHECK(std::get<GivenPacking>(plans[3].start).centres->at(1) == Vec3{3, 3, 0.75});
}

TEST_CASE("A packing file with another number of spheres is a start that cannot be") {
  const Scene scene = scene_of(text_of(good_scenes / "from_results.json"));
  const auto load = [](const PackingFile&) {
    return Packing{PeriodicBox{8, 8}, std::vector<Vec3>(512)};
  };
  CHECK_THROWS_WITH(make_plans(scene, load),
                    "earlier.h5 holds 512 spheres, the scene 4096: set \"spheres\" to 512");
  CHECK_THROWS_AS(make_plans(scene, load), StartError);
}

}  // namespace jostle
