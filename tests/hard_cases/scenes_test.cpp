#include <catch2/catch.hpp>

#include "ensemble/realization.hpp"
#include "tests/config/scene_files.hpp"
#include "tests/hard_cases/mutations.hpp"

using namespace jostle;
using OrderedJson = nlohmann::ordered_json;

namespace {

/// Refused with a reason for every fault, or read, and read again from its resolved form. Returns
/// whether it was read.
bool holds(const std::string& text) {
  const ParsedScene parsed = parse_scene(text);
  CHECK(parsed.scene.has_value() == parsed.faults.empty());
  for (const Fault& fault : parsed.faults) CHECK_FALSE(fault.message.empty());
  if (!parsed.scene) return false;
  const ParsedScene repeated = parse_scene(resolved(*parsed.scene).dump());
  REQUIRE(repeated.scene);
  CHECK(*repeated.scene == *parsed.scene);
  CHECK(n_sweep_points(*parsed.scene) >= 1);
  return true;
}

/// A scene of milliseconds with most parts that a scene can have.
const char* const small_scene = R"({
  "seed": 1, "realizations": 2, "spheres": 40, "container": {"sides": "periodic", "width": 3},
  "start": {"pour": "steepest_descent"},
  "protocol": [{"tap": {"dilate": 0.05}, "count": 2}, {"tap": {"lift": 0.1}, "count": 1},
               {"tap": {"shake": {"lambda": 0.02, "lateral_radius": 0.05}}, "count": 1}],
  "relax": {"metropolis": {"max_step": 0.2, "beta": 10,
                           "adapt": {"factor": 0.9, "every_trials": 100}},
            "stop": {"bulk_fraction": {"change": 0.001, "every_trials": 1000, "times": 2}},
            "max_sweeps": 200},
  "observe": ["mean_height", "bottom_fraction"],
  "snapshots": {"taps": [0, 2]}})";

/// The first trials of every realization of a scene: refused by name or without overlap.
void run_a_little(const Scene& scene) {
  if (std::holds_alternative<PackingFile>(scene.start)) return;
  for (const Plan& plan : make_plans(scene, {})) {
    if (plan.n_spheres > 100 || width_x(plan.container) > 100) continue;
    Realization realization(plan, 0);
    try {
      for (int slice = 0; slice < 8 && !realization.finished(); ++slice) {
        realization.advance(2000);
      }
      const Packing packing{plan.container, realization.state().centres};
      CHECK(deepest_overlap_brute_force(packing).depth <= overlap_bound(packing));
    } catch (const StartError& error) {
      CHECK(std::string(error.what()).size() > 10);
    }
  }
}

void check_changed_structures(int changes) {
  std::uint64_t seed = 1000, read = 0, tried = 0;
  for (const auto& path : json_files(shipped_scenes)) {
    CAPTURE(path);
    RandomStream random = mutation_stream(++seed);
    const OrderedJson scene = OrderedJson::parse(text_of(path));
    for (int k = 0; k < changes; ++k) {
      const std::string mutated = mutated_structure(scene, random).dump();
      CAPTURE(mutated);
      read += holds(mutated);
      ++tried;
    }
  }
  CHECK(read > 0);
  CHECK(read < tried);
}

}  // namespace

TEST_CASE("every shipped scene with bytes changed at random is refused by name or read") {
  std::uint64_t seed = 0, read = 0, tried = 0;
  for (const auto& path : json_files(shipped_scenes)) {
    CAPTURE(path);
    RandomStream random = mutation_stream(++seed);
    const std::string text = text_of(path);
    for (int k = 0; k < 500; ++k) {
      const std::string mutated = mutated_bytes(text, random);
      CAPTURE(mutated);
      read += holds(mutated);
      ++tried;
    }
  }
  CHECK(read > 0);
  CHECK(read < tried);
}

TEST_CASE("every shipped scene with its structure changed at random is refused by name or read") {
  check_changed_structures(150);
}

TEST_CASE("every shipped scene with its structure changed in many ways is refused by name or read",
          "[slow]") {
  check_changed_structures(1000);
}

TEST_CASE("what is read of a small scene changed at random runs without overlap") {
  RandomStream random = mutation_stream(5000);
  const OrderedJson scene = OrderedJson::parse(small_scene);
  REQUIRE(holds(small_scene));
  int run = 0;
  for (int k = 0; k < 3000; ++k) {
    const std::string mutated = mutated_structure(scene, random).dump();
    CAPTURE(mutated);
    const ParsedScene parsed = parse_scene(mutated);
    if (!parsed.scene || n_sweep_points(*parsed.scene) > 10) continue;
    run_a_little(*parsed.scene);
    ++run;
  }
  CHECK(run > 100);
}
