#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "results/disk/error.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/temporary_file.hpp"
#include "results/file/tables.hpp"
#include "results/locks/lock.hpp"
#include "results/run/live_run.hpp"
#include "results/run/merge.hpp"
#include "results/run/run_parts.hpp"
#include "tests/results/disk/file_text.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

// Files that others, or an accident, create at the names derived from a results file's: NAME.lock,
// NAME.parts, NAME.*.tmp, and NAME itself.
using namespace jostle;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

unsigned mode_of(const std::string& path) {
  struct stat status {};
  ::lstat(path.c_str(), &status);
  return status.st_mode & 07777;
}

/// A folder with somebody's files, which must not change.
struct HostileFolder {
  TemporaryFolder folder;
  std::string path = folder / "a.h5", victim = folder / "victim", other_folder = folder / "others";
  HostileFolder() {
    std::ofstream(victim) << "mine\n";
    fs::create_directory(other_folder);
    std::ofstream(other_folder + "/p0000_r00000.state") << "mine";
    std::ofstream(other_folder + "/p0000_r00001.segment00000") << "mine";
    std::ofstream(other_folder + "/p0000_r00002.state.tmp") << "mine";
  }
  void check_untouched() const {
    CHECK(text_of(victim) == "mine\n");
    CHECK(std::distance(fs::directory_iterator(other_folder), {}) == 3);
    for (const auto& entry : fs::directory_iterator(other_folder))
      CHECK(text_of(entry.path()) == "mine");
  }
};

enum class Planted {
  link_to_file,
  link_to_folder,
  dangling_link,
  link_ring,
  fifo,
  folder,
  foreign,
  hard_link
};
constexpr Planted all_planted[] = {
    Planted::link_to_file, Planted::link_to_folder, Planted::dangling_link, Planted::link_ring,
    Planted::fifo,         Planted::folder,         Planted::foreign,       Planted::hard_link};

void plant(const HostileFolder& hostile, const std::string& name, Planted kind) {
  switch (kind) {
    case Planted::link_to_file:
      return fs::create_symlink(hostile.victim, name);
    case Planted::link_to_folder:
      return fs::create_symlink(hostile.other_folder, name);
    case Planted::dangling_link:
      return fs::create_symlink(hostile.folder / "nowhere", name);
    case Planted::link_ring:
      return fs::create_symlink(name, name);
    case Planted::fifo:
      REQUIRE(::mkfifo(name.c_str(), 0666) == 0);
      return;
    case Planted::folder:
      fs::create_directory(name);
      return;
    case Planted::foreign:
      std::ofstream(name) << "mine\n";
      return;
    case Planted::hard_link:
      return fs::create_hard_link(hostile.victim, name);
  }
}

void run_whole(const std::string& path, bool force) {
  const Study study = synthetic::study({});
  const auto store = RunStore::create(path, study, {}, synthetic::provenance(), force);
  synthetic::run_pending(*store, study);
  store->finish();
}

}  // namespace

TEST_CASE("any object at the name of the lock is refused, and left as it is") {
  const Planted kind = GENERATE(from_range(std::begin(all_planted), std::end(all_planted)));
  const bool force = GENERATE(false, true);
  const HostileFolder hostile;
  plant(hostile, hostile.path + ".lock", kind);
  CAPTURE(static_cast<int>(kind), force);
  CHECK_THROWS_WITH(run_whole(hostile.path, force), Contains("a.h5.lock"));
  CHECK_FALSE(lock_owner(hostile.path));
  CHECK(fs::is_symlink(fs::symlink_status(hostile.path + ".lock")) == (static_cast<int>(kind) < 4));
  CHECK_FALSE(fs::exists(hostile.path));
  CHECK_FALSE(fs::exists(hostile.folder / "nowhere"));
  hostile.check_untouched();
}

TEST_CASE("a text that begins as a lock does is no lock, and left as it is") {
  const HostileFolder hostile;
  const std::string name = hostile.path + ".lock", text = "notes 12 30\nof a text of somebody\n";
  std::ofstream(name) << text;
  CHECK_THROWS_WITH(run_whole(hostile.path, true), Contains("is no lock of jostle"));
  std::ifstream left(name);
  CHECK(std::string(std::istreambuf_iterator<char>(left), {}) == text);
}

TEST_CASE("any object at the name of the parts is refused, and left as it is") {
  const Planted kind = GENERATE(from_range(std::begin(all_planted), std::end(all_planted)));
  if (kind == Planted::folder) return;  // the file that belongs there
  const bool force = GENERATE(false, true);
  const HostileFolder hostile;
  plant(hostile, hostile.path + ".parts", kind);
  CAPTURE(static_cast<int>(kind), force);
  CHECK_THROWS_WITH(run_whole(hostile.path, force), Contains("a.h5.parts"));
  CHECK_THROWS_WITH(remove_parts(hostile.path), Contains("a.h5.parts"));
  CHECK_THROWS_WITH(parts_exist(hostile.path), Contains("a.h5.parts"));
  CHECK_FALSE(fs::exists(hostile.folder / "nowhere"));
  hostile.check_untouched();
}

TEST_CASE("a folder of parts that is exchanged for a link under a run ends it without harm") {
  const HostileFolder hostile;
  run_whole(hostile.path, false);
  const std::string second = hostile.folder / "b.h5";
  const Study study = synthetic::study({});
  const auto store = RunStore::create(second, study, {}, synthetic::provenance());
  REQUIRE(store->begin({0, 0}) == std::nullopt);
  fs::remove_all(second + ".parts");
  fs::create_symlink(hostile.other_folder, second + ".parts");
  CHECK_THROWS_AS(store->begin({0, 1}), ResultsError);
  CHECK_THROWS_AS(store->finish(), ResultsError);
  hostile.check_untouched();
}

