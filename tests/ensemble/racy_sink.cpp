// A program with a data race of its own, in what it does with a run's rows. It proves that the
// thread sanitizer still sees the races of whatever runs on the ensemble's threads: the test passes
// if one is reported.

#include <atomic>
#include <cstdio>
#include <thread>

#include "ensemble/run.hpp"
#include "small_plans.hpp"

namespace {

using namespace jostle;

class RacySink : public Sink {
 public:
  unsigned long rows() const { return rows_; }

  std::optional<RealizationState> begin(RealizationId) override {
    // Both realizations are begun before either continues, so that two threads take part. Relaxed,
    // so that the wait orders nothing else.
    begun_.fetch_add(1, std::memory_order_relaxed);
    while (begun_.load(std::memory_order_relaxed) < 2) std::this_thread::yield();
    return std::nullopt;
  }
  void append(RealizationId, const TapRow&) override { ++rows_; }
  void snapshot(RealizationId, const SnapshotRecord&) override {}
  void checkpoint(RealizationId, const RealizationState&, const Work&) override {}
  void end(RealizationId, const RealizationState&, const Outcome&) override {}

 private:
  std::atomic<int> begun_{0};
  unsigned long rows_ = 0;  // counted by both threads, unguarded
};

}  // namespace

int main() {
  const Plan plan = small_plan();
  RacySink sink;
  Progress progress;
  run_ensemble({&plan, 1}, {{0, 0}, {0, 1}}, {.threads = 2}, sink, progress);
  std::printf("%lu rows\n", sink.rows());
}
