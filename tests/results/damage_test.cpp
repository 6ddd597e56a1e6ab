#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "results/checkpoints/part.hpp"
#include "results/disk/error.hpp"
#include "runs.hpp"
#include "temporary_folder.hpp"

// Damaged, truncated or foreign files are rejected with the path and the reason.
using namespace jostle;
using Catch::Matchers::Contains;
using synthetic::provenance;
using synthetic::run_to_end;

namespace {

void flip_bit(const std::string& path, std::uint64_t offset) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(static_cast<std::streamoff>(offset));
  const char byte = static_cast<char>(file.get() ^ 4);
  file.seekp(static_cast<std::streamoff>(offset));
  file.put(byte);
}

/// A run killed in the middle: all its realizations have parts, the first one has two segments.
struct KilledRun {
  TemporaryFolder folder;
  std::string path = folder / "a.h5";
  Study study = synthetic::study({.points = 1,
                                  .realizations = 2,
                                  .spheres = 20000,
                                  .taps = 9,
                                  .snapshot_taps = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}});
  std::string state = state_path(path, {0, 0}), segment = segment_path(path, {0, 0}, 1);

  KilledRun() {
    const auto store = RunStore::create(path, study, {}, provenance());
    synthetic::run_pending(*store, study, {.steps = 20, .leave_without_end = true});
  }
  void resume() const { RunStore::resume(path, study, {}, provenance()); }
};

}  // namespace

TEST_CASE("a bit flipped anywhere in a file is noticed") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5", copy = folder / "b.h5";
  run_to_end(path);
  const std::uint64_t size = std::filesystem::file_size(path);
  for (std::uint64_t k = 0; k < 100; ++k) {
    const std::uint64_t offset = k == 99 ? size - 1 : k * size / 99;
    std::filesystem::copy_file(path, copy, std::filesystem::copy_options::overwrite_existing);
    flip_bit(copy, offset);
    CAPTURE(offset, size);
    CHECK_THROWS_WITH(ResultsFile(copy), Contains(copy));
    CHECK_THROWS_AS(digest_of(copy), ResultsError);
    CHECK_THROWS_AS(RunStore::resume(copy, synthetic::study(), {}, provenance()), ResultsError);
  }
}

TEST_CASE("a truncated, empty, foreign or missing file is refused") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  run_to_end(path);
  const std::uint64_t size = std::filesystem::file_size(path);
  for (const std::uint64_t length : {size - 1, size - 79, size - 81, size / 2, std::uint64_t{9}}) {
    std::filesystem::resize_file(path, length);
    CHECK_THROWS_WITH(ResultsFile(path), Contains("truncated"));
  }
  std::filesystem::resize_file(path, 0);
  CHECK_THROWS_WITH(ResultsFile(path), Contains("not an HDF5 file"));
  std::ofstream(path) << "something else altogether";
  CHECK_THROWS_WITH(ResultsFile(path), Contains("not an HDF5 file"));
  std::filesystem::remove(path);
  CHECK_THROWS_WITH(ResultsFile(path), Contains("No such file"));
}

TEST_CASE("a killed run continues if nothing was damaged, with leavings of the kill beside it") {
  const KilledRun run;
  std::ofstream(run.state + ".0a1b2c3d.tmp") << "half a state";
  std::ofstream(run.path + ".0a1b2c3d.tmp") << "half a file";
  std::filesystem::copy(run.segment, segment_path(run.path, {0, 0}, 9));  // no state counts it
  CHECK_NOTHROW(run.resume());
  CHECK_FALSE(std::filesystem::exists(run.state + ".0a1b2c3d.tmp"));
  CHECK_FALSE(std::filesystem::exists(run.path + ".0a1b2c3d.tmp"));
  CHECK_FALSE(std::filesystem::exists(segment_path(run.path, {0, 0}, 9)));
}

TEST_CASE("a damaged or truncated part is refused") {
  const KilledRun run;
  const std::string part = GENERATE(true, false) ? run.state : run.segment;
  const std::uint64_t size = std::filesystem::file_size(part);
  SECTION("a flipped bit") {
    const int tenths = GENERATE(1, 5, 10);
    flip_bit(part, (size - 1) * static_cast<std::uint64_t>(tenths) / 10);
    CHECK_THROWS_WITH(run.resume(), Contains(part) && Contains("checksum is wrong"));
  }
  SECTION("no magic") {
    flip_bit(part, 0);
    CHECK_THROWS_WITH(run.resume(), Contains(part) && Contains("not a part"));
  }
  SECTION("cut short") {
    std::filesystem::resize_file(part, size - 1);
    CHECK_THROWS_WITH(run.resume(), Contains(part) && Contains("truncated"));
  }
  SECTION("empty") {
    std::filesystem::resize_file(part, 0);
    CHECK_THROWS_WITH(run.resume(), Contains(part) && Contains("truncated"));
  }
}

TEST_CASE("a missing segment is refused") {
  const KilledRun run;
  std::filesystem::remove(run.segment);
  CHECK_THROWS_WITH(run.resume(), Contains(run.segment) && Contains("No such file"));
}

TEST_CASE("parts of another run, realization or place in the series are refused") {
  const KilledRun run;
  SECTION("another run") {
    const KilledRun second;
    std::filesystem::copy_file(second.state, run.state,
                               std::filesystem::copy_options::overwrite_existing);
    CHECK_THROWS_WITH(run.resume(), Contains(run.state) && Contains("another run"));
  }
  SECTION("another realization") {
    std::filesystem::rename(state_path(run.path, {0, 1}), run.state);
    CHECK_THROWS_WITH(run.resume(), Contains(run.state) && Contains("another realization"));
  }
  SECTION("another segment") {
    std::filesystem::copy_file(segment_path(run.path, {0, 0}, 0), run.segment,
                               std::filesystem::copy_options::overwrite_existing);
    CHECK_THROWS_WITH(run.resume(), Contains(run.segment) && Contains("another segment"));
  }
  SECTION("a realization beyond the study") {
    std::filesystem::rename(run.state, state_path(run.path, {0, 7}));
    CHECK_THROWS_WITH(run.resume(), Contains("does not have"));
  }
}

TEST_CASE("parts without their file are not built upon") {
  const KilledRun run;
  std::filesystem::remove(run.path);
  CHECK_THROWS_WITH(RunStore::create(run.path, run.study, {}, provenance()),
                    Contains(run.path + ".parts") && Contains("discard the parts"));
  // Nor are they discarded by a run that only takes over the lock of another host.
  CHECK_THROWS_WITH(RunStore::create(run.path, run.study, {}, provenance(), false,
                                     RunStore::Room::for_all, {}, true),
                    Contains("discard the parts"));
  CHECK(std::filesystem::exists(run.state));
  RunStore::create(run.path, run.study, {}, provenance(), true);
  CHECK_FALSE(std::filesystem::exists(run.state));
}
