#include "ensemble/run.hpp"

#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <utility>

#include "ensemble/parallel.hpp"
#include "ensemble/processor_clock.hpp"
#include "ensemble/realization.hpp"

namespace jostle::inline ensemble {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(ProcessorClock::time_point began) {
  return std::chrono::duration<double>(ProcessorClock::now() - began).count();
}

// True if `act` succeeded; if not, the outcome has the reason. Out of memory, or a state of another
// program, aborts the run, not the realization: it resumes from its last checkpoint.
template <class Act>
bool attempt(Outcome& outcome, Act&& act) {
  try {
    act();
    return true;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const StateError&) {
    throw;
  } catch (const std::exception& error) {
    outcome.status = RealizationStatus::failed;
    outcome.reason = error.what();
    return false;
  }
}

// One call of run_ensemble: what its threads share.
class EnsembleRun {
 public:
  EnsembleRun(std::span<const Plan> plans, const std::vector<RealizationId>& realizations,
              const RunOptions& options, Sink& sink, Progress& progress)
      : plans_(plans),
        realizations_(realizations),
        options_(options),
        sink_(sink),
        progress_(progress) {}

  RunSummary operator()() {
    on_threads(options_.threads, [this] { work(); });
    if (sink_failure_) std::rethrow_exception(sink_failure_);
    return {done_, failed_, interrupted_};
  }

 private:
  void work() noexcept;
  void run_one(RealizationId id);
  void carry_on(RealizationId id, Realization& realization, ProcessorClock::time_point began,
                Outcome& outcome);
  void hand_over(RealizationId id, const Slice& slice);
  void count(const Outcome& outcome);
  bool stopping() const;

  std::span<const Plan> plans_;
  const std::vector<RealizationId>& realizations_;
  const RunOptions& options_;
  Sink& sink_;
  Progress& progress_;

  std::atomic<std::size_t> next_{0};  // index of the next entry of realizations_
  std::atomic<std::uint64_t> done_{0}, failed_{0}, interrupted_{0};
  std::atomic<bool> sink_failed_{false};
  std::mutex sink_failure_mutex_;
  std::exception_ptr sink_failure_;  // the first
};

// Exceptions here come from the sink, a foreign state or lack of memory: `attempt` keeps other
// exceptions of a realization.
void EnsembleRun::work() noexcept {
  try {
    while (!stopping()) {
      const std::size_t mine = next_.fetch_add(1);
      if (mine >= realizations_.size()) return;
      run_one(realizations_[mine]);
    }
  } catch (...) {
    const std::scoped_lock lock(sink_failure_mutex_);
    if (!sink_failure_) sink_failure_ = std::current_exception();
    sink_failed_ = true;
  }
}

void EnsembleRun::run_one(RealizationId id) {
  struct Running {
    std::atomic<std::uint64_t>& count;
    explicit Running(std::atomic<std::uint64_t>& c) : count(c) { ++count; }
    ~Running() { --count; }
  } running(progress_.realizations_running);

  const auto began = ProcessorClock::now();
  std::optional<RealizationState> resumed = sink_.begin(id);
  std::optional<Realization> realization;
  Outcome outcome;
  const bool begun = attempt(
      outcome, [&] { realization.emplace(plans_[id.point], id.realization, std::move(resumed)); });
  if (begun) carry_on(id, *realization, began, outcome);
  outcome.work.seconds = seconds_since(began);
  const bool failed = outcome.status == RealizationStatus::failed;
  sink_.end(id, failed ? RealizationState{} : realization->state(), outcome);
  count(outcome);
}

void EnsembleRun::carry_on(RealizationId id, Realization& realization,
                           ProcessorClock::time_point began, Outcome& outcome) {
  const std::uint64_t units =
      options_.units_per_slice.value_or(realization.dynamics().units_per_slice());
  auto checkpointed = Clock::now();
  while (!realization.finished()) {
    if (stopping()) {
      outcome.status = RealizationStatus::running;
      return;
    }
    Slice slice;
    const auto advance = [&] { slice = realization.advance(units, [this] { return stopping(); }); };
    const bool starting = realization.rows() == 0;
    const bool advanced = attempt(outcome, advance);
    if (starting) outcome.work.start_seconds = seconds_since(began);
    if (!advanced) return;
    outcome.work.effort += slice.effort;
    hand_over(id, slice);
    if (!realization.finished() && Clock::now() - checkpointed >= options_.checkpoint_every) {
      outcome.work.seconds = seconds_since(began);
      sink_.checkpoint(id, realization.state(), outcome.work);
      checkpointed = Clock::now();
    }
  }
  outcome.status = RealizationStatus::done;
}

void EnsembleRun::hand_over(RealizationId id, const Slice& slice) {
  if (slice.row) sink_.append(id, *slice.row);
  if (slice.snapshot) sink_.snapshot(id, *slice.snapshot);
  progress_.units_done += slice.effort.units;
  progress_.pair_tests += slice.effort.pair_tests;
  progress_.relaxing_nanoseconds += static_cast<std::uint64_t>(slice.relaxing.count());
  if (slice.row && slice.row->tap > 0) ++progress_.taps_done;
}

void EnsembleRun::count(const Outcome& outcome) {
  switch (outcome.status) {
    case RealizationStatus::done:
      ++done_;
      ++progress_.realizations_done;
      break;
    case RealizationStatus::failed:
      ++failed_;
      ++progress_.realizations_failed;
      break;
    case RealizationStatus::running:
    case RealizationStatus::missing:
      ++interrupted_;
      break;
  }
}

bool EnsembleRun::stopping() const {
  return sink_failed_ || (options_.stop != nullptr && *options_.stop);
}

}  // namespace

RunSummary run_ensemble(std::span<const Plan> plans, const std::vector<RealizationId>& realizations,
                        const RunOptions& options, Sink& sink, Progress& progress) {
  return EnsembleRun(plans, realizations, options, sink, progress)();
}

}  // namespace jostle::inline ensemble
