#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ensemble/sink.hpp"
#include "results/bytes.hpp"
#include "results/record.hpp"

// The files under NAME.parts/: for every realization at work one state, replaced at each
// checkpoint, and numbered segments of its series, each written once.
namespace jostle {

/// What every part carries, so that a foreign one is told from ours.
struct PartIdentity {
  std::string run_id;
  RealizationId id;
};

/// Rows and snapshots that follow on one another.
struct SeriesPiece {
  std::uint64_t first_row = 0;
  std::vector<double> rows;  // [n_rows, n_columns]
  std::vector<SnapshotRecord> snapshots;

  std::size_t bytes() const;
};

/// A checkpoint. The series of a realization are the first `base_rows` rows of the results file,
/// then its segments, then `tail`.
struct PartState {
  std::uint64_t base_rows = 0;
  std::uint32_t n_segments = 0;
  SeriesPiece tail;
  RealizationStatus status = RealizationStatus::running;
  std::string reason;
  Work work{};  // over all processes that lived to tell
  std::optional<RealizationState> state;
};

std::string parts_folder(const std::string& results_path);
std::string state_path(const std::string& results_path, RealizationId id);
std::string segment_path(const std::string& results_path, RealizationId id, std::uint32_t number);

/// Publish a part. Throw ResultsError.
void write_state(const std::string& path, const PartIdentity& identity, const PartState& state);
void write_segment(const std::string& path, const PartIdentity& identity, std::uint32_t number,
                   const SeriesPiece& piece);

/// Read a part. Throw ResultsError where it is missing, truncated, damaged, of another run or
/// another realization.
PartState read_state(const std::string& path, const PartIdentity& identity);
SeriesPiece read_segment(const std::string& path, const PartIdentity& identity,
                         std::uint32_t number);

/// Restart states, also as they are kept in the results file. Reading throws std::out_of_range
/// where the bytes end too early or are those of another version of the program.
void put(ByteWriter& writer, const RealizationState& state);
RealizationState get_realization_state(ByteReader& reader);

}  // namespace jostle
