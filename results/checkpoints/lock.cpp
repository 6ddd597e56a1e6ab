#include "results/checkpoints/lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <sstream>

#include "results/checkpoints/publish.hpp"
#include "results/error.hpp"

namespace jostle::inline results {
namespace {

constexpr std::size_t most_bytes = 512;  // that a lock holds

std::string lock_path(const std::string& results_path) {
  return results_path + ".lock";
}

std::string this_host() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

/// Field 22 of /proc/PID/stat, clock ticks since boot; 0 where there is no such process, or one
/// that has ended and that nobody reaps (state Z or X), as in a container. The second field, the
/// program's name, may hold blanks and brackets: count from its last bracket.
std::uint64_t start_time_of(long pid) {
  std::ifstream file(fmt::format("/proc/{}/stat", pid));
  std::string line;
  if (!std::getline(file, line)) return 0;
  std::istringstream rest(line.substr(line.rfind(')') + 1));
  std::string word;
  rest >> word;
  if (word == "Z" || word == "X") return 0;
  for (int field = 4; field <= 22; ++field) rest >> word;
  return rest ? std::stoull(word) : 0;
}

std::optional<LockOwner> parse_owner(const std::string& text) {
  std::istringstream words(text);
  LockOwner owner;
  if (!(words >> owner.host >> owner.pid >> owner.start_time)) return std::nullopt;
  const std::uint64_t start_time = start_time_of(owner.pid);
  owner.alive = owner.host != this_host() || (start_time != 0 && start_time == owner.start_time);
  return owner;
}

std::string read_all(const std::string& path, int descriptor) {
  std::array<char, most_bytes + 1> text{};
  for (;;) {
    const ssize_t n = ::pread(descriptor, text.data(), text.size(), 0);
    if (n >= 0) return {text.data(), static_cast<std::size_t>(n)};
    if (errno != EINTR) fail_on_disk(path, "read", errno);
  }
}

bool is_still_at(const std::string& path, int descriptor) {
  struct stat held, named;
  return ::fstat(descriptor, &held) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         held.st_ino == named.st_ino && held.st_dev == named.st_dev;
}

void refuse_living_owner(const std::string& path, const LockOwner& owner, bool force) {
  if (owner.host != this_host()) {
    if (force) return;
    throw ResultsError(path,
                       fmt::format("process {} on host {} may still be working on this file; if it "
                                   "is not, take the file over",
                                   owner.pid, owner.host),
                       ResultsError::Force::helps);
  }
  if (owner.alive && owner.pid != ::getpid())
    throw ResultsError(path, fmt::format("process {} on this host is working on this file; wait "
                                         "for it, or stop it",
                                         owner.pid));
}

/// Empty, or cut short, as a process of this host leaves it that was killed while it wrote.
bool is_half_written(const std::string& text) {
  const std::string host = this_host() + " ";
  return text.size() <= host.size() ? host.starts_with(text)
                                    : text.starts_with(host) && text.back() != '\n';
}

[[noreturn]] void refuse_foreign(const std::string& path) {
  throw ResultsError(path,
                     "is no lock of jostle, which needs this name: move it away, or name the "
                     "results file otherwise");
}

/// What a lock holds. It is written in place: what is no lock of ours must not be written over.
std::string read_lock(const std::string& path, int descriptor) {
  struct stat status;
  if (::fstat(descriptor, &status) != 0) fail_on_disk(path, "read", errno);
  if (S_ISREG(status.st_mode) && status.st_nlink <= 1) {
    std::string text = read_all(path, descriptor);
    if (text.size() <= most_bytes && (parse_owner(text) || is_half_written(text))) return text;
  }
  refuse_foreign(path);
}

Descriptor open_lock(const std::string& path, int flags) {
  return Descriptor(
      ::open(path.c_str(), flags | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC, 0666));
}

/// The lock file, opened and flocked; none if it was taken away meanwhile.
Descriptor try_open(const std::string& path) {
  Descriptor file = open_lock(path, O_RDWR | O_CREAT);
  if (!file && (errno == EISDIR || errno == ENXIO || errno == ELOOP)) refuse_foreign(path);
  if (!file) fail_on_disk(path, "create", errno);
  if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    const auto owner = parse_owner(read_lock(path, file.get()));
    throw ResultsError(path,
                       fmt::format("process {} is working on this file; wait for it, or "
                                   "stop it",
                                   owner ? fmt::format("{} on host {}", owner->pid, owner->host)
                                         : std::string("unknown")));
  }
  if (!is_still_at(path, file.get())) return {};
  return file;
}

}  // namespace

RunLock::RunLock(const std::string& results_path, bool force) : path_(lock_path(results_path)) {
  while (!file_) file_ = try_open(path_);
  if (const auto owner = parse_owner(read_lock(path_, file_.get())))
    refuse_living_owner(path_, *owner, force);
  const std::string text =
      fmt::format("{} {} {}\n", this_host(), ::getpid(), start_time_of(::getpid()));
  if (::ftruncate(file_.get(), 0) != 0 ||
      ::pwrite(file_.get(), text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) {
    const int error = errno;
    ::unlink(path_.c_str());
    fail_on_disk(path_, "write", error);
  }
}

RunLock::~RunLock() {
  if (is_still_at(path_, file_.get())) ::unlink(path_.c_str());
}

std::optional<LockOwner> lock_owner(const std::string& results_path) {
  const std::string path = lock_path(results_path);
  const Descriptor file = open_lock(path, O_RDONLY);
  struct stat status;
  if (!file || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return parse_owner(read_all(path, file.get()));
}

}  // namespace jostle::inline results
