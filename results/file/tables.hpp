#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ensemble/analysis/table.hpp"
#include "results/content/study.hpp"
#include "results/file/results_file.hpp"
#include "results/locks/patience.hpp"

// Tables derived from a run's data and kept in its file: the groups /fits, /analysis and
// /structure. They can be made again from the data at any time, and are not part of the digest.
namespace jostle::inline results {

inline constexpr const char* derived_groups[] = {"analysis", "fits", "structure"};

/// Tables that belong into one of the groups.
struct TableGroup {
  std::string name;
  std::vector<Table> tables;
};

/// Fate of a table with results when one of its name without any is to be stored. `left`: tables
/// without results are not stored at all.
enum class StoredResults { replaced, left };

/// Puts the tables into `group` of the results file: /<group>/<table name>/<axis or quantity>,
/// axes as dimension scales, notes as attributes of the table. A table of the same name is
/// replaced, unless `stored` leaves it; others stay. Returns the names of those that were left.
/// Every table records its origin: attributes version, git_revision, command_line, made. The file
/// is never written in place: a changed copy is published over it. Throws ResultsError, also where
/// the file's data are no longer those of which the tables were `made`; LockHeld where another
/// process holds the file's lock for longer than `patience` lasts; std::invalid_argument for a
/// quantity whose number of values its axes do not give.
std::vector<std::string> store_tables(const std::string& path, const std::string& group,
                                      std::span<const Table> tables, const Provenance& provenance,
                                      const Patience& patience = {},
                                      StoredResults stored = StoredResults::replaced,
                                      const std::optional<DataVersion>& made = {});

/// Like store_tables(), for several groups in one replacement of the file.
std::vector<std::string> store_tables(const std::string& path, std::span<const TableGroup> groups,
                                      const Provenance& provenance, const Patience& patience = {},
                                      StoredResults stored = StoredResults::replaced,
                                      const std::optional<DataVersion>& made = {});

/// Writes all derived tables of a file into another that has none, with their origins.
void copy_tables(const ResultsFile& source, const WritableHdf5File& copy);

/// The tables of a group, in the order of their names; none where there is no such group. Throws
/// ResultsError.
std::vector<Table> read_tables(const std::string& path, const std::string& group);

/// Names of all tables of the file with their group first, in order: "fits/point_0000/...".
std::vector<std::string> table_names(const std::string& path);

}  // namespace jostle::inline results
