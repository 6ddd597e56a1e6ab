#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "results/disk/error.hpp"
#include "results/run/live_run.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

// Files on which a run does not start, and its state for others once it has started.
using namespace jostle;
using Catch::Matchers::Contains;
using synthetic::provenance;

TEST_CASE("an existing file is not overwritten without force") {
  const TemporaryFolder folder;
  const std::string path = folder / "straight.h5";
  const std::string expected = synthetic::run_to_end(path);
  const Study study = synthetic::study();
  CHECK_THROWS_WITH(RunStore::create(path, study, {}, provenance()), Contains("or replace it"));
  CHECK(digest_of(path) == expected);
  CHECK_FALSE(lock_owner(path));
  CHECK(RunStore::create(path, study, {}, provenance(), true)->pending().size() == 6);
}

TEST_CASE("a file put in the place of the results during a run is kept, and so are the results") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const std::string expected = synthetic::run_to_end(folder / "straight.h5");
  const Study study = synthetic::study();
  const auto store = RunStore::create(path, study, {}, provenance());
  synthetic::run_pending(*store, study);
  std::filesystem::remove(path);
  std::ofstream(path) << "notes";
  CHECK_THROWS_WITH(store->finish(), Contains("another file was put here") && Contains("is kept"));
  CHECK(std::filesystem::file_size(path) == 5);
  std::string new_path;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    const std::string name = entry.path().string();
    if (name.starts_with(path + ".") && !name.ends_with(".parts") && !name.ends_with(".lock"))
      new_path = name;
  }
  REQUIRE_FALSE(new_path.empty());
  CHECK(digest_of(new_path) == expected);
}

TEST_CASE("a study that does not fit the disk is refused before it runs") {
  const TemporaryFolder folder;
  const Study study = synthetic::study({.spheres = 4'000'000'000u, .taps = 1'000'000'000});
  CHECK_THROWS_WITH(RunStore::create(folder / "a.h5", study, {}, provenance()), Contains("MB"));
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("a resume of another shard is refused") {
  const TemporaryFolder folder;
  const Study study = synthetic::study();
  RunStore::create(folder / "a.h5", study, {1, 2}, provenance());
  CHECK_THROWS_WITH(RunStore::resume(folder / "a.h5", study, {2, 2}, provenance()),
                    Contains("holds shard 1/2 of its study, not 2/2"));
}

TEST_CASE("a live run is looked at through its parts") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const Study study = synthetic::study();
  const auto store = RunStore::create(path, study, {}, provenance());
  synthetic::run(*store, study, {0, 1}, {.steps = 7});
  synthetic::run(*store, study, {1, 0});
  const RunStatus status = run_status(path);
  CHECK(status.state == RunState::running);
  REQUIRE(status.owner);
  CHECK(status.owner->alive);
  CHECK(status.owner->pid == ::getpid());
  CHECK(status.realizations.at(0).status == RealizationStatus::missing);
  CHECK(status.realizations.at(1).status == RealizationStatus::running);
  CHECK(status.realizations.at(1).rows == 3);
  CHECK(status.realizations.at(3).status == RealizationStatus::done);
  CHECK(status.parts_bytes > 0);
}
