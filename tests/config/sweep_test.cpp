#include "config/sweep.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "tests/config/scene_files.hpp"
#include "tests/monte_carlo_plan.hpp"

namespace jostle {

namespace {

std::string scene_with(const std::string& sweep) {
  return R"({"seed": 1, "container": {"sides": "periodic", "width": 8}, "spheres": 512,
             "protocol": [{"tap": {"dilate": 0.02}, "count": 100}], "sweep": )" +
         sweep + "}";
}

std::vector<Plan> plans(const std::string& sweep) {
  return make_plans(scene_of(scene_with(sweep)), {});
}

double epsilon(const Plan& plan) {
  return std::get<Dilate>(plan.protocol.at(0).tap).epsilon;
}

std::map<std::string, std::uint64_t> ids_by_label(const std::vector<Plan>& plans) {
  std::map<std::string, std::uint64_t> ids;
  for (const Plan& plan : plans) ids[plan.label] = plan.point_id;
  return ids;
}

}  // namespace

TEST_CASE("Axes are crossed, the first varies slowest") {
  const auto points =
      plans(R"({"/protocol/0/tap/dilate": [0.01, 0.05], "/spheres": [256, 512, 300]})");
  REQUIRE(points.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(epsilon(points[i]) == (i < 3 ? 0.01 : 0.05));
    CHECK(points[i].n_spheres == std::vector<std::uint32_t>{256, 512, 300}[i % 3]);
  }
  CHECK(points[4].label == "dilate = 0.05, spheres = 512");
  CHECK(points[4].sweep_values == std::vector<std::pair<std::string, std::string>>{
                                      {"/protocol/0/tap/dilate", "0.05"}, {"/spheres", "512"}});
}

TEST_CASE("Zipped lists vary together and are crossed with the rest") {
  const auto points = plans(R"({"/protocol/0/count": [10, 20],
                                "zip": [{"/spheres": [256, 512], "/container/width": [6, [8, 9]]},
                                        {"/protocol/0/tap/dilate": [0.1]}]})");
  REQUIRE(points.size() == 4);
  CHECK(points[0].container == Container{PeriodicBox{6, 6}});
  CHECK(points[0].n_spheres == 256);
  CHECK(points[1].container == Container{PeriodicBox{8, 9}});
  CHECK(points[1].n_spheres == 512);
  CHECK(points[1].protocol[0].count == 10);
  CHECK(points[2].protocol[0].count == 20);
  for (const Plan& plan : points) CHECK(epsilon(plan) == 0.1);
}

TEST_CASE("A single zipped group needs no list") {
  const auto zipped = plans(R"({"zip": {"/spheres": [256, 512], "/container/width": [6, 8]}})");
  const auto listed = plans(R"({"zip": [{"/spheres": [256, 512], "/container/width": [6, 8]}]})");
  REQUIRE(zipped.size() == 2);
  CHECK(ids_by_label(zipped) == ids_by_label(listed));
}

TEST_CASE("Whole parts of a scene can be swept, and values that are defaults") {
  const auto points = plans(R"({"/protocol/0/tap": [{"lift": 0.25}, {"dilate_floor_held": 0.025}],
                                "/relax/polar/theta0": [0.5]})");
  REQUIRE(points.size() == 2);
  CHECK(points[0].protocol[0].tap == Tap{Lift{0.25}});
  CHECK(points[1].protocol[0].tap == Tap{DilateFloorHeld{0.025}});
  CHECK(std::get<PolarMove>(monte_carlo(points[1]).relax.move).theta0 == 0.5);
  CHECK(points[0].label == "tap = {\"lift\":0.25}, theta0 = 0.5");
}

TEST_CASE("Points have the labels that the scene lists, and keep their ids") {
  const std::string sweep = R"({"/protocol/0/tap/dilate": [0.01, 0.05]})";
  const auto named = plans(sweep + R"(, "point_labels": ["weak", "strong"])"), plain = plans(sweep);
  CHECK(named.at(0).label == "weak");
  CHECK(named.at(1).label == "strong");
  CHECK(plain.at(1).label == "dilate = 0.05");
  CHECK(named.at(1).point_id == plain.at(1).point_id);
}

