#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "results/disk/publish.hpp"
#include "results/disk/system_calls.hpp"

namespace jostle::inline results {

/// A file on its way to its name: written as NAME.xxxxxxxx.tmp, of random digits, that nobody else
/// has, and then given its name at one stroke. It is removed with this object unless it was
/// published. Everything throws ResultsError.
class TemporaryFile {
 public:
  /// Makes an empty file beside `path`. Permissions of a file that will be replaced are copied. A
  /// link, a directory, a write-protected file and a file to be kept are rejected.
  explicit TemporaryFile(const std::string& path, ExistingFile existing = ExistingFile::replaced);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();

  const std::string& name() const { return name_; }
  /// Where it goes.
  const std::string& target() const { return target_; }
  void write(std::span<const std::byte> bytes);
  /// On disk first, then under its name, then the name on disk. `prepare` is called once it is on
  /// disk: what must go when the new file comes, and must stay if it does not.
  void publish(const std::function<void()>& prepare = {});
  bool is_published() const { return published_; }
  /// On disk, not yet under its name, and closed: nothing more is written to it.
  void finish();

 private:
  void take_name();
  void drop_first_name();

  std::string target_, name_;
  ExistingFile existing_;
  Descriptor file_;
  bool published_ = false;
};

/// Publishes several finished files that belong together.
/// Where one cannot be given its name, earlier ones that replaced nothing are removed again.
void publish_all(std::span<const std::unique_ptr<TemporaryFile>> files);

/// Removes what killed processes left on the way to `path`. For the owner of its lock.
void remove_stale_temporaries(const std::string& path);

/// A new empty folder, removed with all that is in it when this goes.
class ScratchFolder {
 public:
  /// jostle-PURPOSE-xxxxxx in `parent`, or among the temporary files. Throws ResultsError.
  explicit ScratchFolder(const std::string& purpose, const std::filesystem::path& parent =
                                                         std::filesystem::temp_directory_path());
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace jostle::inline results
