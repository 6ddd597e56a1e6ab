#include "results/publish.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "results/descriptor.hpp"
#include "results/error.hpp"
#include "results/read_bytes.hpp"

namespace jostle {
namespace {

void write_all(const std::string& path, int descriptor, std::span<const std::byte> bytes) {
  constexpr std::size_t piece = 4u << 20;
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), std::min(bytes.size(), piece));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_on_disk(path, "write", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

std::string folder_of(const std::string& path) {
  const auto slash = path.find_last_of('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

const char* way_out(std::string_view what, int error) {
  if (what == "open" || what == "read") return "";
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "; free some space, then resume: nothing up to the last checkpoint is lost";
    case EFBIG:
      return "; raise the limit on file sizes (ulimit -f), then resume: nothing up to the last "
             "checkpoint is lost";
    case ENOMEM:
      return "; raise the limit on memory, then resume: nothing up to the last checkpoint is lost";
    case EROFS:
    case EACCES:
    case EPERM:
      return "; make the folder writable, or write to a file in another one";
    case ENOENT:
      return "; is its folder there still?";
    default:
      return "";
  }
}

void write_temporary(const std::string& path, std::span<const std::byte> bytes) {
  const std::string temporary = temporary_name(path);
  const Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (!file) fail_on_disk(temporary, "create", errno);
  write_all(temporary, file.get(), bytes);
}

}  // namespace

void fail_on_disk(const std::string& path, const char* what, int error) {
  throw ResultsError(
      path, fmt::format("cannot {}: {}{}", what, std::strerror(error), way_out(what, error)));
}

std::string temporary_name(const std::string& path) {
  return path + ".tmp";
}

void publish(const std::string& path, std::span<const std::byte> bytes) {
  try {
    write_temporary(path, bytes);
  } catch (...) {
    ::unlink(temporary_name(path).c_str());
    throw;
  }
  publish_temporary(path);
}

void publish_temporary(const std::string& path) {
  const std::string temporary = temporary_name(path);
  const auto give_up = [&](const char* what, int error) {
    ::unlink(temporary.c_str());
    fail_on_disk(temporary, what, error);
  };
  {
    const Descriptor file(::open(temporary.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file) give_up("open", errno);
    if (::fsync(file.get()) != 0) give_up("fsync", errno);
  }
  if (::rename(temporary.c_str(), path.c_str()) != 0) give_up("rename", errno);
  sync_folder_of(path);
}

std::vector<std::byte> read_bytes(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file) fail_on_disk(path, "open", errno);
  struct stat status;
  if (::fstat(file.get(), &status) != 0) fail_on_disk(path, "read", errno);
  std::vector<std::byte> bytes(static_cast<std::size_t>(status.st_size));
  std::size_t n = 0;
  while (n < bytes.size()) {
    const ssize_t got = ::read(file.get(), bytes.data() + n, bytes.size() - n);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail_on_disk(path, "read", errno);
    if (got == 0) break;
    n += static_cast<std::size_t>(got);
  }
  bytes.resize(n);
  return bytes;
}

void remove_file(const std::string& path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) fail_on_disk(path, "remove", errno);
}

void sync_folder_of(const std::string& path) {
  const std::string folder = folder_of(path);
  const Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!descriptor) fail_on_disk(folder, "open", errno);
  // Some network file systems cannot fsync a folder and say EINVAL: there is nothing to be done.
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
      fmt::format("{:.1f} MB of disk may be needed, but only {:.1f} MB are free; {}",
                  static_cast<double>(bytes) / 1e6, static_cast<double>(free_bytes) / 1e6, advice));
}

}  // namespace jostle
