#include "cli/terminal/shown_tables.hpp"

#include <fmt/format.h>

#include <utility>

#include "cli/files/keep_tables.hpp"
#include "cli/files/live_input.hpp"
#include "cli/files/output_file.hpp"
#include "cli/files/waiting.hpp"
#include "cli/tables/table_output.hpp"
#include "cli/tables/table_text.hpp"
#include "cli/terminal/exit_codes.hpp"
#include "cli/terminal/screen.hpp"
#include "cli/terminal/standard_streams.hpp"

namespace jostle::inline cli {

void add_table_output(Command& command, TableOutput& output) {
  command.add_flag("--json", output.json, "Print JSON, for programs");
  command.add_option("--csv", output.csv, "File to which the tables are also written")
      .file_to_write();
  add_wide(command, output.layout);
  command.add_flag("--force", output.force, "Replace the file of --csv if it exists");
  command.add_flag("--no-store", output.not_stored, "Leave the results files as they are");
  add_wait(command, output.patience);
  add_live(command, output.live);
}

void ShownTables::heading(const std::string& text) {
  if (!output_.json) print_once_any_is_made(fmt::format("{}\n\n", text));
}

void ShownTables::print_once_any_is_made(const std::string& text) {
  held_ += text;
  if (!any_) return;
  print_report(held_);
  held_.clear();
}

void ShownTables::show(std::span<const Table> tables, const std::string& input) {
  for (const Table& table : tables) {
    any_ = any_ || is_made(table);
    for (const auto& [name, text] : table.notes) {
      if (name == "refused") refusals_ += fmt::format("\n  {}: {}", table.name, text);
    }
    if (output_.json) {
      Json listed = table_json(table);
      if (!input.empty()) listed["file"] = input;
      listed_.push_back(std::move(listed));
    } else {
      print_once_any_is_made(table_text(table, output_.layout) + "\n");
    }
    if (output_.csv.empty()) continue;
    if (!input.empty()) csv_ += fmt::format("# {}\n", input);
    csv_ += table_csv(table);
  }
}

void ShownTables::keep(const std::string& path, const std::string& group,
                       std::span<const Table> tables, const Provenance& provenance,
                       const DataVersion& made) {
  if (output_.stored() && !keep_tables(path, group, tables, provenance, output_.patience, made))
    all_stored_ = false;
}

int ShownTables::end(const Provenance& provenance) const {
  if (output_.json) {
    const Json object = {{"tables", listed_}, {"provenance", provenance_json(provenance)}};
    print_json(object);
  }
  // A file of refusals alone would be in the way of the corrected command.
  if (any_ && !output_.csv.empty()) write_text(output_.csv, csv_, existing_files(output_.force));
  if (!all_stored_) return exit_io_error;
  if (any_) return exit_ok;
  print_to_standard_error(fmt::format("jostle: no table could be made{}\n", refusals_));
  return exit_bad_input;
}

}  // namespace jostle::inline cli
