#include "ensemble/fold.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <thread>

#include "ensemble/moments.hpp"
#include "ensemble/run.hpp"
#include "small_plans.hpp"

using namespace jostle;

namespace {

constexpr std::uint32_t realizations = 4;

// An example of an own sink: it keeps only the block.
class FoldingSink : public Sink {
 public:
  explicit FoldingSink(SeriesBlock& block) : block_(block) {}
  std::optional<RealizationState> begin(RealizationId) override { return std::nullopt; }
  void append(RealizationId id, const TapRow& row) override { block_.set(id.realization, row); }
  void snapshot(RealizationId, const SnapshotRecord&) override {}
  void checkpoint(RealizationId, const RealizationState&, const Work&) override {}
  void end(RealizationId, const RealizationState&, const Outcome&) override {}

 private:
  SeriesBlock& block_;
};

SeriesBlock block_of(const Plan& plan, int threads) {
  SeriesBlock block(plan.observables.size() + columns(plan.engine).size(), 0, total_taps(plan) + 1,
                    realizations);
  FoldingSink sink(block);
  Progress progress;
  std::vector<RealizationId> ids;
  for (std::uint32_t r = 0; r < realizations; ++r) ids.push_back({0, r});
  run_ensemble(std::span(&plan, 1), ids, {.threads = threads}, sink, progress);
  return block;
}

}  // namespace

TEST_CASE("A sink of one's own folds its ensemble in the order of realizations") {
  const Plan plan = small_plan();
  const SeriesBlock block = block_of(plan, 1), by_threads = block_of(plan, 3);
  for (std::size_t c = 0; c < block.n_columns(); ++c) {
    const FoldedColumn folded = block.folded(c), second = by_threads.folded(c);
    REQUIRE(folded.mean.size() == total_taps(plan) + 1);
    for (std::size_t tap = 0; tap < folded.mean.size(); ++tap) {
      Moments moments;
      for (std::uint32_t r = 0; r < realizations; ++r) {
        moments.add(block.column(c)[tap * realizations + r]);
      }
      const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
      CHECK(bits(folded.mean[tap]) == bits(moments.mean()));
      CHECK(bits(folded.sigma[tap]) == bits(moments.sigma()));
      CHECK(bits(folded.error[tap]) == bits(moments.standard_error()));
      CHECK(folded.count[tap] == moments.count());
      CHECK(bits(folded.mean[tap]) == bits(second.mean[tap]));
    }
  }
}

TEST_CASE("Realizations that have not come so far, or have no value, are not counted") {
  SeriesBlock block(2, 10, 3, 2);
  block.set(0, std::vector<double>{1, -std::nan(""), 3, 4, 5, 6});
  block.set(1, {.tap = 11, .observables = {7}, .diagnostics = {8}});
  const FoldedColumn first = block.folded(0), second = block.folded(1);
  CHECK(first.count == std::vector<std::uint32_t>{1, 2, 1});
  CHECK(second.count == std::vector<std::uint32_t>{0, 2, 1});
  CHECK(first.mean == std::vector<double>{1, 5, 5});
  CHECK(first.sigma == std::vector<double>{0, 2, 0});
  CHECK(std::isnan(first.error[0]));
  CHECK(first.error[1] == 2);
  CHECK(std::isnan(second.mean[0]));
  CHECK_FALSE(std::signbit(block.column(1)[0]));  // all NaN are alike
}
