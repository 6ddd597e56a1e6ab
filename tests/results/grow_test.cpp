#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "results/disk/error.hpp"
#include "results/run/merge.hpp"
#include "results/run/run_parts.hpp"
#include "runs.hpp"
#include "temporary_folder.hpp"

// Sweep points are added to a run: it ends as one that had them from the beginning.
using namespace jostle;
using Catch::Matchers::Contains;
using synthetic::provenance;

namespace {

/// Four points; the two of synthetic::study() are its second and its fourth.
Study grown() {
  const Study four = synthetic::study({.points = 4});
  Study study = four;
  study.resolved_scene += ", four points";
  study.points = {four.points[3], four.points[0], four.points[2], four.points[1]};
  return study;
}

std::string digest_at_once(const std::string& path, const Study& study) {
  const auto store = RunStore::create(path, study, {}, provenance());
  synthetic::run_pending(*store, study);
  store->finish();
  return digest_of(path);
}

std::string resumed_digest(const std::string& path, const Study& study) {
  const auto store = RunStore::resume(path, study, {}, provenance());
  synthetic::run_pending(*store, study);
  store->finish();
  return digest_of(path);
}

}  // namespace

TEST_CASE("a run that was finished takes more sweep points, wherever they come") {
  const TemporaryFolder folder;
  const Study study = grown();
  const Study study_before = synthetic::study();
  REQUIRE(PointNumbers(study).find(study_before.points[0].id) == 1u);
  REQUIRE(PointNumbers(study).find(study_before.points[1].id) == 3u);
  const std::string expected = digest_at_once(folder / "once.h5", study);
  synthetic::run_to_end(folder / "grown.h5");
  {
    const auto store = RunStore::resume(folder / "grown.h5", study, {}, provenance());
    CHECK(store->pending().size() == 6);  // the new points alone
  }
  CHECK(resumed_digest(folder / "grown.h5", study) == expected);
}

TEST_CASE("a run that was killed or stopped takes more sweep points, and keeps its checkpoints") {
  const TemporaryFolder folder;
  const Study study = grown();
  const std::string expected = digest_at_once(folder / "once.h5", study);
  const std::string path = folder / "grown.h5";
  const bool killed = GENERATE(true, false);
  {
    const Study study_before = synthetic::study();
    const auto store = RunStore::create(path, study_before, {}, provenance());
    synthetic::run_pending(*store, study_before, {.steps = 7, .leave_without_end = killed});
    if (!killed) store->finish();
  }
  CHECK(parts_exist(path) == killed);
  {
    const auto store = RunStore::resume(path, study, {}, provenance());
    const ResultsFile file(path);
    for (std::uint32_t r = 0; r < 3; ++r) {
      const auto point = PointNumbers(study).find(synthetic::study().points[1].id);
      CHECK(file.record({*point, r}).rows.size() > 0);
    }
    // Killed again, with parts of the new numbers.
    synthetic::run_pending(*store, study, {.steps = 4, .leave_without_end = true});
  }
  CHECK(resumed_digest(path, study) == expected);
}

TEST_CASE("points cannot be removed, and the sweep of a share cannot grow") {
  const TemporaryFolder folder;
  const Study study = grown();
  digest_at_once(folder / "all.h5", study);
  CHECK_THROWS_WITH(RunStore::resume(folder / "all.h5", synthetic::study(), {}, provenance()),
                    Contains("has the sweep point epsilon = ") && Contains("not removed"));
  synthetic::run_to_end(folder / "share.h5", {}, {1, 2});
  CHECK_THROWS_WITH(RunStore::resume(folder / "share.h5", study, {1, 2}, provenance()),
                    Contains("merge all shares"));
}

TEST_CASE("runs of some points each merge into the run of all") {
  const TemporaryFolder folder;
  const Study study = grown();
  const std::string expected = digest_at_once(folder / "once.h5", study);
  std::vector<std::string> paths;
  const std::vector<std::vector<std::size_t>> shares = {{3, 0}, {1}, {2}};
  for (const auto& points : shares) {
    Study subset = study;
    subset.resolved_scene += std::to_string(paths.size());
    subset.points.clear();
    for (const std::size_t point : points) subset.points.push_back(study.points[point]);
    paths.push_back(folder / ("share" + std::to_string(paths.size()) + ".h5"));
    digest_at_once(paths.back(), subset);
  }
  CHECK_THROWS_WITH(merge_files(paths, folder / "no.h5", provenance()),
                    Contains("holds another scene"));
  merge_files(paths, folder / "merged.h5", provenance(), false, study);
  CHECK(digest_of(folder / "merged.h5") == expected);
  const std::vector<std::string> two(paths.begin(), paths.begin() + 2);
  CHECK_THROWS_WITH(merge_files(two, folder / "no.h5", provenance(), false, study),
                    Contains("no input holds realization 0 of sweep point 2"));
  Study fewer = study;
  fewer.realizations = 2;
  CHECK_THROWS_WITH(merge_files(paths, folder / "no.h5", provenance(), false, fewer),
                    Contains("has 3 realizations per sweep point, not 2"));
}