TEST_CASE("Labels are as many as points, and differ") {
  const std::string sweep = R"({"/protocol/0/tap/dilate": [0.01, 0.05]}, "point_labels": )";
  const auto fault = [&](const std::string& labels) {
    const ParsedScene parsed = parse_scene(scene_with(sweep + labels));
    REQUIRE(parsed.faults.size() == 1);
    return parsed.faults[0].pointer + ": " + parsed.faults[0].message;
  };
  CHECK(fault(R"(["weak"])") ==
        "/point_labels: 1 label for 2 sweep points: list one label for each sweep point, in their "
        "order");
  CHECK(fault(R"(["weak", "weak"])") ==
        "/point_labels/1: \"weak\" is the label of an earlier point: labels must differ");
  CHECK(parse_scene(scene_with(R"({}, "point_labels": ["a"])")).faults.at(0).pointer ==
        "/point_labels");
}

TEST_CASE("Values with the same name are labelled by their whole pointer") {
  const auto points = plans(R"({"/snapshots/bin_width": [0.1], "/snapshots/contact_cut": [1.1]})");
  CHECK(points[0].label == "bin_width = 0.1, contact_cut = 1.1");
  const Scene scene = scene_of(text_of(good_scenes / "hysteresis.json"));
  auto json = resolved(scene);
  json["sweep"]["/protocol/0/count"] = Json::array({1});
  json["sweep"]["/protocol/1/count"] = Json::array({2});
  CHECK(make_plans(scene_of(json.dump()), {})[0].label ==
        "/protocol/0/count = 1, /protocol/1/count = 2");
}

TEST_CASE("An element of a list is named with its list") {
  CHECK(short_name("/protocol/0/tap/dilate") == "dilate");
  CHECK(short_name("/container/width/1") == "width/1");
  CHECK(short_name("/spheres") == "spheres");
}

TEST_CASE("A point's id is a function of its own values") {
  const auto few = ids_by_label(plans(R"({"/protocol/0/tap/dilate": [0.01, 0.05]})"));
  const auto extended =
      ids_by_label(plans(R"({"/protocol/0/tap/dilate": [0.005, 0.01, 0.02, 0.05]})"));
  CHECK(few.at("dilate = 0.01") == extended.at("dilate = 0.01"));
  CHECK(few.at("dilate = 0.05") == extended.at("dilate = 0.05"));
  CHECK(extended.size() == 4);
  std::set<std::uint64_t> distinct;
  for (const auto& [label, id] : extended) distinct.insert(id);
  CHECK(distinct.size() == 4);
}

TEST_CASE("A point's id depends neither on the order of axes nor on how values are written") {
  const auto single = plans(R"({"/spheres": [256], "/protocol/0/tap/dilate": [0.05]})");
  const auto second = plans(R"({"/protocol/0/tap/dilate": [5e-2], "/spheres": [256.0]})");
  CHECK(single[0].point_id == second[0].point_id);
}

// The hash is part of the identity of results: these numbers were computed by an independent
// FNV-1a (Python) over the documented bytes and must never change.
TEST_CASE("A point's id is the documented hash") {
  CHECK(plans("{}")[0].point_id == 0);
  CHECK(plans(R"({"/protocol/0/tap/dilate": [0.005]})")[0].point_id == 0xd3638be4903c49b3u);
  CHECK(plans(R"({"/spheres": [256], "/protocol/0/tap": [{"lift": 0.25}]})")[0].point_id ==
        0xd2abb94c90bbc71bu);
}

TEST_CASE("Without a sweep there is one unnamed point") {
  const auto points = plans("{}");
  REQUIRE(points.size() == 1);
  CHECK(points[0].label.empty());
  CHECK(points[0].sweep_values.empty());
  CHECK(n_sweep_points(scene_of(scene_with("{}"))) == 1);
}