TEST_CASE("links and pipes in the place of parts are not written through and not waited for") {
  const HostileFolder hostile;
  const Study study = synthetic::study({});
  const std::string state = hostile.path + ".parts/p0000_r00000.state";
  {
    const auto store = RunStore::create(hostile.path, study, {}, synthetic::provenance());
    fs::create_directories(hostile.path + ".parts");
    fs::create_symlink(hostile.victim, state);
    CHECK_THROWS_AS(synthetic::run(*store, study, {0, 0}), ResultsError);
  }
  hostile.check_untouched();
  fs::remove(state);
  REQUIRE(::mkfifo(state.c_str(), 0666) == 0);
  CHECK_THROWS_WITH(RunStore::resume(hostile.path, study, {}, synthetic::provenance()),
                    Contains("not a file"));
}

TEST_CASE(
    "a temporary file has a name that nobody can foresee, and only its stale kin are removed") {
  const HostileFolder hostile;
  const std::string stale = hostile.path + ".01234abc.tmp";
  const std::vector<std::string> kept = {hostile.path + ".tmp", hostile.path + ".01234abX.tmp",
                                         hostile.folder / "b.h5.01234abc.tmp",
                                         hostile.path + ".01234abc0.tmp"};
  std::ofstream(stale) << "half";
  for (const std::string& name : kept) std::ofstream(name) << "mine\n";
  fs::create_symlink(hostile.victim, hostile.path + ".99999999.tmp");
  std::string first;
  {
    const TemporaryFile file(hostile.path);
    first = file.name();
    const TemporaryFile second(hostile.path);
    CHECK(second.name() != first);
    CHECK(fs::exists(first));
  }
  CHECK_FALSE(fs::exists(first));
  run_whole(hostile.path, false);
  CHECK_FALSE(fs::exists(stale));
  for (const std::string& name : kept) CHECK(text_of(name) == "mine\n");
  CHECK(fs::is_symlink(fs::symlink_status(hostile.path + ".99999999.tmp")));
  hostile.check_untouched();
}

TEST_CASE("a file that is replaced keeps its permissions, and a new one has those of the process") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const mode_t umask_before = ::umask(022);
  synthetic::run_to_end(path);
  ::umask(umask_before);
  CHECK(mode_of(path) == 0644);
  for (const unsigned mode : {0600U, 0640U, 0660U, 0604U}) {
    REQUIRE(::chmod(path.c_str(), mode) == 0);
    synthetic::run_to_end(path);
    CHECK(mode_of(path) == mode);
    const Table table{.name = "t", .axes = {}, .quantities = {}, .notes = {}};
    store_tables(path, "fits", std::span(&table, 1), synthetic::provenance());
    CHECK(mode_of(path) == mode);
    publish(path + ".txt", bytes_of("new"));
    REQUIRE(::chmod((path + ".txt").c_str(), mode) == 0);
    publish(path + ".txt", bytes_of("newer"));
    CHECK(mode_of(path + ".txt") == mode);
  }
}

TEST_CASE("the parts of a private file are private") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  synthetic::run_to_end(path, {.taps = 2, .snapshot_taps = {0, 2}});
  REQUIRE(::chmod(path.c_str(), 0600) == 0);
  const auto store = RunStore::resume(path, synthetic::study({.taps = 6, .snapshot_taps = {0, 2}}),
                                      {}, synthetic::provenance());
  store->begin({0, 0});
  CHECK(mode_of(path + ".parts") == 0700);
}

TEST_CASE("a write-protected file is not replaced") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5", second = folder / "b.h5";
  const std::string digest = synthetic::run_to_end(path);
  REQUIRE(::chmod(path.c_str(), 0444) == 0);
  const auto says = Contains("write-protected (mode 444)");
  CHECK_THROWS_WITH(publish(path, bytes_of("new")), says);
  CHECK_THROWS_WITH(run_whole(path, true), says);
  CHECK_THROWS_WITH(
      RunStore::resume(path, synthetic::study({.taps = 9}), {}, synthetic::provenance()), says);
  const Table table{.name = "t", .axes = {}, .quantities = {}, .notes = {}};
  CHECK_THROWS_WITH(store_tables(path, "fits", std::span(&table, 1), synthetic::provenance()),
                    says);
  synthetic::run_to_end(second);
  CHECK_THROWS_WITH(merge_files(std::span(&second, 1), path, synthetic::provenance(), true), says);
  CHECK(digest_of(path) == digest);
  CHECK(mode_of(path) == 0444);
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 2);
}

TEST_CASE("a link to a results file stays one, and what it names is replaced and locked") {
  const TemporaryFolder folder;
  fs::create_directories(folder / "store");
  const std::string real = folder / "store/a.h5", link = folder / "link.h5",
                    second = folder / "second.h5";
  synthetic::run_to_end(real);
  fs::create_symlink("store/a.h5", link);
  fs::create_symlink("link.h5", second);
  const Table table{.name = "t", .axes = {}, .quantities = {}, .notes = {}};
  store_tables(second, "fits", std::span(&table, 1), synthetic::provenance());
  CHECK(fs::is_symlink(link));
  CHECK(fs::is_symlink(second));
  CHECK(table_names(real) == std::vector<std::string>{"fits/t"});
  {
    const RunLock lock(real, false);
    CHECK_THROWS_AS(run_whole(link, true), ResultsError);
    CHECK(run_status(second).owner->pid == ::getpid());
  }
  run_whole(second, true);
  CHECK(fs::is_symlink(link));
  CHECK(table_names(real).empty());
}
