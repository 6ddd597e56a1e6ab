#include "study/running/run.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <set>
#include <thread>

#include "results/run/live_run.hpp"
#include "study/planning/shards.hpp"
#include "study/running/scene_tables.hpp"
#include "study/tables/points/point_scenes.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;

namespace {

/// Milliseconds: two sweep points of two realizations, with all that a scene can ask for.
std::string scene_text(const std::string& settings = "") {
  return R"({"name": "small", "seed": 12, "realizations": 2,
    "container": {"sides": "periodic", "width": 4}, "spheres": 40,
    "protocol": [{"tap": {"dilate": 0.05}, "count": 12}],
    "relax": {"polar": {}, "stop": {"sweeps": 20}},
    "observe": ["mean_height", "bottom_fraction"],
    "sweep": {"/protocol/0/tap/dilate": [0.02, 0.1]})" +
         settings + "}";
}

const std::string wishes = R"(, "snapshots": {"taps": [0, 12]},
    "fits": [{"observable": "mean_height", "model": "kww"}],
    "analyse": {"sweep": [{"observable": "mean_height", "last": 2},
                          {"observable": "mean_height", "quantity": "kww/rho_inf"}]},
    "structure": {"profile": {}})";

LoadedScene load(const TemporaryFolder& folder, const std::string& text) {
  const std::string path = folder / "scene.json";
  std::ofstream(path) << text;
  return load_scene(path);
}

/// Keeps the received progress.
class Heard : public RunObserver, public TablesObserver {
 public:
  void computing(const Progress&, const WorkAhead& ahead, std::uint64_t pending,
                 std::uint64_t all) override {
    said.push_back("computing");
    last = ahead;
    n_pending = pending;
    n_all = all;
  }
  void computed() override { said.emplace_back("computed"); }
  void stored() override { said.emplace_back("stored"); }
  void compared(const PrecisionStatus&) override { said.emplace_back("compared"); }
  void fitted(const FittedCurve&) override { ++fits; }
  void analysed(const Table&) override { ++tables; }
  void without_structure(const std::string& reason) override { said.push_back(reason); }

  std::vector<std::string> said;
  WorkAhead last;
  std::uint64_t n_pending = 0, n_all = 0;
  int fits = 0, tables = 0;
};

}  // namespace

TEST_CASE("A run of a scene fills its file, and informs its observer") {
  const TemporaryFolder folder;
  const LoadedScene loaded = load(folder, scene_text(wishes));
  Heard heard;
  SceneRun run(loaded, {.output = folder / "out.h5"}, heard);
  CHECK(run.results().state() == RunState::running);
  CHECK(run.compute_until_precise());
  CHECK(heard.said == std::vector<std::string>{"computing", "computed", "stored"});
  CHECK(heard.last.realizations == 4);
  CHECK(heard.last.taps == 48);
  CHECK(heard.n_pending == 4);
  CHECK(heard.n_all == 4);
  CHECK(run.summary().done == 4);
  CHECK(run.results().state() == RunState::complete);
  CHECK(run.results().series(0).front().n_taps == 13);

  const ResultsFile file = run.close();
  const auto names = store_scene_tables(file, 1, heard);
  CHECK(heard.fits == 2);
  CHECK(heard.tables == 5);  // two sweeps, profiles of two points, their comparison
  const ResultsFile stored(file.path());
  const auto in_file = stored.table_names();
  CHECK(std::set<std::string>(names.begin(), names.end()) ==
        std::set<std::string>(in_file.begin(), in_file.end()));
  CHECK(in_file.size() == 7);
  // The sweep of a fit was drawn of the fits just made.
  for (const Table& table : stored.tables("analysis")) {
    CAPTURE(table.name);
    for (const auto& [name, text] : table.notes) {
      CHECK(text.find("is not kept") == std::string::npos);  // like a missing fit
    }
  }
}

TEST_CASE("A file that is there is kept, resumed or replaced") {
  const TemporaryFolder folder;
  const std::string output = folder / "out.h5";
  const LoadedScene loaded = load(folder, scene_text());
  RunObserver nobody;
  CHECK(SceneRun(loaded, {.output = output}, nobody).compute());
  const std::string digest = digest_of(output);

  CHECK_THROWS_AS(SceneRun(loaded, {.output = output}, nobody), OutputExists);
  CHECK(digest_of(output) == digest);
  {
    Heard heard;
    SceneRun repeated(loaded, {.output = output, .existing = Existing::resume}, heard);
    CHECK(repeated.compute());
    CHECK(heard.n_pending == 0);
  }
  CHECK(digest_of(output) == digest);
  const auto resume_shard = [&] {
    SceneRun(loaded, {.output = output, .existing = Existing::resume, .shard = {1, 2}}, nobody);
  };
  CHECK_THROWS_AS(resume_shard(), OtherShard);

  LoadedScene changed = load(folder, scene_text(R"(, "streams": "matched")"));
  try {
    SceneRun(changed, {.output = output, .existing = Existing::resume}, nobody);
    FAIL("another scene was resumed");
  } catch (const OtherScene& error) {
    CHECK(error.path() == output);
    CHECK(error.differences().starts_with("/streams: "));
    CHECK(std::string(error.what()).find("--") == std::string::npos);
  }
  CHECK(digest_of(output) == digest);
  CHECK(SceneRun(changed, {.output = output, .existing = Existing::replace}, nobody).compute());
  CHECK(digest_of(output) != digest);
}

