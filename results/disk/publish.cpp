#include "results/disk/publish.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "ensemble/statistics/finite_text.hpp"
#include "results/disk/error.hpp"
#include "results/disk/names.hpp"
#include "results/disk/system_calls.hpp"
#include "results/disk/temporary_file.hpp"

namespace jostle::inline results {
namespace {

/// True if the file system below a path has run out of files, not of bytes.
bool has_no_more_files(const std::string& path) {
  struct statvfs disk;
  return ::statvfs(folder_of(path).c_str(), &disk) == 0 && disk.f_files > 0 && disk.f_favail == 0;
}

/// Advice after a failed call.
std::string way_out(const std::string& path, std::string_view operation, int error) {
  if (operation == "open" || operation == "read") return "";
  switch (error) {
    case ENOSPC:
      return has_no_more_files(path) ? "; its file system holds as many files as it can: remove "
                                       "some, or write elsewhere"
                                     : "; free some space, or write elsewhere";
    case EDQUOT:
      return "; your quota there is used up: remove files of yours, or write elsewhere";
    case ENAMETOOLONG:
      return fmt::format("; names in its folder have up to {} bytes: choose a shorter one",
                         longest_name_beside(path));
    case EIO:
      return "; the disk or its server failed: write elsewhere";
    case EFBIG:
      return "; raise the limit on file sizes (ulimit -f)";
    case ENOMEM:
      return "; raise the limit on memory";
    case ELOOP:
      return "; it is a symbolic link, or one of a ring: remove it";
    case EROFS:
      return "; write to another disk";
    case EACCES:
    case EPERM:
      return "; make the folder writable, or write to a file in another one";
    case ENOENT:
      return "; is its folder there still?";
    default:
      return "";
  }
}

/// Why a file may not be written to (`error`), and what helps.
std::string protection_of(const struct stat& status, int error) {
  if (error == EROFS) return "is on a read-only file system, and kept; write to another disk";
  if (error == EPERM)
    return "is marked as unchangeable (chattr), and kept; write elsewhere, or take the mark away";
  if (error != EACCES)
    return fmt::format("cannot be written to ({}), and is kept; write elsewhere",
                       std::strerror(error));
  const auto mode = status.st_mode & 0777u;
  const auto user = ::geteuid();
  if (user != 0 && status.st_uid != user)
    return fmt::format(
        "belongs to user {}, who has write-protected it (mode {:03o}), and is kept; "
        "write elsewhere",
        status.st_uid, mode);
  return fmt::format(
      "is write-protected (mode {:03o}), and kept; write elsewhere, or allow it "
      "with chmod u+w",
      mode);
}

}  // namespace

void fail_on_disk(const std::string& path, const char* operation, int error) {
  throw ResultsError(path, fmt::format("cannot {}: {}{}", operation, std::strerror(error),
                                       way_out(path, operation, error)));
}

void write_all(const std::string& path, int descriptor, std::span<const std::byte> bytes) {
  constexpr std::size_t piece = 4u << 20;
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), std::min(bytes.size(), piece));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail_on_disk(path, "write", written < 0 ? errno : ENOSPC);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void refuse_existing(const std::string& path) {
  throw ResultsError(path, "exists already; choose another name, or replace it",
                     ResultsError::Force::helps);
}

void publish(const std::string& path, std::span<const std::byte> bytes, ExistingFile existing) {
  TemporaryFile file(path, existing);
  file.write(bytes);
  file.publish();
}

std::string end_of_links(const std::string& path) {
  constexpr int most_links = 40;  // the limit of Linux
  std::filesystem::path end(path);
  for (int links = 0; links < most_links; ++links) {
    struct stat status;
    if (::lstat(end.c_str(), &status) != 0 || !S_ISLNK(status.st_mode)) return end;
    std::error_code error;
    end = end.parent_path() / std::filesystem::read_symlink(end, error);
    if (error) fail_on_disk(path, "follow", error.value());
  }
  fail_on_disk(path, "follow", ELOOP);
}

void require_replaceable_file(const std::string& path) {
  require_name_fits(path);
  struct stat status;
  if (::stat(path.c_str(), &status) != 0) return;
  if (!S_ISREG(status.st_mode))
    throw ResultsError(path, "is a folder, a pipe or a device, and not replaced by a file");
  constexpr mode_t anybody = S_IWUSR | S_IWGRP | S_IWOTH;  // root may write to all: ask the mode
  const bool writable = ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) == 0;
  if (writable && (status.st_mode & anybody) != 0) return;
  throw ResultsError(path, protection_of(status, writable ? EACCES : errno));
}

std::string folder_of(const std::string& path) {
  const auto slash = path.find_last_of('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

void remove_file(const std::string& path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) fail_on_disk(path, "remove", errno);
}

void sync_folder_of(const std::string& path) {
  const std::string folder = folder_of(path);
  const Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!descriptor) fail_on_disk(folder, "open", errno);
  // Some network file systems cannot fsync a folder and return EINVAL, which is ignored.
  if (::fsync(descriptor.get()) != 0 && errno != EINVAL) fail_on_disk(folder, "fsync", errno);
}

void require_free_space(const std::string& path, std::uint64_t bytes, const char* advice) {
  const std::string folder = folder_of(path);
  struct statvfs disk;
  if (::statvfs(folder.c_str(), &disk) != 0) fail_on_disk(folder, "ask for free space", errno);
  const std::uint64_t free_bytes = std::uint64_t{disk.f_bavail} * disk.f_frsize;
  if (free_bytes >= bytes) return;
  throw ResultsError(
      path,
      finite_text("{:.1f} MB of disk may be needed, but only {:.1f} MB are free; {}",
                  static_cast<double>(bytes) / 1e6, static_cast<double>(free_bytes) / 1e6, advice));
}

}  // namespace jostle::inline results