TEST_CASE("Axes keep their order through the resolved scene") {
  const Scene scene = scene_of(scene_with(
      R"({"zip": {"/spheres": [256, 512], "/container/width": [6, 8]},
          "/protocol/0/tap/dilate": [0.01, 0.05]})"));
  const auto plans_before = make_plans(scene, {});
  const auto plans_after = make_plans(scene_of(resolved(scene).dump()), {});
  REQUIRE(plans_before.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(plans_before[i].label == plans_after[i].label);
  CHECK(n_sweep_points(scene) == 4);
}

TEST_CASE("A parsed sweep has the scene of every point") {
  const ParsedScene parsed = parse_scene(
      scene_with(R"({"/spheres": [256, 512], "/relax/polar/max_step": [0.05, 0.1, 0.2]})"));
  REQUIRE(parsed.scene);
  REQUIRE(parsed.points.size() == 6);
  CHECK(parsed.points == point_scenes(*parsed.scene));
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(parsed.points[i].sweep.empty());
    CHECK(parsed.points[i].n_spheres == (i < 3 ? 256 : 512));
    CHECK(std::get<PolarMove>(parsed.points[i].relax.move).max_step ==
          std::vector<double>{0.05, 0.1, 0.2}[i % 3]);
  }
  const ParsedScene alone = parse_scene(scene_with("{}"));
  CHECK(alone.points == std::vector<Scene>{alone.scene.value()});
}

TEST_CASE("Relaxations are null at points of discrete elements") {
  const std::string engines = R"("/engine": ["monte_carlo", {"discrete_element": {}}], )";
  const auto faults = [&](const std::string& values) {
    return lines(parse_scene(scene_with(R"({"zip": {)" + engines + values + "}}")).faults);
  };
  CHECK(faults(R"("/relax": [{"polar": {"max_step": 0.1}}, null])").empty());
  CHECK(faults(R"("/relax": [{"polar": {}}, {"polar": {}}])").find("give null here") !=
        std::string::npos);
  CHECK(faults(R"("/relax": [null, null])").find("/sweep/zip/~1relax/0") != std::string::npos);
}

TEST_CASE("The law of contacts decides the steps of a contact at each point") {
  const auto points = [](const std::string& settings, const std::string& swept) {
    const std::string grains = scene_with(swept);
    const std::string text = grains.substr(0, grains.size() - 1) +
                             R"(, "engine": {"discrete_element": {)" + settings + "}}}";
    const Scene scene = scene_of(text);
    CHECK(scene_of(resolved(scene).dump()) == scene);
    std::vector<double> steps;
    for (const Scene& point : point_scenes(scene)) steps.push_back(steps_of_contact(*point.grains));
    return steps;
  };
  const std::string laws =
      R"("/engine/discrete_element/contact": [{"walton_braun": {}}, {"linear_spring_dashpot": {}}])";
  CHECK(points("", "{" + laws + "}") == std::vector<double>{40, 160});
  CHECK(points(R"("steps_per_contact": 40)", "{" + laws + "}") == std::vector<double>{40, 40});
  CHECK(points("", R"({"/engine/discrete_element/steps_per_contact": [50, 80], )" + laws + "}") ==
        std::vector<double>{50, 50, 80, 80});
}

TEST_CASE("Points observe by default the kinds that they have") {
  const auto names = [](const std::string& further) {
    const std::string kinds =
        R"("/spheres": [[{"name": "a", "count": 90, "diameter": 1}, {"name": "b", "count": 9, "diameter": 2}],
                        [{"name": "a", "count": 90, "diameter": 1}, {"name": "c", "count": 9, "diameter": 2}],
                        64])";
    const std::string text = scene_with("{" + kinds + "}");
    const Scene scene = scene_of(text.substr(0, text.size() - 1) + further + "}");
    CHECK(scene_of(resolved(scene).dump()) == scene);
    std::vector<std::string> last;
    for (const Scene& point : point_scenes(scene))
      last.push_back(label(point.observables.back()).name);
    return last;
  };
  CHECK(names("") == std::vector<std::string>{"height_b", "height_c", "bulk_fraction"});
  CHECK(names(R"(, "observe": ["mean_height"])") == std::vector<std::string>(3, "mean_height"));
}

}  // namespace jostle
