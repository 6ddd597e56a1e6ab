#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/config/scene_files.hpp"

namespace jostle {

namespace {

using EditedScene = nlohmann::ordered_json;

const char* const run = R"({
  "name": "run", "seed": 1, "realizations": 4,
  "container": {"sides": "walls", "width": 8}, "spheres": 512,
  "protocol": [{"tap": {"dilate": 0.02}, "count": 100},
               {"ramp": {"lift": {"from": 0.1, "to": 0.3, "step": 0.1}}, "count": 10}],
  "snapshots": {"taps": [0, 100]},
  "sweep": {"/protocol/0/tap/dilate": [0.01, 0.02]}})";

std::vector<Fault> faults_of_resume(const std::string& was, const std::string& is) {
  const ParsedScene now = parse_scene(is);
  if (!now.scene) throw std::runtime_error(lines(now.faults));
  return resume_faults(parse_scene(was), *now.scene, now.points);
}

/// Message of a resume after a change of the scene above.
template <class Change>
std::string faults_of(const Change& change) {
  EditedScene is = EditedScene::parse(run);
  change(is);
  return lines(faults_of_resume(run, is.dump()));
}

}  // namespace

TEST_CASE("A resume takes the same scene, more taps, more realizations and another name") {
  CHECK(faults_of([](EditedScene&) {}).empty());
  CHECK(faults_of([](EditedScene& scene) { scene["realizations"] = 8; }).empty());
  CHECK(faults_of([](EditedScene& scene) {
          scene["name"] = "longer";
          scene["description"] = "A longer description.";
        }).empty());
  CHECK(faults_of([](EditedScene& scene) {
          scene["protocol"].push_back(EditedScene::parse(R"({"tap": {"lift": 0.3}, "count": 5})"));
          scene["snapshots"]["taps"] = {0, 100, 131, 135};
        }).empty());
}

TEST_CASE("A resume follows the same motion, from further origins and over further lags") {
  const auto faults = [](const char* was, const char* is, std::uint64_t taps) {
    EditedScene scene_before = EditedScene::parse(run), scene_after = scene_before;
    if (was != nullptr) scene_before["motion"] = EditedScene::parse(was);
    if (is != nullptr) scene_after["motion"] = EditedScene::parse(is);
    scene_after["protocol"][1]["count"] = 10;
    if (taps > 0) scene_after["protocol"].push_back({{"tap", {{"lift", 0.3}}}, {"count", taps}});
    return lines(faults_of_resume(scene_before.dump(), scene_after.dump()));
  };
  CHECK(faults("{}", "{}", 0).empty());
  CHECK(faults("{}", "{}", 3000).empty());
  CHECK(faults(R"({"origins": [0, 9]})",
               R"({"origins": [0, 9, 130, 131], "lags": {"log": {"to": 140, "per_decade": 10}}})", 20)
            .empty());
  CHECK(faults(R"({"origins": [0, 9]})", R"({"origins": [0, 8, 9]})", 0) ==
        "/motion: a motion origin at tap 8 was added: only those from the last tap, 130, on can be "
        "(at the sweep point dilate = 0.01)\n");
  CHECK(faults("{}", R"({"lags": [1, 2]})", 0) ==
        "/motion: the motion lag of 3 was removed (at the sweep point dilate = 0.01)\n");
  CHECK(faults("{}", R"({"layers": 6})", 0) ==
        "/motion/layers: was 5, is 6: a resumed run keeps it\n");
  CHECK(faults(nullptr, R"({"layers": 6})", 0) ==
        "/motion: was null, is {\"overlap_lengths\":[0.1,0.3],\"layers\":6}: a resumed run keeps "
        "it\n");
}

TEST_CASE("A resume compares what taps do, not how they are written") {
  CHECK(faults_of([](EditedScene& scene) {
          scene["protocol"] = EditedScene::parse(R"([
            {"tap": {"dilate": 0.02}, "count": 100}, {"tap": {"lift": 0.1}, "count": 10},
            {"tap": {"lift": 0.2}, "count": 3}, {"tap": {"lift": 0.2}, "count": 7},
            {"tap": {"lift": 0.3}, "count": 1000}])");
        }).empty());
}

