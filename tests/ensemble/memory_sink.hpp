#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <vector>

#include "ensemble/sink.hpp"

namespace jostle {

/// Everything a sink was given for one realization.
struct RecordedRealization {
  std::vector<TapRow> rows;
  std::vector<SnapshotRecord> snapshots;
  std::optional<RealizationState> state;  // state of the last checkpoint or the end
  std::optional<Outcome> outcome;
  unsigned checkpoints = 0;
  Work work{};  // the last checkpoint has it

  // Durable rows: appended before the last checkpoint.
  std::size_t durable_rows = 0, durable_snapshots = 0;
};

/// Keeps records in memory as a durable sink would on disk: what was appended after the last
/// checkpoint is forgotten at the next begin().
class MemorySink : public Sink {
 public:
  /// Called at the beginning of every call below, before anything is recorded; may throw.
  std::function<void(RealizationId, const char* call)> on_call = [](RealizationId, const char*) {};

  std::optional<RealizationState> begin(RealizationId id) override {
    on_call(id, "begin");
    const std::scoped_lock lock(mutex_);
    RecordedRealization& record = records_[id];
    record.rows.resize(record.durable_rows);
    record.snapshots.resize(record.durable_snapshots);
    record.outcome.reset();
    return record.state;
  }
  void append(RealizationId id, const TapRow& row) override {
    on_call(id, "append");
    const std::scoped_lock lock(mutex_);
    records_[id].rows.push_back(row);
  }
  void snapshot(RealizationId id, const SnapshotRecord& snapshot) override {
    on_call(id, "snapshot");
    const std::scoped_lock lock(mutex_);
    records_[id].snapshots.push_back(snapshot);
  }
  void checkpoint(RealizationId id, const RealizationState& state, const Work& work) override {
    on_call(id, "checkpoint");
    const std::scoped_lock lock(mutex_);
    ++records_[id].checkpoints;
    records_[id].work = work;
    keep(records_[id], state);
  }
  void end(RealizationId id, const RealizationState& state, const Outcome& outcome) override {
    on_call(id, "end");
    const std::scoped_lock lock(mutex_);
    records_[id].outcome = outcome;
    keep(records_[id], state);
  }

  /// To be read when no run is going on.
  const std::map<RealizationId, RecordedRealization>& records() const { return records_; }

 private:
  static void keep(RecordedRealization& record, const RealizationState& state) {
    record.state = state;
    record.durable_rows = record.rows.size();
    record.durable_snapshots = record.snapshots.size();
  }

  std::mutex mutex_;
  std::map<RealizationId, RecordedRealization> records_;
};

}  // namespace jostle
