#include "cli/reports/effects.hpp"

#include <catch2/catch.hpp>

#include "tests/config/scene_files.hpp"

using namespace jostle;
using Catch::Matchers::Contains;

TEST_CASE("Every part of a scene is among its effects, on or off") {
  for (const auto& path : json_files(shipped_scenes)) {
    CAPTURE(path);
    const Scene scene = scene_of(text_of(path));
    const std::string text = effects_text(resolved(scene));
    const auto lists = [&](const std::string& part, bool enabled) {
      const bool has_line = text.find("\n  " + part + " ") != std::string::npos;
      CHECK(has_line == enabled);
      if (!enabled) CHECK(text.find(part, text.find("\n  off ")) != std::string::npos);
    };
    for (const char* part : {"container", "start", "observe"}) lists(part, true);
    lists("protocol", !scene.protocol.empty());
    lists(scene.grains ? "engine" : "relax", true);
    lists("motion", scene.motion.has_value());
    lists("sweep", !scene.sweep.empty());
    lists("until", !scene.until.targets.empty());
    lists("fits", !scene.fits.empty());
    lists("analyse", !scene.analyse.empty());
    lists("structure", !scene.structure.empty());
  }
}

TEST_CASE("Effects are named with their settings") {
  const Scene scene = scene_of(text_of(shipped_scenes / "quickstart.json"));
  const std::string text = effects_text(resolved(scene));
  CHECK_THAT(text, Contains("sides periodic, width 8") &&
                       Contains("tap (dilate 0.02), count 100") && Contains("sampler exhaustive") &&
                       Contains("off        motion, sweep, until, fits, "
                                "analyse, structure\n"));
}

TEST_CASE("A value that the sweep replaces is swept, at any place") {
  const std::string text = effects_text(Json::parse(
      R"({"container": {"sides": "periodic", "width": [8, 9]},
          "protocol": [{"tap": {"dilate": 0.02}, "count": 5}, {"tap": {"lift": 1}, "count": 7}],
          "relax": {"polar": {"max_step": 0.1}, "stop": {"sweeps": 5}},
          "sweep": {"/protocol/0/tap/dilate": [0.1, 0.3], "/engine": ["monte_carlo"],
                    "zip": [{"/container/width/1": [4, 5], "/protocol/1/tap": [{"lift": 2}]}]}})"));
  CHECK_THAT(text, Contains("tap (dilate swept), count 5; tap swept, count 7\n") &&
                       Contains("width 8; swept\n") && Contains("engine     swept\n") &&
                       Contains("relax      polar (max_step 0.1)") && Contains("dilate 0.1; 0.3") &&
                       !Contains("0.02") && !Contains("lift 1"));
}

TEST_CASE("A list that is left to a default is not printed") {
  const std::string text = effects_text(Json::parse(
      R"({"until": {"targets": [{"observable": "mean_height", "taps": [], "sigma": 0.05}]}})"));
  CHECK_THAT(text, Contains("targets observable mean_height, sigma 0.05\n"));
}

TEST_CASE("A long list is named by its first values, its last and their number") {
  std::string values = "1";
  for (int i = 2; i <= 100; ++i) values += ", " + std::to_string(i);
  const std::string text = effects_text(Json::parse(R"({"sweep": {"count": [)" + values + "]}}"));
  CHECK_THAT(text, Contains("count 1; 2; 3; 4; 5; 6; 7; 8; 9; 10; ...; 100 (100 values)\n"));
}
