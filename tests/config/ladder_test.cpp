#include "config/ladder.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "tests/config/scene_files.hpp"

namespace jostle {

namespace {

Scene shipped(const std::string& name) {
  return scene_of(text_of(std::filesystem::path(SOURCE_ROOT) / "config" / "scenes" / name));
}

std::set<std::string> names(const std::vector<Rung>& rungs) {
  std::set<std::string> all;
  for (const Rung& rung : rungs) all.insert(rung.name);
  return all;
}

}  // namespace

TEST_CASE("A ladder of a mean-height stop goes up and down from the scene's eta") {
  const Scene scene = shipped("quickstart.json");
  const std::vector<Rung> rungs = ladder(scene);
  CHECK(rungs.front().part == Rung::Part::scene);
  CHECK(rungs.front().relax == scene.relax);
  CHECK(names(rungs) == std::set<std::string>{"as the scene", "eta = 0.001", "eta = 0.0001",
                                              "eta = 1e-06", "eta = 1e-07", "test every 10 sweeps",
                                              "test every 1000 sweeps", "d_max = 0.05",
                                              "d_max = 0.2", "half the footprint"});
  const MostComplete best = most_complete(rungs);
  CHECK(rungs[best.last].name == "eta = 1e-07");
  CHECK(rungs[best.before].name == "eta = 1e-06");
  const Stop& complete = rungs[best.last].relax.stop;
  CHECK(std::get<MeanHeightStop>(complete.rule).eta == 1e-7);
  CHECK(complete.max_sweeps == 100 * scene.relax.stop.max_sweeps);
}

TEST_CASE("A published bulk-fraction stop is compared with a complete one by mean height") {
  const std::vector<Rung> rungs = ladder(shipped("rosato-dybenko-2010/fig4-published-stop.json"));
  const auto all = names(rungs);
  CHECK(all.contains("change = 0.0001"));
  CHECK(rungs[most_complete(rungs).last].name == "mean height, eta = 1e-06");
  CHECK(all.contains("fixed delta"));
  CHECK(all.contains("delta of falling trials, 2 %"));
}

TEST_CASE("Every shipped scene has a ladder whose scene is one, in pairs from the same beds") {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           std::filesystem::path(SOURCE_ROOT) / "config" / "scenes")) {
    if (entry.path().extension() != ".json") continue;
    INFO(entry.path());
    const Scene scene = scene_of(text_of(entry.path()));
    const std::vector<Rung> rungs = ladder(scene);
    const Scene pilot = scene_of(resolved(ladder_scene(scene, rungs, 7)).dump());
    const std::vector<Plan> plans = make_plans(pilot, {});
    REQUIRE(plans.size() == rungs.size());
    for (std::size_t i = 0; i < plans.size(); ++i) {
      CHECK(plans[i].relax == rungs[i].relax);
      CHECK(plans[i].streams == Streams::matched);
      CHECK(total_taps(plans[i]) == 7);
      CHECK(plans[i].snapshots.taps.empty());
      CHECK(plans[i].relax_start.value_or(scene.relax) == scene.relax_start.value_or(scene.relax));
      CHECK(plans[i].start == plans[0].start);
    }
  }
}

}  // namespace jostle
