#include "cli/output_file.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "cli/scene_file.hpp"

namespace jostle {
namespace {

namespace fs = std::filesystem;

/// /dev/stdout, /dev/fd/1, /proc/self/fd/1: whatever it stands for now, no file can be put there.
bool is_descriptor(const fs::path& path) {
  std::error_code ignored;
  const fs::path named = fs::is_symlink(path, ignored) ? fs::read_symlink(path, ignored) : path;
  return fs::weakly_canonical(named.parent_path(), ignored).string().starts_with("/proc/");
}

}  // namespace

void require_replaceable(const std::string& output, const std::string& example) {
  std::error_code ignored;
  const fs::file_status status = fs::status(output, ignored);
  if (fs::is_directory(status)) {
    throw BadInput(fmt::format("{} is a folder: name a file in it with -o, as {}", output,
                               (fs::path(output) / example).string()));
  }
  if ((fs::exists(status) && !fs::is_regular_file(status)) || is_descriptor(output)) {
    throw BadInput(
        fmt::format("{} is a pipe, a device or a descriptor: what is written replaces a file "
                    "whole. Name one with -o, as {}",
                    output, example));
  }
}

}  // namespace jostle