TEST_CASE("A resume refuses taps that changed, and names the first") {
  CHECK(faults_of([](EditedScene& scene) { scene["protocol"][1]["count"] = 11; }) ==
        "/protocol: tap 111 changed from {\"lift\":0.2} to {\"lift\":0.1}: taps can only be added "
        "after "
        "the last one, 130 (at the sweep point dilate = 0.01)\n");
  CHECK(faults_of([](EditedScene& scene) { scene["protocol"][1]["count"] = 9; }) ==
        "/protocol: had 130 taps, has 127: taps can be added at the end, not removed (at the "
        "sweep point dilate = 0.01)\n");
  CHECK(
      faults_of([](EditedScene& scene) {
        scene["protocol"][0] = EditedScene::parse(R"({"tap": {"dilate": 0.02}, "count": 130})");
      }) ==
      "/protocol: tap 101 changed from {\"lift\":0.1} to {\"dilate\":0.01}: taps can only be added "
      "after the last one, 130 (at the sweep point dilate = 0.01)\n");
}

TEST_CASE("A resume refuses snapshots that changed within the taps of the run") {
  CHECK(faults_of([](EditedScene& scene) {
          scene["snapshots"]["taps"] = {0, 50, 100};
        }) ==
        "/snapshots/taps: a snapshot of tap 50 was added: only those after the last tap, 130, can "
        "be (at the sweep point dilate = 0.01)\n");
  CHECK(faults_of([](EditedScene& scene) {
          scene["snapshots"]["every"] = 50;
        }).starts_with("/snapshots/taps: a snapshot of tap 50 was added"));
  CHECK(faults_of([](EditedScene& scene) { scene["snapshots"]["every"] = 1000; }).empty());
  CHECK(faults_of([](EditedScene& scene) { scene["snapshots"]["taps"] = {100}; }) ==
        "/snapshots/taps: the snapshot of tap 0 was removed (at the sweep point dilate = "
        "0.01)\n");
}

TEST_CASE("A resume keeps the sampler") {
  CHECK(faults_of([](EditedScene& scene) {
          scene["relax"] = {{"sampler", "exhaustive"}};
        }).empty());
  CHECK(faults_of([](EditedScene& scene) {
          scene["relax"] = {{"sampler", "skipping"}};
        }) == "/relax/sampler: was \"exhaustive\", is \"skipping\": a resumed run keeps it\n");
}

TEST_CASE("A resume names everything that changed") {
  const std::string faults = faults_of([](EditedScene& scene) {
    scene["seed"] = 2;
    scene["realizations"] = 3;
    scene["spheres"] = 500;
    scene["container"]["width"] = 9;
    scene["relax"]["polar"]["theta0"] = 1;
    scene["observe"] = {"mean_height"};
    scene["snapshots"]["keep"] = {"positions"};
    scene["sweep"]["/protocol/0/tap/dilate"] = {0.01, 0.03};
  });
  CHECK(
      faults ==
      "/realizations: were 4, are 3: realizations can be added, not removed\n"
      "/seed: was 1, is 2: a resumed run keeps it\n"
      "/container/width: was 8, is 9: a resumed run keeps it\n"
      "/spheres: was 512, is 500: a resumed run keeps it\n"
      "/relax/polar/theta0: was 0.7853981633974483, is 1: a resumed run keeps it\n"
      "/observe: was [\"mean_height\",\"bottom_fraction\",{\"corrected_fraction\":{\"depth\":0.9}}"
      ",{\"bulk_fraction\":{\"name\":\"bulk_fraction\",\"quantiles\":[0.2,0.8]}}], is "
      "[\"mean_height\"]: a resumed run keeps it\n"
      "/snapshots/keep: was [\"positions\",\"coordination\",\"height_histogram\"], is "
      "[\"positions\"]: a resumed run keeps it\n"
      "/sweep: the point dilate = 0.02 is gone: values can be added to a sweep, not removed, and "
      "its keys cannot change\n");
}

