#pragma once

#include <span>
#include <string>

#include "results/disk/publish.hpp"

// Checks of outputs of a command. Each throws BadInput, or with ResultsError where there is no
// such folder, and is called before any work is done.
namespace jostle::inline cli {

/// The meaning of --force. Files that exist are refused before any work is done, and once more when
/// the new file gets its name: two commands may make it at the same time.
inline ExistingFile existing_files(bool force) {
  return force ? ExistingFile::replaced : ExistingFile::kept;
}

/// True if a path is a pipe, a device, or a descriptor such as /dev/stdout: text can go there as it
/// comes, but no file in its place.
bool is_stream(const std::string& path);

/// Refuses what no file can replace: a folder, a pipe, a device, a descriptor such as /dev/stdout.
/// `example` is a file's name to choose instead.
void require_replaceable(const std::string& output, const std::string& example);

/// Throws ResultsError where the folder of the file is missing, or its name is too long.
void require_folder(const std::string& output);

/// Refuses a link at a name that the command made up itself: nobody asked for what it leads to.
void require_no_link(const std::string& output);

/// Refuses an output that is one of the files that the command reads, by whatever name. `option` is
/// the one that names the output.
void require_not_read(const std::string& option, const std::string& output,
                      std::span<const std::string> read);

/// Refuses to let --force replace a file that holds something, but no results.
void require_results_or_empty(const std::string& output);

/// Refuses, for a file of text: one that the command reads; one that exists, unless `force`; and a
/// folder. Pipes, devices and descriptors can be written to. Nothing to refuse where no output is
/// named.
void require_text_output(const std::string& option, const std::string& output,
                         std::span<const std::string> read, bool force);

}  // namespace jostle::inline cli
