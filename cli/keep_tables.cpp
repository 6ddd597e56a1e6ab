#include "cli/keep_tables.hpp"

#include <fmt/format.h>

#include <fstream>

#include "cli/standard_error.hpp"
#include "results/error.hpp"
#include "results/tables.hpp"

namespace jostle {

void keep_tables(const std::string& path, const std::string& group, std::span<const Table> tables,
                 const Provenance& by) {
  try {
    store_tables(path, group, tables, by);
  } catch (const ResultsError& error) {
    print_to_standard_error(
        fmt::format("jostle: the tables are not stored under /{}: {}\n", group, error.what()));
  }
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw ResultsError(path, "cannot be written");
}

nlohmann::json provenance_json(const Provenance& by) {
  return {{"version", by.version},
          {"git_revision", by.git_revision},
          {"command_line", by.command_line},
          {"started", by.started}};
}

}  // namespace jostle
