#pragma once

#include <filesystem>
#include <string>

namespace jostle::inline results {

/// A new empty folder, removed with all that is in it when this goes.
class ScratchFolder {
 public:
  /// jostle-PURPOSE-xxxxxx in `within`, or among the temporary files. Throws ResultsError.
  explicit ScratchFolder(const std::string& purpose, const std::filesystem::path& within =
                                                         std::filesystem::temp_directory_path());
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace jostle::inline results
