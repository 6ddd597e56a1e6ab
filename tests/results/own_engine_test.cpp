#include <catch2/catch.hpp>

#include "ensemble/realization.hpp"
#include "results/file/results_file.hpp"
#include "results/run/run_store.hpp"
#include "synthetic.hpp"
#include "temporary_folder.hpp"
#include "tests/ensemble/sinking.hpp"

using namespace jostle;

namespace {

Study sinking_study(const Plan& plan) {
  Study study = make_study(std::span(&plan, 1), "{}", "{}", 2);
  study.points[0].diagnostics = Sinking::columns();
  return study;
}

// For every realization some slices, or all that are left.
void go_on(RunStore& store, const Plan& plan, int slices) {
  for (const RealizationId id : store.pending()) {
    Realization realization(plan, id.realization, sinking(plan, id.realization), store.begin(id));
    for (; slices > 0 && !realization.finished(); --slices) {
      const Slice slice = realization.advance(7);
      if (slice.row) store.append(id, *slice.row);
      if (slice.snapshot) store.snapshot(id, *slice.snapshot);
    }
    const auto status =
        realization.finished() ? RealizationStatus::done : RealizationStatus::running;
    store.end(id, realization.state(), {.status = status, .reason = {}});
  }
  store.finish();
}

}  // namespace

TEST_CASE("columns of an engine of one's own go into the file with their descriptions") {
  const TemporaryFolder folder;
  const Plan plan = sinking_plan();
  const Study study = sinking_study(plan);
  go_on(*RunStore::create(folder / "straight.h5", study, {}, synthetic::provenance()), plan, 1000);
  go_on(*RunStore::create(folder / "stopped.h5", study, {}, synthetic::provenance()), plan, 5);
  go_on(*RunStore::resume(folder / "stopped.h5", study, {}, synthetic::provenance()), plan, 1000);
  CHECK(digest_of(folder / "stopped.h5") == digest_of(folder / "straight.h5"));

  const ResultsFile file(folder / "straight.h5");
  CHECK(file.study().points[0].diagnostics == Sinking::columns());
  CHECK(file.columns(0) == study.points[0].columns());
  const std::vector<Series> series = file.series(0);
  REQUIRE(series.size() == 3);
  CHECK(series[1].label.name == "steps");
  CHECK(series[1].value(6, 1) > 1);
  CHECK(file.ensemble(0)[2].mean == std::vector<double>(7, 0));
}