TEST_CASE("Realizations are added until their spread is small, and a share cannot decide") {
  const TemporaryFolder folder;
  const LoadedScene loaded = load(folder, scene_text(R"(, "until": {"at_most": 5,
      "targets": [{"observable": "mean_height", "standard_error": 1e-9}]})"));
  Heard heard;
  SceneRun run(loaded, {.output = folder / "out.h5"}, heard);
  CHECK(run.compute_until_precise());
  CHECK(run.study().realizations == 5);
  CHECK(run.summary().done == 10);
  CHECK(heard.said.back() == "compared");

  RunObserver nobody;
  const auto run_share = [&] {
    SceneRun(loaded, {.output = folder / "share.h5", .shard = {1, 2}}, nobody);
  };
  try {
    run_share();
    FAIL("a share was run");
  } catch (const BadArgument& error) {
    CHECK(error.argument() == Argument::shard);
  }
}

TEST_CASE("A stop leaves a file that continues to the same digest") {
  const TemporaryFolder folder;
  const LoadedScene loaded = load(folder, scene_text());
  RunObserver nobody;
  CHECK(SceneRun(loaded, {.output = folder / "whole.h5"}, nobody).compute());
  const std::atomic<bool> stop = true;
  CHECK_FALSE(SceneRun(loaded, {.output = folder / "out.h5", .stop = &stop}, nobody).compute());
  SceneRun repeated(loaded, {.output = folder / "out.h5", .existing = Existing::resume}, nobody);
  CHECK(repeated.compute());
  CHECK(digest_of(folder / "out.h5") == digest_of(folder / "whole.h5"));
}

TEST_CASE("A stop that would fold much leaves it in the parts, and continues to the same digest") {
  const TemporaryFolder folder;
  std::string text = scene_text();
  text.replace(text.find("\"count\": 12"), 11, "\"count\": 400");
  const LoadedScene loaded = load(folder, text);
  RunObserver nobody;
  CHECK(SceneRun(loaded, {.output = folder / "whole.h5"}, nobody).compute());

  std::atomic<bool> stop = false;
  /// Stops the run from another thread once it has made a tap.
  class Stopper : public RunObserver {
   public:
    explicit Stopper(std::atomic<bool>& stop) : stop_(stop) {}
    ~Stopper() {
      if (watcher_.joinable()) watcher_.join();
    }
    void computing(const Progress& progress, const WorkAhead&, std::uint64_t,
                   std::uint64_t) override {
      watcher_ = std::thread([this, &progress] {
        while (progress.taps_done == 0) std::this_thread::yield();
        stop_ = true;
      });
    }
    void stored() override { stores = true; }
    bool stores = false;

   private:
    std::atomic<bool>& stop_;
    std::thread watcher_;
  } stopper(stop);
  const std::string output = folder / "out.h5";
  {
    SceneRun run(loaded, {.output = output, .stop = &stop, .most_bytes_folded_at_stop = 0},
                 stopper);
    REQUIRE_FALSE(run.compute());
    CHECK(run.left_in_parts());
  }
  CHECK_FALSE(stopper.stores);
  const RunStatus status = run_status(output);
  CHECK(status.state == RunState::running);
  CHECK_FALSE(status.owner);
  CHECK(status.parts_bytes > 0);
  CHECK(live_results(output).series(0).front().n_taps > 0);
  const std::string files[] = {output};
  const Overview overview = overview_of(files);
  REQUIRE(overview.studies.size() == 1);
  CHECK(overview.studies[0].shards[0].state == ShardState::stopped);

  SceneRun repeated(loaded, {.output = output, .existing = Existing::resume}, nobody);
  CHECK(repeated.compute());
  CHECK_FALSE(repeated.left_in_parts());
  CHECK(digest_of(output) == digest_of(folder / "whole.h5"));
  CHECK(run_status(output).parts_bytes == 0);
}

TEST_CASE("The scenes of sweep points are those of their plans") {
  const TemporaryFolder folder;
  const LoadedScene loaded = load(folder, scene_text());
  RunObserver nobody;
  SceneRun run(loaded, {.output = folder / "out.h5"}, nobody);
  const PointScenes scenes(run.results());
  CHECK(scenes.scene() == loaded.scene);
  for (std::uint32_t point = 0; point < loaded.plans.size(); ++point) {
    CHECK(scenes.point_scene(point).seed == loaded.plans[point].seed);
    CHECK(scenes.point_scene(point).protocol.front().tap ==
          loaded.plans[point].protocol.front().tap);
    CHECK(*scenes.value_at(point, "/protocol/0/tap/dilate") == (point == 0 ? 0.02 : 0.1));
    CHECK(*scenes.value_at(point, "/container/width") == 4);
    CHECK_FALSE(scenes.value_at(point, "/container/depth"));
  }
}
