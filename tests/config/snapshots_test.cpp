#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "tests/config/scene_files.hpp"

namespace jostle {

namespace {

std::string scene_with(const std::string& settings) {
  return R"({"seed": 1, "container": {"sides": "periodic", "width": 4}, "spheres": 10,
             "start": {"random_settle": {}}, "protocol": [], )" +
         settings + "}";
}
const std::string grains = R"("engine": {"discrete_element": {}})";
const std::string all_kept =
    R"(["positions","coordination","height_histogram","velocities","contacts",)"
    R"("granular_temperature","forces"])";

Json kept(const std::string& text) {
  return resolved(scene_of(text)).at("snapshots").at("keep");
}

}  // namespace

TEST_CASE("By default snapshots keep everything that the engine has at the end of a tap") {
  CHECK(kept(scene_with(grains)).dump() == all_kept);
  CHECK(kept(scene_with(grains + R"(, "snapshots": {"taps": [0]})")).dump() == all_kept);
  CHECK(kept(scene_with(R"("snapshots": {"taps": [0]})")).dump() ==
        R"(["positions","coordination","height_histogram"])");
  const Scene chosen =
      scene_of(scene_with(grains + R"(, "snapshots": {"keep": ["positions", "contacts"]})"));
  CHECK(chosen.snapshots.contacts);
  CHECK_FALSE(chosen.snapshots.velocities);
  CHECK_FALSE(chosen.snapshots.driven_temperature);
  const Scene driven =
      scene_of(scene_with(grains + R"(, "snapshots": {"keep": ["driven_temperature"]})"));
  CHECK(make_plans(driven, {}).at(0).snapshots.driven_temperature);
  CHECK(scene_of(resolved(driven).dump()) == driven);
  const Snapshots plan = make_plans(chosen, {}).at(0).snapshots;
  CHECK(plan.contacts);
  CHECK_FALSE(plan.forces);
}

namespace {

std::string scene_of_taps(int count, const std::string& settings) {
  return R"({"seed": 1, "container": {"sides": "periodic", "width": 4}, "spheres": 10,
             "start": {"random_settle": {}}, "relax": {"polar": {}, "stop": {"sweeps": 3}},
             "observe": ["mean_height"], "protocol": [{"tap": {"dilate": 0.05}, "count": )" +
         std::to_string(count) + "}], " + settings + "}";
}

std::vector<std::uint64_t> kept_taps(const std::string& text) {
  return make_plans(scene_of(text), {}).at(0).snapshots.taps;
}

}  // namespace

TEST_CASE("Snapshots at regular taps, beside those that are named") {
  using Taps = std::vector<std::uint64_t>;
  CHECK(kept_taps(scene_of_taps(25, R"("snapshots": {"every": 10})")) == Taps{0, 10, 20});
  CHECK(kept_taps(scene_of_taps(20, R"("snapshots": {"every": 10, "taps": [3, 10]})")) ==
        Taps{0, 3, 10, 20});
  CHECK(kept_taps(scene_of_taps(3, R"("snapshots": {"every": "all"})")) == Taps{0, 1, 2, 3});
  const Scene scene = scene_of(scene_of_taps(25, R"("snapshots": {"every": "all"})"));
  CHECK(scene_of(resolved(scene).dump()) == scene);
  CHECK_FALSE(resolved(scene_of(scene_of_taps(25, R"("snapshots": {"taps": [0]})")))
                  .at("snapshots")
                  .contains("every"));
  const auto faults = [](int count, const char* every) {
    return lines(
        parse_scene(scene_of_taps(count, fmt::format(R"("snapshots": {{"every": {}}})", every)))
            .faults);
  };
  CHECK(faults(1'000'000'000, "\"all\"").find("give 10001 or more") != std::string::npos);
  for (const char* every : {"0", "-1", "2.5", "\"none\"", "[10]"}) {
    CAPTURE(every);
    CHECK(faults(25, every).find("/snapshots/every") != std::string::npos);
  }
}

TEST_CASE("A fit has one law, a list of laws that compete, or all of them") {
  const auto models = [](const char* model) {
    return scene_of(scene_of_taps(
                        9, fmt::format(R"("fits": [{{"observable": "mean_height", "model": {}}}])",
                                       model)))
        .fits.at(0)
        .models;
  };
  using Names = std::vector<std::string>;
  CHECK(models("\"kww\"") == Names{"kww"});
  CHECK(models("\"all\"") == Names{"all"});
  CHECK(models("[\"kww\", \"inverse_log\"]") == Names{"kww", "inverse_log"});
  const Scene scene = scene_of(scene_of_taps(
      9, R"("fits": [{"observable": "mean_height", "model": ["kww", "inverse_log"]}])"));
  CHECK(scene_of(resolved(scene).dump()) == scene);
  for (const char* model : {"[]", "[\"kww\", \"kww\"]", "[\"all\"]", "[1]", "\"none\""}) {
    CAPTURE(model);
    CHECK(lines(parse_scene(
                    scene_of_taps(
                        9, fmt::format(R"("fits": [{{"observable": "mean_height", "model": {}}}])",
                                       model)))
                    .faults)
              .find("/fits/0/model") != std::string::npos);
  }
}

TEST_CASE("Points of both engines keep by default what each has") {
  const std::string sweep =
      R"(, "sweep": {"/engine": [{"discrete_element": {}}, {"monte_carlo": {}}]})";
  const Scene scene = scene_of(scene_with(grains + sweep));
  const std::vector<Plan> plans = make_plans(scene, {});
  REQUIRE(plans.size() == 2);
  CHECK(plans[0].snapshots.velocities);
  CHECK_FALSE(plans[1].snapshots.velocities);
  CHECK(plans[1].snapshots.positions);
  CHECK(scene_of(resolved(scene).dump()) == scene);
}

TEST_CASE(
    "Data that an engine does not have, or that need positions, cannot be kept without them") {
  const auto faults = [](const std::string& settings) {
    return lines(parse_scene(scene_with(settings)).faults);
  };
  CHECK(faults(R"("snapshots": {"keep": ["positions", "forces"]})") ==
        "/snapshots/keep: \"forces\" requires discrete elements: Monte Carlo has no times and no "
        "forces; remove it\n");
  CHECK(faults(R"("snapshots": {"keep": ["driven_temperature"]})")
            .starts_with("/snapshots/keep: \"driven_temperature\" requires discrete elements"));
  CHECK(faults(grains + R"(, "snapshots": {"keep": ["velocities"]})") ==
        "/snapshots/keep: \"velocities\" requires positions: keep positions, too\n");
  CHECK(faults(grains + R"(, "snapshots": {"keep": ["forces", "granular_temperature"]})").empty());
}

}  // namespace jostle
