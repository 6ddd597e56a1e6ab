#include "config/ladder.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "config/grids.hpp"
#include "tests/config/scene_files.hpp"
#include "tests/monte_carlo_plan.hpp"
#include "tests/test_files.hpp"

namespace jostle {

namespace {

Scene shipped(const std::string& name) {
  return scene_of(text_of(std::filesystem::path(source_file("config/scenes")) / name));
}

const Relaxation& relax_of(const PilotSetting& setting) {
  return std::get<MonteCarlo>(setting.engine).relax;
}

std::set<std::string> names(const std::vector<PilotSetting>& settings) {
  std::set<std::string> all;
  for (const PilotSetting& setting : settings) all.insert(setting.name);
  return all;
}

}  // namespace

TEST_CASE("A ladder of a mean-height stop goes up and down from the scene's eta") {
  const Scene scene = shipped("quickstart.json");
  const std::vector<PilotSetting> settings = ladder(scene);
  CHECK(settings.front().part == PilotSetting::Part::scene);
  CHECK(relax_of(settings.front()) == scene.relax);
  CHECK(names(settings) == std::set<std::string>{"as the scene", "eta = 0.001", "eta = 0.0001",
                                                 "eta = 1e-06", "eta = 1e-07",
                                                 "test every 10 sweeps", "test every 1000 sweeps",
                                                 "d_max = 0.05", "d_max = 0.2", "theta_0 = 0.393",
                                                 "theta_0 = 1.57", "half the footprint"});
  const MostComplete best = most_complete(settings);
  CHECK(settings[best.last].name == "eta = 1e-07");
  CHECK(settings[best.second_last].name == "eta = 1e-06");
  const Stop& complete = relax_of(settings[best.last]).stop;
  CHECK(std::get<MeanHeightStop>(complete.rule).eta == 1e-7);
  CHECK(complete.max_sweeps == 100 * scene.relax.stop.max_sweeps);
}

TEST_CASE("A ladder has settings below the least normal double") {
  Scene scene = shipped("quickstart.json");
  std::get<MeanHeightStop>(scene.relax.stop.rule).eta = 1e-307;
  const std::vector<PilotSetting> settings = ladder(scene);
  const Stop& complete = relax_of(settings[most_complete(settings).last]).stop;
  CHECK(std::get<MeanHeightStop>(complete.rule).eta == Approx(1e-309).epsilon(1e-10));
}

TEST_CASE("A published bulk-fraction stop is compared with a complete one by mean height") {
  const std::vector<PilotSetting> settings =
      ladder(shipped("rosato-dybenko-2010/fig4-published-stop.json"));
  const auto all = names(settings);
  CHECK(all.contains("change = 0.0001"));
  CHECK(settings[most_complete(settings).last].name == "mean height, eta = 1e-06");
  CHECK(all.contains("fixed delta"));
  CHECK(all.contains("delta of falling trials, 2 %"));
}

TEST_CASE("Between walls the other of the two pours is a setting") {
  const auto start_settings = [](const Scene& scene) {
    std::vector<StartChoice> found;
    for (const PilotSetting& setting : ladder(scene)) {
      if (setting.part == PilotSetting::Part::start) found.push_back(setting.start);
    }
    return found;
  };
  Scene scene = shipped("philippe-bideau-2001/fig10.json");
  CHECK(start_settings(scene) == std::vector<StartChoice>{SteepestDescentPour{}});
  scene.start = SteepestDescentPour{};
  CHECK(start_settings(scene) == std::vector<StartChoice>{FittedPour{}});
  // Too narrow for the periodic pour that is to be fitted.
  scene.container = WalledBox{2, 16};
  CHECK(start_settings(scene).empty());
  CHECK(start_settings(shipped("quickstart.json")).empty());
  // A direct pour takes no relaxation before tap 0, so a scene that has one has no such pair.
  Scene relaxed = shipped("philippe-bideau-2001/fig10.json");
  relaxed.relax_start = relaxed.relax;
  CHECK(start_settings(relaxed).empty());
}

TEST_CASE("A bulk fraction is read through a narrower, a wider and a tapered window, too") {
  Scene scene = shipped("quickstart.json");
  scene.observables = {MeanHeight{}, BulkFraction{}, BulkFraction{"low", HeightWindow{2, 6}}};
  std::vector<OtherWindow> windows = other_windows(scene);
  REQUIRE(windows.size() == 5);
  CHECK(windows[0].name == "bulk_fraction");
  CHECK(windows[0].observable == BulkFraction{"bulk_fraction_narrow", QuantileWindow{0.35, 0.65}});
  CHECK(windows[1].observable == BulkFraction{"bulk_fraction_wide", QuantileWindow{0.1, 0.9}});
  CHECK(windows[2].observable ==
        BulkFraction{"bulk_fraction_tapered", QuantileWindow{0.2, 0.8}, 0.8165});
  CHECK(windows[3].name == "low");
  CHECK(windows[3].observable == BulkFraction{"low_narrow", HeightWindow{3, 5}});
  CHECK(windows[4].observable == BulkFraction{"low_tapered", HeightWindow{2, 6}, 0.8165});
  // A name that the scene has already is left alone.
  scene.observables.push_back(BulkFraction{"low_narrow", HeightWindow{1, 2}});
  windows = other_windows(scene);
  CHECK(windows[3].observable.name == "low_tapered");
  CHECK(windows.back().observable.name == "low_narrow_tapered");
  CHECK(windows.size() == 6);
  // A taper stays, and needs its half above the floor.
  scene.observables = {BulkFraction{"low", HeightWindow{2, 6}, 0.5},
                       BulkFraction{"lowest", HeightWindow{0.25, 2}}};
  windows = other_windows(scene);
  REQUIRE(windows.size() == 2);
  CHECK(windows[0].observable == BulkFraction{"low_narrow", HeightWindow{3, 5}, 0.5});
  CHECK(windows[1].observable.name == "lowest_narrow");
}

TEST_CASE("A ladder of an absolute stop goes up and down from the scene's change") {
  Scene scene = shipped("quickstart.json");
  scene.relax.stop.rule = HeightChangeStop{.change = 1e-3, .every_sweeps = 50};
  const std::vector<PilotSetting> settings = ladder(scene);
  const auto all = names(settings);
  for (const char* name : {"change = 0.1 d", "change = 0.01 d", "change = 0.0001 d",
                           "change = 1e-05 d", "test every 5 sweeps", "test every 500 sweeps"}) {
    CAPTURE(name);
    CHECK(all.contains(name));
  }
  CHECK(settings[most_complete(settings).last].name == "change = 1e-05 d");
}

TEST_CASE("A ladder of discrete elements varies their rest, time step and stiffness") {
  Scene scene = shipped("rosato-dybenko-2010/fig10.json");
  scene.grains = DiscreteElement{};
  scene.grains->floor = WaltonBraun{.stiffness = 2e5};
  std::vector<PilotSetting> settings = ladder(scene);
  CHECK(names(settings) == std::set<std::string>{"as the scene", "quiet below 0.005 m g d",
                                                 "quiet below 0.0005 m g d", "quiet for 0.1 s",
                                                 "quiet for 0.5 s", "80 steps per contact",
                                                 "160 steps per contact", "ten times softer",
                                                 "ten times stiffer", "half the footprint"});
  CHECK(settings[most_complete(settings).last].name == "quiet for 0.5 s");
  for (const PilotSetting& setting : settings) {
    const auto& grains = std::get<DiscreteElement>(setting.engine);
    if (setting.name == "ten times softer") {
      CHECK(std::get<WaltonBraun>(grains.spheres).stiffness == 1e4);
      CHECK(std::get<WaltonBraun>(*grains.floor).stiffness == 2e4);
    }
    if (setting.name == "quiet for 0.5 s") CHECK(grains.most_seconds == Approx(5.48));
  }
  // A fixed time, more steps than the fewest, and springs that cannot be softer.
  scene.grains = DiscreteElement{};
  scene.grains->rest = TimedRest{0.4};
  scene.grains->steps_per_contact = 100;
  scene.grains->spheres = LinearSpringDashpot{.stiffness = 5};
  settings = ladder(scene);
  const auto all = names(settings);
  for (const char* name :
       {"0.1 s after the floor", "0.2 s after the floor", "0.8 s after the floor",
        "1.6 s after the floor", "50 steps per contact", "ten times stiffer"}) {
    CAPTURE(name);
    CHECK(all.contains(name));
  }
  CHECK_FALSE(all.contains("ten times softer"));
  CHECK(settings[most_complete(settings).last].name == "1.6 s after the floor");
}

TEST_CASE("Every shipped scene has a ladder whose scene is one, in pairs from the same beds") {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           std::filesystem::path(source_file("config/scenes")))) {
    if (entry.path().extension() != ".json") continue;
    INFO(entry.path());
    const Scene scene = scene_of(text_of(entry.path()));
    const std::vector<PilotSetting> settings = ladder(scene);
    const Scene pilot = scene_of(resolved(ladder_scene(scene, settings, 7)).dump());
    const std::vector<Plan> plans = make_plans(pilot, {});
    REQUIRE(plans.size() == settings.size());
    for (std::size_t i = 0; i < plans.size(); ++i) {
      if (scene.grains) {
        CHECK(plans[i].engine == settings[i].engine);
      } else {
        CHECK(monte_carlo(plans[i]).relax == relax_of(settings[i]));
        CHECK(monte_carlo(plans[i]).relax_start.value_or(scene.relax) ==
              scene.relax_start.value_or(scene.relax));
      }
      CHECK(plans[i].streams == Streams::matched);
      CHECK(total_taps(plans[i]) == std::min<std::uint64_t>(7, total_taps(scene.protocol)));
      CHECK(plans[i].snapshots.taps.empty());
      const bool another = settings[i].part == PilotSetting::Part::start;
      CHECK((plans[i].start == plans[0].start) != another);
      CHECK(plans[i].observables.size() == scene.observables.size() + other_windows(scene).size());
    }
  }
}

}  // namespace jostle