TEST_CASE("A resume takes more values of what is swept, in any order") {
  CHECK(faults_of([](EditedScene& scene) {
          scene["sweep"]["/protocol/0/tap/dilate"] = {0.005, 0.02, 0.03, 0.01};
        }).empty());
  // Another kind of axis, with equal points.
  CHECK(faults_of([](EditedScene& scene) {
          scene["sweep"] =
              EditedScene::parse(R"({"zip": {"/protocol/0/tap/dilate": [0.01, 0.02, 0.05]}})");
        }).empty());
}

TEST_CASE("A resume takes nothing else that is swept, and tries the taps of all old points") {
  const char* const gone = "can be added to a sweep, not removed";
  CHECK_THAT(faults_of([](EditedScene& scene) { scene["sweep"]["/spheres"] = {512}; }),
             Catch::Contains(gone));
  CHECK_THAT(faults_of([](EditedScene& scene) { scene.erase("sweep"); }), Catch::Contains(gone));
  CHECK_THAT(faults_of([](EditedScene& scene) {
               scene["sweep"]["/protocol/0/tap/dilate"].push_back(0.03);
               scene["protocol"][1]["count"] = 11;
             }),
             Catch::Contains("tap 111 changed"));
}

TEST_CASE("Scenes that differ in the values of their sweep join") {
  const auto scene_with = [](const char* sweep, const char* name = "run") {
    EditedScene scene = EditedScene::parse(run);
    scene["sweep"] = EditedScene::parse(sweep);
    scene["name"] = name;
    return scene;
  };
  const auto join = [](const EditedScene& a, const EditedScene& b) {
    return join_sweeps(parse_scene(a.dump()), parse_scene(b.dump()));
  };
  const auto low =
      scene_with(R"({"/protocol/0/tap/dilate": [0.02, 0.01], "/spheres": [512, 500]})");
  const auto high =
      scene_with(R"({"/protocol/0/tap/dilate": [0.03, 0.02], "/spheres": [500, 400]})", "high");
  const ParsedScene joined = join(low, high);
  REQUIRE(joined.scene);
  CHECK(resolved(*joined.scene) ==
        resolved(scene_of(scene_with(R"({"/protocol/0/tap/dilate": [0.02, 0.01, 0.03],
                                   "/spheres": [512, 500, 400]})")
                              .dump())));
  const ParsedScene rows =
      join(scene_with(R"({"zip": {"/spheres": [500, 400], "/container/width": [8, 7]}})"),
           scene_with(R"({"zip": {"/spheres": [500, 400], "/container/width": [8, 9]}})"));
  REQUIRE(rows.scene);
  CHECK(resolved(*rows.scene).at("sweep").dump() ==
        R"({"zip":[{"/spheres":[500,400,400],"/container/width":[8,7,9]}]})");

  EditedScene changed = high;
  changed["seed"] = 2;
  changed["relax"] = EditedScene::parse(R"({"polar": {"theta0": 1}})");
  CHECK(lines(join(low, changed).faults) ==
        ": differs in /seed, /relax: only the values of a sweep may\n");
  CHECK_THAT(
      lines(
          join(low, scene_with(R"({"/spheres": [500], "/protocol/0/tap/dilate": [0.1]})")).faults),
      Catch::Contains("/sweep: the same must be swept"));
  CHECK_FALSE(join(scene_with("{}"), scene_with("{}")).scene);
  // Values that the sweep replaces may differ.
  EditedScene base = low;
  base["spheres"] = 300;
  CHECK(join(base, high).scene);
}

TEST_CASE("A resume refuses a scene that this program cannot read") {
  EditedScene bad = EditedScene::parse(run);
  bad["gravity"] = 9.81;
  CHECK(faults_of_resume(bad.dump(), run).size() == 1);
}

}  // namespace jostle
