#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "results/disk/error.hpp"
#include "results/disk/output_path.hpp"
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

// Links, pipes and folders that another user puts at names of ours where others may write.
using namespace jostle;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

constexpr uid_t somebody = 65534, somebody_else = 65533;

/// "folder" of an owner, with a mode, and "link" of another in it, which leads to `target`.
struct SharedFolder {
  TemporaryFolder outer;
  std::string folder = outer / "folder", link = folder + "/link";
  SharedFolder(uid_t owner, mode_t mode, uid_t owner_of_link, const std::string& target) {
    fs::create_directory(folder);
    fs::create_symlink(target, link);
    REQUIRE(::lchown(link.c_str(), owner_of_link, owner_of_link) == 0);
    REQUIRE(::chown(folder.c_str(), owner, owner) == 0);
    REQUIRE(::chmod(folder.c_str(), mode) == 0);
  }
};

void run_whole(const std::string& path) {
  const Study study = synthetic::study({});
  const auto store = RunStore::create(path, study, {}, synthetic::provenance(), true);
  synthetic::run_pending(*store, study);
  store->finish();
}

bool is_followed(const std::string& path) {
  try {
    output_path(path);
    return true;
  } catch (const ResultsError& error) {
    CHECK_THAT(error.what(), Contains("another user"));
    return false;
  }
}

}  // namespace

TEST_CASE("links are followed where nobody else can have put them") {
  if (::geteuid() != 0) return;  // only root can make files of others
  const uid_t own = ::geteuid();
  struct Row {
    uid_t folder;
    mode_t mode;
    uid_t link;
    bool at_the_end, on_the_way;
  };
  const Row rows[] = {
      {own, 0755, own, true, true},
      {own, 0755, somebody, true, true},  // since before the folder was closed: as the kernel
      {somebody, 0755, somebody, true, true},
      {own, 01777, own, true, true},
      {own, 01777, somebody, false, false},
      {somebody, 01777, somebody, false, false},
      {own, 0777, somebody, false, false},
      {somebody, 0777, somebody, false, false},
      {somebody, 0777, own, true, true},
      {own, 0775, somebody, false, false},
      {somebody, 0775, somebody, false, true},  // link of the folder's owner
      {somebody, 0775, somebody_else, false, false},
      {somebody, 02770, somebody_else, false, false},
      {somebody, 01775, somebody_else, false, false},
      {own, 0757, somebody, false, false},
  };
  const TemporaryFolder target;
  std::ofstream(target / "file") << "mine\n";
  for (const Row& row : rows) {
    CAPTURE(row.folder, row.mode, row.link);
    const SharedFolder to_file(row.folder, row.mode, row.link, target / "file");
    CHECK(is_followed(to_file.link) == row.at_the_end);
    const SharedFolder dangling(row.folder, row.mode, row.link, target / "none");
    CHECK(is_followed(dangling.link) == row.at_the_end);
    const SharedFolder to_folder(row.folder, row.mode, row.link, target.path());
    CHECK(is_followed(to_folder.link) == row.at_the_end);
    CHECK(is_followed(to_folder.link + "/file") == row.on_the_way);
    CHECK(is_followed(to_folder.link + "/none/file") == row.on_the_way);
    CHECK(is_followed(to_folder.link + "/../file") == row.on_the_way);
    CHECK(is_followed(to_folder.folder + "/./link//file") == row.on_the_way);
    // A link of our own that leads to it.
    fs::create_symlink(to_file.link, target / "chain");
    CHECK(is_followed(target / "chain") == row.at_the_end);
    fs::remove(target / "chain");
    fs::create_symlink(to_folder.link, target / "chain");
    CHECK(is_followed(target / "chain/file") == row.on_the_way);
    fs::remove(target / "chain");
    if (row.at_the_end) CHECK(output_path(to_file.link) == target / "file");
    if (row.on_the_way) CHECK(output_path(to_folder.link + "/file") == to_folder.link + "/file");
  }
}

TEST_CASE("no function that writes follows a link that another user planted") {
  if (::geteuid() != 0) return;
  const mode_t mode = GENERATE(01777, 0777, 0775);
  const TemporaryFolder outer_folder;
  const std::string victim = outer_folder / "victim", source = outer_folder / "source.h5";
  std::ofstream(victim) << "mine\n";
  const SharedFolder end(0, mode, somebody, victim), way(0, mode, somebody, outer_folder.path());
  const Table table{.name = "t", .axes = {}, .quantities = {}, .notes = {}};
  const std::string digest = synthetic::run_to_end(source);
  for (const std::string& path : {end.link, way.link + "/new", way.link + "/victim"}) {
    CAPTURE(mode, path);
    const auto says = Contains("another user");
    CHECK_THROWS_WITH(publish(path, {}), says);
    CHECK_THROWS_WITH(TemporaryFile(path), says);
    CHECK_THROWS_WITH(RunLock(path, true), says);
    CHECK_THROWS_WITH(make_parts_folder(path), says);
    CHECK_THROWS_WITH(run_whole(path), says);
    CHECK_THROWS_WITH(RunStore::resume(path, synthetic::study({}), {}, synthetic::provenance()),
                      says);
    CHECK_THROWS_WITH(store_tables(path, "fits", std::span(&table, 1), synthetic::provenance()),
                      says);
    CHECK_THROWS_WITH(merge_files(std::span(&source, 1), path, synthetic::provenance(), true),
                      says);
    CHECK_THROWS_WITH(write_copy(source, path, false), says);
  }
  CHECK_THROWS_WITH(make_folder(way.link), Contains("another user"));
  CHECK_THROWS_WITH(ScratchFolder("test", way.link), Contains("another user"));
  CHECK(digest_of(source) == digest);
  CHECK(text_of(victim) == "mine\n");
  CHECK(std::distance(fs::directory_iterator(outer_folder.path()), {}) == 2);
}

TEST_CASE("a pipe, or a folder of parts, that another user planted is not used") {
  if (::geteuid() != 0) return;
  const TemporaryFolder outer_folder;
  const std::string folder = outer_folder / "folder", path = folder + "/a.h5",
                    pipe = folder + "/pipe";
  fs::create_directory(folder);
  REQUIRE(::chmod(folder.c_str(), 01777) == 0);
  REQUIRE(::mkfifo(pipe.c_str(), 0666) == 0);
  CHECK(output_path(pipe) == pipe);
  REQUIRE(::chown(pipe.c_str(), somebody, somebody) == 0);
  CHECK_THROWS_WITH(output_path(pipe), Contains("is a pipe or device that another user"));
  fs::create_directory(path + ".parts");
  REQUIRE(::chown((path + ".parts").c_str(), somebody, somebody) == 0);
  CHECK_THROWS_WITH(run_whole(path), Contains("is a folder of another user"));
  REQUIRE(::chmod(folder.c_str(), 0775) == 0);  // a folder of a group that works together
  CHECK_NOTHROW(run_whole(path));
  CHECK(output_path("/dev/null") == "/dev/null");
  CHECK_NOTHROW(output_path("/dev/stdout"));
  CHECK_NOTHROW(output_path("/proc/self/fd/1"));
}
