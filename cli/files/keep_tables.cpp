#include "cli/files/keep_tables.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>

#include "cli/files/output_file.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "results/checkpoints/output_path.hpp"
#include "results/checkpoints/publish.hpp"
#include "results/error.hpp"
#include "results/hdf5/descriptor.hpp"
#include "results/tables.hpp"

namespace jostle::inline cli {

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
  const auto bytes = std::as_bytes(std::span(text));
  const std::string end = output_path(path);
  if (!is_stream(path)) return publish(end, bytes);
  const Descriptor stream(::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOCTTY));
  if (!stream) fail_on_disk(path, "open", errno);
  write_all(path, stream.get(), bytes);
}

Json provenance_json(const Provenance& by) {
  return {{"version", by.version},
          {"git_revision", by.git_revision},
          {"command_line", by.command_line},
          {"started", by.started}};
}

}  // namespace jostle::inline cli
