#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/bytes.hpp"
#include "ensemble/sink.hpp"
#include "results/content/record.hpp"

// The files under NAME.parts/: for every realization at work one state, replaced at each
// checkpoint, and numbered segments of its series, each written once.
namespace jostle::inline results {

/// The number of the parts' format.
inline constexpr std::uint32_t part_format = 6;

/// Identification in every part, which distinguishes foreign parts.
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
  Work work{};  // over all processes that reported
  std::optional<RealizationState> state;
};

/// Position of a row of numbers in a part's file, and the number of rows.
struct Extent {
  std::uint64_t n = 0, offset = 0;
};
/// And a snapshot, but for what takes little room.
struct SnapshotPlace {
  std::uint64_t tap = 0;
  std::array<Extent, n_sphere_vectors> vectors{};
  std::array<Extent, n_height_profiles> profiles{};
  Extent contacts{};
  std::optional<double> coordination{};
  std::optional<BedForces> forces{};
};
/// And a piece.
struct PiecePlaces {
  std::uint64_t first_row = 0, n_numbers = 0, rows_at = 0;
  std::vector<SnapshotPlace> snapshots;
};
/// A checkpoint whose tail stays in its file.
struct PartOutline {
  PartState part;  // without its tail
  PiecePlaces tail;
  std::string stamp;  // stamp of its file, which another checkpoint may replace
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
/// Like the functions above, but loads series and snapshots lazily.
PartOutline read_state_outline(const std::string& path, const PartIdentity& identity);
PiecePlaces read_segment_places(const std::string& path, const PartIdentity& identity,
                                std::uint32_t number);

/// Restart states, also as they are kept in the results file. Reading throws std::out_of_range
/// where the bytes end too early or are those of another version of the program.
void put(ByteWriter& writer, const RealizationState& state);
RealizationState get_realization_state(ByteReader& reader);

}  // namespace jostle::inline results
