#include "cli/reports/scene_summary.hpp"

#include <catch2/catch.hpp>

using namespace jostle;

TEST_CASE("A summary leaves tests and intervals out of statements, and nothing else") {
  SceneSummary summary;
  const auto add = [&](const char* name, const char* note, const char* statement) {
    summary.add({.name = name, .axes = {}, .quantities = {}, .notes = {{note, statement}}});
  };
  add("point_0000/motion/displacement", "age", "msd is 0.64 (95 %: 0.5 to 0.8) of that from tap 0");
  add("point_0000/ordering", "verdict", "memoryless (p = 0.4 of shape 1): shape 1.1 (of 2 (two))");
  add("point_0000/steady/z", "verdict", "no drift found of AR(1) (p = 0.4)");
  const std::string text = summary.text(100);
  CHECK_THAT(text, Catch::Contains("msd is 0.64 of that from tap 0\n"));
  CHECK_THAT(text, Catch::Contains("memoryless: shape 1.1\n"));
  CHECK_THAT(text, Catch::Contains("no drift found of AR(1)\n"));
}
