#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/options/command.hpp"
#include "cli/tables/layout.hpp"
#include "config/json/json.hpp"
#include "ensemble/analysis/table.hpp"
#include "results/content/study.hpp"
#include "results/locks/patience.hpp"
#include "study/results_input.hpp"

namespace jostle::inline cli {

/// Where the tables of a command go: to the terminal or as JSON to a program, to a CSV file, and
/// into the results file they come from.
struct TableOutput {
  std::string csv;
  bool json = false, force = false, not_stored = false;
  Layout layout;
  Live live = Live::no;
  Patience patience;

  /// A run in progress would lose them.
  bool stored() const { return !not_stored && live == Live::no; }
};

/// --json, --csv, --wide, --force, --no-store, --wait, --live.
void add_table_output(Command& command, TableOutput& output);

/// Prints tables as they come, and at the end what comes as a whole. Where none could be made the
/// reasons go to standard error, and for people nothing is printed.
class ShownTables {
 public:
  explicit ShownTables(const TableOutput& output) : output_(output) {}

  /// A line for people above what follows.
  void heading(const std::string& text);
  /// `input`: what they were made of, for programs; may be empty.
  void show(std::span<const Table> tables, const std::string& input);
  /// Stores tables that were shown in the results file they were made of, where that is asked for.
  void keep(const std::string& path, const std::string& group, std::span<const Table> tables,
            const Provenance& provenance, const DataVersion& made);
  /// Returns the exit code: bad input where no table was made, broken where some are not stored.
  int end(const Provenance& provenance) const;

 private:
  void print_once_any_is_made(const std::string& text);

  const TableOutput& output_;
  std::string held_;      // to be printed once a table is made
  std::string refusals_;  // why tables could not be made, a line each
  Json listed_ = Json::array();
  std::string csv_;
  bool any_ = false, all_stored_ = true;
};

}  // namespace jostle::inline cli
