#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "results/disk/error.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/temporary_file.hpp"
#include "results/run/live_run.hpp"
#include "tests/results/disk/file_text.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

// Two commands that make the same file at the same time: each of them has found none.
using namespace jostle;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

auto files_in(const TemporaryFolder& folder) {
  return std::distance(fs::directory_iterator(folder.path()), {});
}

}  // namespace

TEST_CASE("a file to be kept refuses another, also where it came while the other was written") {
  const TemporaryFolder folder;
  const std::string path = folder / "t.csv";
  const auto says = Contains("t.csv: exists already; choose another name, or replace it");
  {
    TemporaryFile late(path, ExistingFile::kept);
    late.write(bytes_of("late"));
    publish(path, bytes_of("first"), ExistingFile::kept);
    CHECK_THROWS_WITH(late.publish(), says);
    CHECK_FALSE(late.is_published());
  }
  CHECK_THROWS_WITH(publish(path, bytes_of("later"), ExistingFile::kept), says);
  CHECK(text_of(path) == "first");
  CHECK(files_in(folder) == 1);
  publish(path, bytes_of("replaced"), ExistingFile::replaced);
  CHECK(text_of(path) == "replaced");
}

TEST_CASE("a new file has one name and the permissions of the process") {
  const TemporaryFolder folder;
  const std::string path = folder / "t.csv";
  const mode_t umask_before = ::umask(022);
  publish(path, bytes_of("new"), ExistingFile::kept);
  ::umask(umask_before);
  struct stat status {};
  REQUIRE(::stat(path.c_str(), &status) == 0);
  CHECK(status.st_nlink == 1);
  CHECK((status.st_mode & 0777) == 0644);
  CHECK(files_in(folder) == 1);
}

TEST_CASE("files that belong together are not published, and one that is kept stays") {
  const TemporaryFolder folder;
  const std::string first = folder / "a.vtp", second = folder / "b.vtp";
  {
    std::vector<std::unique_ptr<TemporaryFile>> files;
    for (const std::string& path : {first, second})
      files.push_back(std::make_unique<TemporaryFile>(path, ExistingFile::kept));
    publish(second, bytes_of("others"));
    CHECK_THROWS_WITH(publish_all(files), Contains("b.vtp: exists already"));
  }
  CHECK_FALSE(fs::exists(first));
  CHECK(text_of(second) == "others");
  CHECK(files_in(folder) == 1);
}

TEST_CASE("a copy of results does not replace a file unless asked") {
  const TemporaryFolder folder;
  const std::string source = folder / "a.h5", copy = folder / "b.h5";
  const std::string digest = synthetic::run_to_end(source);
  publish(copy, bytes_of("others"));
  CHECK_THROWS_WITH(write_copy(source, copy, false), Contains("b.h5: exists already"));
  CHECK(text_of(copy) == "others");
  write_copy(source, copy, false, ExistingFile::replaced);
  CHECK(digest_of(copy) == digest);
}
