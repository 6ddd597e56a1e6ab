#include "results/disk/output_path.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <list>

#include "results/disk/error.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/system_calls.hpp"

namespace jostle::inline results {
namespace {

namespace fs = std::filesystem;

enum class Place { on_the_way, at_the_end };

bool others_may_write(const struct stat& folder, Writers writers) {
  const mode_t group = writers == Writers::everybody ? 0 : S_IWGRP;
  return (folder.st_mode & (group | S_IWOTH)) != 0;
}

/// `entry`: what is in `folder`.
bool is_trusted(const struct stat& entry, const struct stat& folder, Place place) {
  if (entry.st_uid == ::geteuid() || !others_may_write(folder, Writers::a_group_or_everybody))
    return true;
  if (place == Place::at_the_end || others_may_write(folder, Writers::everybody)) return false;
  return entry.st_uid == 0 || entry.st_uid == folder.st_uid;
}

[[noreturn]] void refuse(const fs::path& path, const struct stat& entry) {
  throw ResultsError(
      path, fmt::format("is a {} that another user (number {}) may have put there, as others may "
                        "write to its folder; it is not followed. {}",
                        S_ISLNK(entry.st_mode) ? "link" : "pipe or device", entry.st_uid,
                        S_ISLNK(entry.st_mode) ? "Name the file that it leads to"
                                               : "Write to another name or folder"));
}

/// The names of a path between its slashes, in front of those that `rest` has.
void put_in_front(std::list<std::string>& rest, const fs::path& path) {
  std::list<std::string> names;
  for (const fs::path& name : path.relative_path())
    if (!name.empty() && name != ".") names.push_back(name);
  rest.splice(rest.begin(), names);
}

/// Goes along a path as the kernel does, from folder to folder, and looks at every link.
void require_trusted_way(const std::string& path) {
  constexpr int most_links = 40;  // the limit of Linux
  fs::path current = fs::path(path).root_path();
  std::list<std::string> rest;
  put_in_front(rest, path);
  for (int links = 0; !rest.empty();) {
    const fs::path next = current / rest.front();
    rest.pop_front();
    struct stat entry, folder;
    if (::lstat(next.c_str(), &entry) != 0) return;  // nothing there that could lead elsewhere
    if (S_ISDIR(entry.st_mode) || (S_ISREG(entry.st_mode) && rest.empty())) {
      current = next;
      continue;
    }
    if (::stat(current.empty() ? "." : current.c_str(), &folder) != 0) return;
    const Place place = rest.empty() ? Place::at_the_end : Place::on_the_way;
    if (!is_trusted(entry, folder, place)) refuse(next, entry);
    if (!S_ISLNK(entry.st_mode)) return;
    if (++links > most_links) fail_on_disk(path, "follow", ELOOP);
    std::error_code error;
    const fs::path target = fs::read_symlink(next, error);
    if (error) fail_on_disk(path, "follow", error.value());
    if (target.is_absolute()) current = target.root_path();
    put_in_front(rest, target);
  }
}

}  // namespace

std::string output_path(const std::string& path) {
  require_trusted_way(path);
  return end_of_links(path);
}

bool may_be_planted(const std::string& path, Writers writers) {
  struct stat entry, folder;
  if (::lstat(path.c_str(), &entry) != 0 || ::stat(folder_of(path).c_str(), &folder) != 0)
    return false;
  return entry.st_uid != ::geteuid() && others_may_write(folder, writers);
}

void make_folder(const std::string& path) {
  require_trusted_way((fs::path(path) / "any").string());
  struct stat status;
  if (::mkdir(path.c_str(), 0777) == 0 ||
      (errno == EEXIST && ::stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode)))
    return;
  fail_on_disk(path, "create the folder", errno);
}

void write_new_file(const std::string& path, std::span<const std::byte> bytes) {
  const Descriptor file(
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (!file) fail_on_disk(path, "create", errno);
  write_all(path, file.get(), bytes);
}

}  // namespace jostle::inline results
