#include "results/run/recorder.hpp"

#include <cassert>

#include "results/run/run_parts.hpp"

namespace jostle::inline results {
namespace {

/// A tail larger than this becomes a segment, which is written once, not at every checkpoint.
constexpr std::size_t largest_tail = 1u << 20;

}  // namespace

Recorder::Recorder(std::string results_path, PartIdentity identity, std::size_t n_columns,
                   PartState part)
    : results_path_(std::move(results_path)),
      identity_(std::move(identity)),
      n_columns_(n_columns),
      part_(std::move(part)),
      work_before_(part_.work) {
  if (part_.n_segments == 0 && part_.tail.rows.empty()) part_.tail.first_row = part_.base_rows;
}

std::uint64_t Recorder::next_row() const {
  return part_.tail.first_row + part_.tail.rows.size() / n_columns_;
}

void Recorder::append(const TapRow& row) {
  assert(row.tap == next_row());
  assert(row.observables.size() + row.diagnostics.size() == n_columns_);
  auto& rows = part_.tail.rows;
  rows.insert(rows.end(), row.observables.begin(), row.observables.end());
  rows.insert(rows.end(), row.diagnostics.begin(), row.diagnostics.end());
  publish_tail_if_large();
}

void Recorder::snapshot(const SnapshotRecord& record) {
  part_.tail.snapshots.push_back(record);
  publish_tail_if_large();
}

/// A segment that no published state counts is written again by a resume from that state.
void Recorder::publish_tail_if_large() {
  if (part_.tail.bytes() < largest_tail) return;
  write_segment(segment_path(results_path_, identity_.id, part_.n_segments), identity_,
                part_.n_segments, part_.tail);
  const std::uint64_t first_row = next_row();
  part_.tail = {.first_row = first_row, .rows = {}, .snapshots = {}};
  ++part_.n_segments;
}

/// Every call replaces the work that this process reported before.
void Recorder::set_work(const Work& of_this_process) {
  part_.work = work_before_;
  part_.work += of_this_process;
}

RealizationSummary Recorder::publish_state() {
  write_state(state_path(results_path_, identity_.id), identity_, part_);
  return summary_of(identity_.id, part_);
}

RealizationSummary Recorder::checkpoint(const RealizationState& state, const Work& work) {
  assert(state.rows == next_row());
  set_work(work);
  part_.state = state;
  return publish_state();
}

RealizationSummary Recorder::end(const RealizationState& state, const Outcome& outcome) {
  part_.status = outcome.status;
  part_.reason = outcome.reason;
  set_work(outcome.work);
  part_.state = state;
  if (outcome.status == RealizationStatus::failed) {
    part_.base_rows = 0;
    part_.n_segments = 0;
    part_.tail = {};
    part_.state.reset();
  } else {
    assert(state.rows == next_row());
  }
  return publish_state();
}

}  // namespace jostle::inline results
