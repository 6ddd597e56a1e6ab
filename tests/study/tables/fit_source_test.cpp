#include "study/tables/fit_source.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "results/run/run_store.hpp"
#include "tests/results/synthetic.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;

namespace {

/// Passes the rows on, the first observable of one tap without a value.
class WithoutValue : public Sink {
 public:
  WithoutValue(Sink& sink, std::uint64_t tap) : sink_(sink), tap_(tap) {}

  std::optional<RealizationState> begin(RealizationId id) override { return sink_.begin(id); }
  void append(RealizationId id, const TapRow& row) override {
    TapRow changed = row;
    if (row.tap == tap_) changed.observables[0] = std::numeric_limits<double>::quiet_NaN();
    sink_.append(id, changed);
  }
  void snapshot(RealizationId id, const SnapshotRecord& record) override {
    sink_.snapshot(id, record);
  }
  void checkpoint(RealizationId id, const RealizationState& state, const Work& work) override {
    sink_.checkpoint(id, state, work);
  }
  void end(RealizationId id, const RealizationState& state, const Outcome& outcome) override {
    sink_.end(id, state, outcome);
  }

 private:
  Sink& sink_;
  std::uint64_t tap_;
};

}  // namespace

TEST_CASE("A curve that ends at a value that is none names the tap") {
  const TemporaryFolder folder;
  const Study study = synthetic::study({.points = 1, .realizations = 1});
  const auto store = RunStore::create(folder / "run.h5", study, {}, synthetic::provenance());
  WithoutValue sink(*store, 4);
  synthetic::run(sink, study, {0, 0});
  store->finish();
  const std::uint32_t points[] = {0};
  const auto notes = [&](std::size_t column) {
    return results_curves(store->results(), points, study.points[0].observables[column].name,
                          {1, 6})
        .front()
        .notes;
  };
  REQUIRE(notes(0).size() == 1);
  CHECK(notes(0).front() == "The curve ends at tap 3: " + study.points[0].observables[0].name +
                                " has no finite value at the next.");
  CHECK(notes(1).empty());
}
