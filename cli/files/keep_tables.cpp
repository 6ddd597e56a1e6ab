#include "cli/files/keep_tables.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <vector>

#include "cli/files/output_file.hpp"
#include "cli/terminal/failure.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "results/disk/error.hpp"
#include "results/disk/output_path.hpp"
#include "results/disk/printable.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/system_calls.hpp"
#include "results/disk/temporary_file.hpp"
#include "results/file/tables.hpp"

namespace jostle::inline cli {

bool keep_tables(const std::string& path, const std::string& group, std::span<const Table> tables,
                 const Provenance& provenance, const Patience& patience,
                 const std::optional<DataVersion>& made) {
  try {
    const bool any_made = std::ranges::any_of(tables, is_made);
    const std::vector<std::string> left =
        store_tables(path, group, tables, provenance, patience,
                     any_made ? StoredResults::replaced : StoredResults::left, made);
    for (const std::string& name : left)
      print_to_standard_error(
          fmt::format("jostle: /{}/{} is kept: this request gave no result\n", group, name));
    return true;
  } catch (const ResultsError& error) {
    print_to_standard_error(fmt::format("jostle: the tables are not stored under /{}: {}\n", group,
                                        printable(failure_text(error))));
    return false;
  }
}

void write_text(const std::string& path, const std::string& text, ExistingFile existing) {
  const auto bytes = std::as_bytes(std::span(text));
  const std::string end = output_path(path);
  if (!is_stream(path)) return publish(end, bytes, existing);
  const Descriptor stream(::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOCTTY));
  if (!stream) fail_on_disk(path, "open", errno);
  write_all(path, stream.get(), bytes);
}

void write_together(std::span<const ExportedFile> files, ExistingFile existing) {
  std::vector<std::unique_ptr<TemporaryFile>> written;
  for (const ExportedFile& file : files) {
    if (is_stream(file.path)) continue;
    written.push_back(std::make_unique<TemporaryFile>(output_path(file.path), existing));
    written.back()->write(std::as_bytes(std::span(file.text)));
    written.back()->finish();
  }
  publish_all(written);
  for (const ExportedFile& file : files)
    if (is_stream(file.path)) write_text(file.path, file.text, existing);
}

Json provenance_json(const Provenance& provenance) {
  return {{"version", provenance.version},
          {"git_revision", provenance.git_revision},
          {"command_line", provenance.command_line},
          {"started", provenance.started}};
}

}  // namespace jostle::inline cli
