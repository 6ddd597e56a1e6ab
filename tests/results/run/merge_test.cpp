#include "results/run/merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "results/checkpoints/part.hpp"
#include "results/disk/error.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;
using Catch::Matchers::Contains;
using synthetic::provenance;
using synthetic::run_to_end;
using synthetic::StudySize;

namespace {

std::vector<std::string> run_shards(const TemporaryFolder& folder, std::uint32_t count,
                                    const StudySize& sizes = {}) {
  std::vector<std::string> paths;
  for (std::uint32_t i = 1; i <= count; ++i) {
    paths.push_back(folder / fmt::format("shard{}.h5", i));
    run_to_end(paths.back(), sizes, {i, count});
  }
  return paths;
}

}  // namespace

TEST_CASE(
    "shards share the work without overlap and keep their place when realizations are added") {
  const std::uint32_t count = GENERATE(1, 2, 3, 5, 7);
  const Study study = synthetic::study({.points = 3, .realizations = 4});
  const Study longer = synthetic::study({.points = 3, .realizations = 9});
  std::size_t all = 0, least = 12, most = 0;
  for (std::uint32_t i = 1; i <= count; ++i) {
    const auto ids = realizations_of(study, {i, count});
    for (const RealizationId id : ids) CHECK(in_share({i, count}, longer, id));
    all += ids.size();
    least = std::min(least, ids.size());
    most = std::max(most, ids.size());
  }
  CHECK(all == 12);
  CHECK(most - least <= 1);
}

TEST_CASE("merged shards have the digest of one big run") {
  const TemporaryFolder folder;
  const std::string expected = run_to_end(folder / "one.h5");
  const std::uint32_t count = GENERATE(1, 2, 3, 6, 8);
  auto shards = run_shards(folder, count);
  std::reverse(shards.begin(), shards.end());
  const std::string output = folder / "all.h5";
  merge_files(shards, output, provenance());
  CHECK(digest_of(output) == expected);
  CHECK(ResultsFile(output).state() == RunState::complete);
  CHECK(ResultsFile(output).provenance().size() == count + 1);
  CHECK_FALSE(std::filesystem::exists(output + ".lock"));
}

TEST_CASE("a merged file can be resumed with more taps") {
  const TemporaryFolder folder;
  const StudySize longer{.realizations = 4, .taps = 8};
  const std::string expected = run_to_end(folder / "one.h5", longer);
  const std::string output = folder / "all.h5";
  merge_files(run_shards(folder, 2), output, provenance());
  const Study study = synthetic::study(longer);
  const auto store = RunStore::resume(output, study, {}, provenance());
  synthetic::run_pending(*store, study);
  store->finish();
  CHECK(digest_of(output) == expected);
}

TEST_CASE("what cannot be merged is refused by name, and nothing is written") {
  const TemporaryFolder folder;
  const auto shards = run_shards(folder, 3);
  const std::string output = folder / "all.h5";
  const auto merging = [&](std::vector<std::string> inputs) {
    merge_files(inputs, output, provenance());
  };
  SECTION("a gap") {
    CHECK_THROWS_WITH(merging({shards[0], shards[2]}),
                      Contains("no input holds shard 2 of 3 (realization 0 of sweep point 1"));
  }
  SECTION("an overlap") {
    std::filesystem::copy(shards[1], folder / "again.h5");
    CHECK_THROWS_WITH(merging({shards[0], shards[1], shards[2], folder / "again.h5"}),
                      Contains("again.h5: overlaps") && Contains("shard2.h5"));
  }
  SECTION("another scene") {
    run_to_end(folder / "other.h5", {.taps = 7}, {2, 3});
    CHECK_THROWS_WITH(merging({shards[0], folder / "other.h5", shards[2]}),
                      Contains("other.h5: holds another scene than") && Contains("shard1.h5"));
  }
  SECTION("an unfinished input") {
    const Study study = synthetic::study();
    const auto store = RunStore::create(folder / "half.h5", study, {2, 3}, provenance());
    CHECK_THROWS_WITH(merging({shards[0], folder / "half.h5", shards[2]}),
                      Contains("half.h5: is not finished"));
    synthetic::run_pending(*store, study, {.steps = 5});
    store->finish();
    CHECK_THROWS_WITH(merging({shards[0], folder / "half.h5", shards[2]}),
                      Contains("half.h5: is not finished"));
  }
  SECTION("an input with parts that are not folded") {
    std::filesystem::create_directory(shards[1] + ".parts");
    std::ofstream(state_path(shards[1], {0, 1})) << "of a realization run again";
    CHECK_THROWS_WITH(merging(shards), Contains("shard2.h5: is not finished"));
  }
  SECTION("parts of another run beside the output") {
    std::filesystem::create_directory(output + ".parts");
    std::ofstream(state_path(output, {0, 1})) << "of a run whose file is gone";
    CHECK_THROWS_WITH(merging(shards), Contains("all.h5.parts: holds parts of another run"));
  }
  SECTION("a start from another packing") {
    Study study = synthetic::study();
    std::vector<std::string> paths;
    for (std::uint32_t i = 1; i <= 2; ++i) {
      study.points[1].start_sum = i == 1 ? "one" : "another";
      paths.push_back(folder / fmt::format("from{}.h5", i));
      const auto store = RunStore::create(paths.back(), study, {i, 2}, provenance());
      synthetic::run_pending(*store, study);
      store->finish();
    }
    CHECK_THROWS_WITH(merging(paths), Contains("from2.h5: starts sweep point 1 from another"));
  }
  SECTION("a damaged input") {
    std::filesystem::resize_file(shards[1], std::filesystem::file_size(shards[1]) - 1);
    CHECK_THROWS_WITH(merging(shards), Contains("shard2.h5: truncated"));
  }
  SECTION("nothing") {
    CHECK_THROWS_WITH(merging({}), Contains("nothing to merge"));
  }
  CHECK_FALSE(std::filesystem::exists(output));
  CHECK_FALSE(std::filesystem::exists(output + ".lock"));
}

TEST_CASE("an existing output is kept unless forced") {
  const TemporaryFolder folder;
  const auto shards = run_shards(folder, 2);
  const std::string digest_before = digest_of(shards[0]), expected = run_to_end(folder / "one.h5");
  CHECK_THROWS_WITH(merge_files(shards, shards[0], provenance()), Contains("exists already"));
  CHECK(digest_of(shards[0]) == digest_before);
  merge_files(shards, shards[0], provenance(), true);
  CHECK(digest_of(shards[0]) == expected);
}

TEST_CASE("the order of the inputs decides nothing, scenes written differently neither") {
  const TemporaryFolder folder;
  auto shards = run_shards(folder, 2);
  Study study = synthetic::study();
  study.scene += " ";
  const auto store = RunStore::create(shards[1], study, {2, 2}, provenance(), true);
  synthetic::run_pending(*store, study);
  store->finish();
  merge_files(shards, folder / "one.h5", provenance());
  std::reverse(shards.begin(), shards.end());
  merge_files(shards, folder / "other.h5", provenance());
  CHECK(digest_of(folder / "one.h5") == digest_of(folder / "other.h5"));
}
