#include "cli/files/output_file.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "results/checkpoints/part.hpp"
#include "results/disk/error.hpp"
#include "results/disk/names.hpp"
#include "results/disk/output_path.hpp"
#include "results/disk/publish.hpp"
#include "study/bad_input.hpp"
#include "study/results_input.hpp"

namespace jostle::inline cli {
namespace {

namespace fs = std::filesystem;

/// /dev/stdout, /dev/fd/1, /proc/self/fd/1: whatever it stands for now, no file can be put there.
bool is_descriptor(const fs::path& path) {
  std::error_code ignored;
  const fs::path named = fs::is_symlink(path, ignored) ? fs::read_symlink(path, ignored) : path;
  return fs::weakly_canonical(named.parent_path(), ignored).string().starts_with("/proc/");
}

}  // namespace

void require_folder(const std::string& output) {
  require_name_fits(output);
  std::error_code ignored;
  const fs::path folder = fs::path(output).parent_path();
  if (folder.empty() || fs::is_directory(folder, ignored)) return;
  throw ResultsError(output, fmt::format("there is no folder {}", folder.string()));
}

bool is_stream(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) ||
         is_descriptor(path);
}

void require_replaceable(const std::string& output, const std::string& example) {
  std::error_code ignored;
  require_folder(output);
  output_path(output);  // refuses links of others
  const fs::file_status status = fs::status(output, ignored);
  if (fs::is_directory(status)) {
    throw BadInput(fmt::format("{} is a folder: name a file in it with -o, as {}", output,
                               (fs::path(output) / example).string()));
  }
  if (is_stream(output)) {
    throw BadInput(
        fmt::format("{} is a pipe, a device or a descriptor: what is written replaces a file "
                    "whole. Name one with -o, as {}",
                    output, example));
  }
  require_replaceable_file(output);
}

void require_no_link(const std::string& output) {
  std::error_code ignored;
  if (fs::is_symlink(output, ignored)) {
    throw ResultsError(output,
                       "is a link that jostle did not make: remove it, or choose another "
                       "name or folder");
  }
}

void require_not_read(const std::string& option, const std::string& output,
                      std::span<const std::string> read) {
  std::error_code ignored;
  for (const std::string& input : read) {
    const bool is_checkpoint =
        fs::equivalent(fs::absolute(output).parent_path(), parts_folder(input), ignored);
    if (!is_checkpoint && !is_same_file(output, input)) continue;
    throw BadInput(
        fmt::format("{} {}: this command works with that file and would destroy it. "
                    "Write elsewhere.",
                    option, output));
  }
}

void require_results_or_empty(const std::string& output) {
  std::error_code ignored;
  if (!fs::exists(output, ignored) || fs::is_empty(output, ignored)) return;
  if (is_results_file(output)) return;
  throw BadInput(
      fmt::format("{} is no results file, and --force replaces nothing else. Write elsewhere with "
                  "-o FILE, or remove it yourself.",
                  output));
}

void require_text_output(const std::string& option, const std::string& output,
                         std::span<const std::string> read, bool force) {
  if (output.empty()) return;
  output_path(output);  // refuses links of others
  require_not_read(option, output, read);
  require_folder(output);
  std::error_code ignored;
  if (fs::is_directory(output, ignored)) {
    throw BadInput(fmt::format("{} {}: it is a folder. Name a file in it.", option, output));
  }
  if (is_stream(output) || !fs::exists(output, ignored)) return;
  if (force) return require_replaceable_file(output);
  throw BadInput(fmt::format(
      "{} exists and is kept. Write elsewhere with {} FILE, or replace it with --force.", output,
      option));
}

}  // namespace jostle::inline cli
