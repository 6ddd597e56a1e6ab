#include "results/disk/temporary_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <stdlib.h>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

#include "results/disk/checksum.hpp"
#include "results/disk/error.hpp"
#include "results/disk/names.hpp"
#include "results/disk/output_path.hpp"
#include "results/disk/publish.hpp"

namespace jostle::inline results {
namespace {

constexpr std::size_t random_digits = 8;
constexpr std::string_view ending = ".tmp";
constexpr mode_t permissions = 0777;

/// The file to be replaced, if this is permitted.
std::optional<struct stat> replaced_file(const std::string& path, ExistingFile existing) {
  struct stat status;
  if (::lstat(path.c_str(), &status) != 0) {
    if (errno == ENOENT) return std::nullopt;
    fail_on_disk(path, "create", errno);
  }
  if (S_ISLNK(status.st_mode))
    throw ResultsError(path, "is a link that jostle did not make: remove it");
  require_replaceable_file(path);
  if (existing == ExistingFile::kept) refuse_existing(path);
  return status;
}

/// Gives a file a second name that nothing has yet. Returns false where the file system has no
/// second names, as FAT has none.
bool link_at(const std::string& name, const std::string& target) {
  if (::link(name.c_str(), target.c_str()) == 0) return true;
  if (errno == EEXIST) refuse_existing(target);
  if (errno == EPERM || errno == ENOTSUP || errno == ENOSYS) return false;
  fail_on_disk(name, "link", errno);
}

/// The owner and the permissions of what will be replaced, as far as the system lets us.
void take_over(const std::string& path, int file, const struct stat& old) {
  struct stat own;
  if (::fstat(file, &own) != 0) fail_on_disk(path, "create", errno);
  mode_t mode = old.st_mode & permissions;
  // Permissions of the old group are not given to another.
  const bool same_group = own.st_gid == old.st_gid || ::fchown(file, -1, old.st_gid) == 0;
  if (!same_group) mode &= ~static_cast<mode_t>(070);
  if (own.st_uid != old.st_uid && ::fchown(file, old.st_uid, -1) != 0 && errno != EPERM)
    fail_on_disk(path, "create", errno);
  if (::fchmod(file, mode) != 0) fail_on_disk(path, "create", errno);
}

std::string name_on_the_way(const std::string& target, const std::string& digits) {
  return path_with_ending(target, fmt::format(".{}{}", digits, ending));
}

/// True if a file is one that a TemporaryFile makes of what goes to `target`.
bool is_temporary(const std::string& path, const std::string& target) {
  if (path.size() < random_digits + ending.size()) return false;
  const std::string digits =
      path.substr(path.size() - random_digits - ending.size(), random_digits);
  return digits.find_first_not_of("0123456789abcdef") == std::string::npos &&
         path == name_on_the_way(target, digits);
}

}  // namespace

TemporaryFile::TemporaryFile(const std::string& path, ExistingFile existing)
    : target_(path), existing_(existing) {
  require_name_fits(target_);
  output_path(target_);  // refuses links of others on the way
  const auto old = replaced_file(target_, existing_);
  const mode_t mode = old ? 0600 : 0666;
  do {
    name_ = name_on_the_way(target_, random_identity().substr(0, random_digits));
    file_ =
        Descriptor(::open(name_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode));
  } while (!file_ && errno == EEXIST);
  if (!file_) fail_on_disk(name_, "create", errno);
  try {
    if (old) take_over(name_, file_.get(), *old);
  } catch (...) {
    ::unlink(name_.c_str());
    throw;
  }
}

TemporaryFile::~TemporaryFile() {
  if (!published_) ::unlink(name_.c_str());
}

void TemporaryFile::write(std::span<const std::byte> bytes) {
  write_all(name_, file_.get(), bytes);
}

void TemporaryFile::finish() {
  if (file_ && ::fsync(file_.get()) != 0) fail_on_disk(name_, "fsync", errno);
  file_ = Descriptor();
}

/// A file that cannot lose its first name does not keep the second.
void TemporaryFile::drop_first_name() {
  if (::unlink(name_.c_str()) != 0) {
    const int error = errno;
    ::unlink(target_.c_str());
    fail_on_disk(name_, "remove", error);
  }
  published_ = true;
}

void TemporaryFile::take_name() {
  if (existing_ == ExistingFile::kept) {
    if (link_at(name_, target_)) return drop_first_name();
    replaced_file(target_, existing_);
  }
  if (::rename(name_.c_str(), target_.c_str()) != 0) fail_on_disk(name_, "rename", errno);
  published_ = true;
}

void TemporaryFile::publish(const std::function<void()>& prepare) {
  finish();
  if (prepare) prepare();
  take_name();
  sync_folder_of(target_);
}

void publish_all(std::span<const std::unique_ptr<TemporaryFile>> files) {
  std::vector<const TemporaryFile*> added;
  try {
    for (const auto& file : files) {
      struct stat status;
      const bool is_new = ::lstat(file->target().c_str(), &status) != 0;
      if (is_new) added.push_back(file.get());
      file->publish();
    }
  } catch (const ResultsError&) {
    for (const TemporaryFile* const file : added)
      if (file->is_published()) ::unlink(file->target().c_str());
    throw;
  }
}

void remove_stale_temporaries(const std::string& path) {
  const std::string target =
      std::filesystem::path(folder_of(path)) / std::filesystem::path(path).filename();
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder_of(path), error), end;
       !error && entry != end; entry.increment(error)) {
    struct stat status;
    if (!is_temporary(entry->path(), target)) continue;
    if (::lstat(entry->path().c_str(), &status) == 0 && S_ISREG(status.st_mode))
      remove_file(entry->path());
  }
}

ScratchFolder::ScratchFolder(const std::string& purpose, const std::filesystem::path& parent) {
  std::string name = (parent / fmt::format("jostle-{}-XXXXXX", purpose)).string();
  output_path(name);  // refuses links of others on the way
  if (::mkdtemp(name.data()) == nullptr) {
    const std::string reason = std::generic_category().message(errno);
    throw ResultsError(parent.string(), fmt::format("cannot make a folder there ({})", reason));
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace jostle::inline results
