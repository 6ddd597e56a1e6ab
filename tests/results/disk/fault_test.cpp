#include <fmt/format.h>
#include <signal.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "results/file/results_file.hpp"
#include "results/run/run_store.hpp"
#include "tests/results/disk/file_text.hpp"
#include "tests/results/forked.hpp"
#include "tests/results/synthetic.hpp"
#include "tests/results/temporary_folder.hpp"

// Runs of a synthetic study on a disk that fails. fault_shim.c is linked into this program, so that
// its settings reach a forked process without a new start.
using namespace jostle;
using Catch::Matchers::Contains;

namespace {

/// A fresh file in a folder of its own.
struct Place {
  TemporaryFolder folder;
  std::string path = folder / "a.h5", messages = folder / "messages";
};

/// Starts or resumes the study and folds it, as `jostle run` would.
void work_on(const std::string& path, const synthetic::Conduct& conduct) {
  const Study study = synthetic::study({.points = 1, .realizations = 2});
  const auto store = std::filesystem::exists(path)
                         ? RunStore::resume(path, study, {}, synthetic::provenance())
                         : RunStore::create(path, study, {}, synthetic::provenance());
  for (const RealizationId id : store->pending()) synthetic::run(*store, study, id, conduct);
  store->finish();
}

constexpr synthetic::Conduct whole{.checkpoint_every = 6};
constexpr synthetic::Conduct stopped{.checkpoint_every = 6, .steps = 7};

Ending work_with_fault(const Place& place, const std::string& action, long call) {
  return run_forked({{"JOSTLE_FAULT_PATH", place.path},
                     {"JOSTLE_FAULT_ACTION", action},
                     {"JOSTLE_FAULT_AT", fmt::format("{}", call)}},
                    place.messages, [&] { work_on(place.path, whole); });
}

/// The number of calls that an undisturbed run makes, and its digest.
struct Undisturbed {
  long calls = 0;
  std::string digest;
};
Undisturbed undisturbed() {
  const Place place;
  const std::string count = place.folder / "count";
  const Ending ending =
      run_forked({{"JOSTLE_FAULT_PATH", place.path}, {"JOSTLE_FAULT_COUNT", count}}, place.messages,
                 [&] { work_on(place.path, whole); });
  REQUIRE(ending.code == 0);
  return {std::stol(text_of(count)), digest_of(place.path)};
}

/// The file that a fault leaves opens, and the next run finishes it and leaves nothing else.
void check_recovery(const Place& place, const std::string& expected) {
  if (std::filesystem::exists(place.path)) CHECK_NOTHROW(ResultsFile(place.path));
  REQUIRE_NOTHROW(work_on(place.path, whole));
  CHECK(digest_of(place.path) == expected);
  for (const auto& entry : std::filesystem::directory_iterator(place.folder.path())) {
    CAPTURE(entry.path());
    CHECK((entry.path() == place.path || entry.path() == place.messages));
  }
}

/// Killed at every `stride`-th call, and after the last.
void kill_at_calls(long stride) {
  const auto [calls, digest] = undisturbed();
  REQUIRE(calls > 50);
  const std::string action = GENERATE("kill_before", "kill_within", "kill_after");
  for (long call = action == "kill_after" ? calls : 1; call <= calls; call += stride) {
    CAPTURE(action, call, calls);
    const Place place;
    REQUIRE(work_with_fault(place, action, call).signal == SIGKILL);
    check_recovery(place, digest);
  }
}

void kill_while_going_on(long stride) {
  const std::string digest = undisturbed().digest;
  bool killed = true;
  for (long call = 1; killed; call += stride) {
    CAPTURE(call);
    const Place place;
    work_on(place.path, stopped);
    REQUIRE(ResultsFile(place.path).state() == RunState::interrupted);
    killed = work_with_fault(place, "kill_after", call).signal == SIGKILL;
    check_recovery(place, digest);
  }
}

void fill_disk_at_calls(long stride) {
  const auto [calls, digest] = undisturbed();
  for (long call = 1; call <= calls; call += stride) {
    CAPTURE(call, calls);
    const Place place;
    const Ending ending = work_with_fault(place, "no_space", call);
    REQUIRE(ending.signal == 0);
    if (ending.code == 0) {  // no write was left to fail
      CHECK(digest_of(place.path) == digest);
      continue;
    }
    CHECK_THAT(text_of(place.messages),
               Contains("No space left on device") && Contains(place.path));
    check_recovery(place, digest);
  }
}

}  // namespace

// The disk after call n is the disk before call n + 1, so that killing before every
// call and after the last one is killing before and after every call.
TEST_CASE("killed before, within or after any write, fsync, rename or removal, nothing is lost",
          "[slow]") {
  kill_at_calls(1);
}

TEST_CASE(
    "killed before, within or after some writes, fsyncs, renames and removals, nothing is lost") {
  kill_at_calls(13);
}

TEST_CASE("killed at any call while it continues from a folded file, nothing is lost", "[slow]") {
  kill_while_going_on(1);
}

TEST_CASE("killed while it continues from a folded file, nothing is lost") {
  kill_while_going_on(13);
}

TEST_CASE("a full disk is reported with its path, and the run continues once there is room") {
  fill_disk_at_calls(13);
}

TEST_CASE("a disk that is full at every other call is reported, and the run continues", "[slow]") {
  fill_disk_at_calls(2);
}

TEST_CASE("a failing fsync is not taken for success") {
  const Place place;
  CHECK(work_with_fault(place, "fsync_fails", 1).code == 1);
  CHECK_THAT(text_of(place.messages), Contains("cannot fsync"));
}

TEST_CASE("whatever is published is on disk before it has its name, and its name before all else") {
  const Place place;
  const std::string log = place.folder / "log";
  REQUIRE(run_forked({{"JOSTLE_FAULT_PATH", place.folder.path()}, {"JOSTLE_FAULT_LOG", log}},
                     place.messages, [&] { work_on(place.path, whole); })
              .code == 0);
  std::vector<std::pair<std::string, std::string>> calls;
  std::ifstream file(log);
  for (std::string name, path; file >> name >> path;) calls.emplace_back(name, path);
  int renames = 0;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    const auto& [name, path] = calls[i];
    if (name != "rename") continue;
    ++renames;
    CAPTURE(path);
    REQUIRE(i + 1 < calls.size());
    REQUIRE(i > 0);
    std::size_t last = i - 1;  // the last call that touched a temporary file
    while (last > 0 && !calls[last].second.ends_with(".tmp")) --last;
    CHECK(calls[last].first == "fsync");
    CHECK(calls[last].second.starts_with(path + "."));
    for (std::size_t discarded = last + 1; discarded < i;
         ++discarded) {  // parts that --force discards
      CAPTURE(calls[discarded].first, calls[discarded].second);
      CHECK(calls[discarded].first != "rename");
      CHECK(calls[discarded].first.find("write") == std::string::npos);
    }
    const std::string folder = std::filesystem::path(path).parent_path();
    CHECK(calls[i + 1] == std::pair<std::string, std::string>("fsync", folder));
  }
  CHECK(renames > 6);
  for (const auto& [name, path] : calls) {  // nothing but the lock is written in place
    CAPTURE(name, path);
    if (name.find("write") != std::string::npos || name.find("truncate") != std::string::npos)
      CHECK((path.ends_with(".tmp") || path.ends_with(".lock")));
  }
}
