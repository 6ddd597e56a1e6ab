#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/bed/packing.hpp"
#include "ensemble/analysis/table.hpp"
#include "ensemble/motion/motion_records.hpp"
#include "results/content/record.hpp"
#include "results/content/stored_realization.hpp"
#include "results/content/study.hpp"
#include "results/locks/patience.hpp"

namespace jostle::inline results {

class WritableHdf5File;

/// Written on the file: `running` until the first fold, then `interrupted` while realizations of
/// the shard have taps left, else `complete` (with or without failed realizations).
enum class RunState { running, interrupted, complete };
/// "running", "interrupted", "complete": the word in files and texts.
const char* name_of(RunState state);

/// One column of the series at one sweep point, over all realizations.
struct Series {
  Column label;
  std::uint64_t n_taps = 0;  // rows: taps 0 .. n_taps - 1
  std::uint32_t n_realizations = 0;
  std::vector<double> values;  // [n_taps, n_realizations]; NaN where there is none

  double value(std::uint64_t tap, std::uint32_t realization) const {
    return values[tap * n_realizations + realization];
  }
};

/// Taps first .. end - 1.
struct TapRange {
  std::uint64_t first, end;
};
/// Realizations first .. end - 1.
struct RealizationRange {
  std::uint32_t first, end;
};

/// Statistics over the ensemble, [n_taps] each.
struct EnsembleSeries {
  Column label;
  std::vector<double> mean, sigma, error;  // sigma has 1/M; NaN where undefined
  std::vector<std::uint32_t> count;        // realizations that have a value
};

/// A number a realization: [n_realizations], NaN where there is none.
struct RealizationValues {
  Column label;
  std::vector<double> values;
};
/// Selected data of a realization.
enum class Content { everything, without_snapshots };

/// Verification of a file before it is read: its whole checksum, or only its presence.
enum class Verify { whole_file, end_of_file };

enum class Realizations { all, of_its_share };

/// The data of a file: a run that adds to it, or another file in its place, has another version.
struct DataVersion {
  std::string run_id;
  std::size_t processes = 0;  // number that has worked on it
  bool operator==(const DataVersion&) const = default;
};

struct RealizationSummary {
  RealizationId id;
  RealizationStatus status = RealizationStatus::missing;
  std::uint64_t rows = 0;  // recorded taps, the start included
  std::string reason;      // reason of a failure
  Work work{};

  /// Recorded taps. The start, tap 0, is none.
  std::uint64_t taps() const { return rows > 0 ? rows - 1 : 0; }
};

/// A results file opened for reading. Its checksum is verified first: a damaged, truncated or
/// foreign file is rejected with a ResultsError that names the fault. One thread at a time may use
/// any ResultsFile.
class ResultsFile {
 public:
  explicit ResultsFile(const std::string& path, Verify verify = Verify::whole_file);
  /// One of many files of a study: it shares the study of `sibling` where it has the same.
  ResultsFile(const std::string& path, Verify verify, const ResultsFile& sibling);
  /// A file that replaces `known_as`: path() and errors name that.
  ResultsFile(const std::string& path, const std::string& known_as);
  ~ResultsFile();
  ResultsFile(ResultsFile&&) noexcept;

  const std::string& path() const;
  RunState state() const;
  const Shard& shard() const;
  const Study& study() const;
  const std::vector<Provenance>& provenance() const;  // one per process that worked on it
  /// Marks this run's parts; random.
  const std::string& run_id() const;
  DataVersion data_version() const { return {run_id(), provenance().size()}; }

  /// Every (point, realization), points outermost; or those of its share alone.
  std::vector<RealizationSummary> realizations(Realizations selection = Realizations::all) const;
  /// Returns those of one sweep point; reads nothing of the others.
  std::vector<RealizationSummary> realizations_at(std::uint32_t point) const;
  /// The observables, then the diagnostics of the engine.
  std::vector<Series> series(std::uint32_t point) const;
  /// Labels of the same.
  std::vector<Column> columns(std::uint32_t point) const;
  /// A part of one column, for series too long to hold: [taps, realizations], NaN where there is
  /// no value. Throws where there is no such column.
  std::vector<double> block(std::uint32_t point, const std::string& column, const TapRange& taps,
                            const RealizationRange& chosen) const;
  std::vector<EnsembleSeries> ensemble(std::uint32_t point) const;
  /// Records of fitting each pour between walls (fitting_columns); empty for another start.
  std::vector<RealizationValues> fittings(std::uint32_t point) const;
  /// How far spheres moved; nothing where it was not followed, or nothing has been found yet.
  std::optional<MotionRecords> motion(std::uint32_t point) const;
  /// How many taps its series hold: to the last that any realization has come to.
  std::uint64_t n_stored_rows(std::uint32_t point) const;
  /// A realization, to be read piece by piece while this file is there; or that without its
  /// snapshots.
  std::unique_ptr<StoredRealization> realization(RealizationId id,
                                                 Content content = Content::everything) const;
  /// Everything stored of one realization.
  RealizationRecord record(RealizationId id) const;
  /// The state for a resume; nothing for missing and failed ones.
  std::optional<RealizationState> restart_state(RealizationId id) const;
  /// Its snapshots alone; centres are empty where positions were not kept.
  std::vector<SnapshotRecord> snapshots(RealizationId id) const;
  /// Its kept positions alone: tap and centres.
  std::vector<SnapshotRecord> positions(RealizationId id) const;
  /// The sizes of its spheres: null where all have the diameter 1. Throws where they are drawn, and
  /// the realization has not begun or has failed.
  std::shared_ptr<const Sizes> sizes(RealizationId id) const;
  /// Gives back the file's descriptor and what was kept of it in memory, until it is read again.
  void rest() const;
  /// Gives back what was kept of its series.
  void forget_rows() const;
  /// Derived tables of a group (results/file/tables.hpp), in the order of their names; none where
  /// there is no such group.
  std::vector<Table> tables(const std::string& group) const;
  /// Names of all derived tables with their group first, in order: "fits/point_0000/...".
  std::vector<std::string> table_names() const;
  /// Names of the derived tables that hold only the reason why they have no results.
  std::vector<std::string> tables_without_results() const;

 private:
  class Impl;
  class Stored;
  std::unique_ptr<Impl> impl_;
  friend void copy_tables(const ResultsFile&, const WritableHdf5File&);
};

/// The changes that another program made to a file that it opened for writing and closed, where the
/// contents are still the old ones and readers take it; otherwise empty. Reads
/// the ends of the file alone.
std::string seal_warning(const std::string& path);

/// Seals such a file again, and returns whether there was anything to do. Throws ResultsError where
/// its contents are not the old ones, LockHeld as store_tables() does.
bool reseal(const std::string& path, const Patience& patience = {});

/// SHA-256, in hex, over every dataset and attribute outside /provenance, /timing and /h5md, in
/// order of their paths: path, type, shape and values, whatever the chunks and compression. The
/// file's checksum is verified first.
std::string digest_of(const std::string& path);

}  // namespace jostle::inline results
