#include "results/locks/lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <sstream>
#include <thread>

#include "ensemble/statistics/finite_text.hpp"
#include "results/disk/checksum.hpp"
#include "results/disk/error.hpp"
#include "results/disk/names.hpp"
#include "results/disk/output_path.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/system_calls.hpp"

namespace jostle::inline results {
namespace {

constexpr std::size_t most_bytes = 512;  // content of a lock
constexpr std::string_view storing_word = "storing";

std::string lock_path(const std::string& results_path) {
  return path_with_ending(results_path, ".lock");
}

std::string this_host() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

/// "host pid start_time", for a Slurm job then "slurm cluster id restarts name", and "storing"
/// where it is held briefly, in one line. It does not contain whether the process is alive.
std::optional<LockOwner> parse_owner(const std::string& text) {
  const std::size_t end = text.find('\n');
  if (end != std::string::npos && end + 1 < text.size()) return std::nullopt;
  std::istringstream words(text);
  LockOwner owner;
  if (!(words >> owner.host >> owner.pid >> owner.start_time)) return std::nullopt;
  std::string kind;
  SlurmJob job;
  words >> kind;
  if (kind == "slurm" && words >> job.cluster >> job.id >> job.restarts >> job.name) {
    owner.job = job;
    words >> kind;
  }
  owner.storing = kind == storing_word;
  return owner;
}

std::string text_of_this_process(LockUse use) {
  std::string text = fmt::format("{} {} {}", this_host(), ::getpid(), start_time_of(::getpid()));
  if (const auto job = this_slurm_job())
    text += fmt::format(" slurm {} {} {} {}", job->cluster, job->id, job->restarts, job->name);
  if (use == LockUse::storing) text.append(" ").append(storing_word);
  return text + "\n";
}

/// `lock`: the user whose lock it is. Slurm may not report another user's jobs.
bool is_alive(const LockOwner& owner, uid_t lock, SlurmQueue& queue) {
  if (owner.host == this_host()) {
    const std::uint64_t start_time = start_time_of(owner.pid);
    return start_time != 0 && start_time == owner.start_time;
  }
  if (!owner.job || lock != ::getuid()) return true;
  const auto own = this_slurm_job();
  const bool is_same = own && own->cluster == owner.job->cluster && own->id == owner.job->id;
  // Slurm starts a job again when its last start is over.
  if (is_same) return own->restarts <= owner.job->restarts;
  return queue.runs(*owner.job).value_or(true);
}

std::string owner_name(const LockOwner& owner) {
  const std::string process = fmt::format("process {} on host {}", owner.pid, owner.host);
  return owner.job ? fmt::format("{} (Slurm job {})", process, owner.job->name) : process;
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

/// A living process has the lock. Thrown within this file: it becomes a LockHeld where nobody
/// waits.
struct Held {
  std::string process;
  bool storing = false, on_other_host = false;

  LockHeld error(const std::string& path, Patience::Duration waited) const {
    const std::string still =
        waited.count() > 0 ? finite_text(", still after {:.3g} s", waited.count()) : "";
    if (on_other_host)
      return {path,
              fmt::format("{} may still be working on this file{}; if it is not, resume its run, "
                          "which takes the file over",
                          process, still),
              ResultsError::Force::helps};
    return {path, fmt::format("{} is {} this file{}; wait for it, or stop it", process,
                              storing ? "storing tables in" : "working on", still)};
  }
};

void refuse_living_owner(const LockOwner& owner, bool force) {
  if (!owner.alive) return;
  const bool on_other_host = owner.host != this_host();
  if (on_other_host ? force : owner.pid == ::getpid()) return;
  const std::string process =
      on_other_host ? owner_name(owner) : fmt::format("process {} on this host", owner.pid);
  throw Held{process, owner.storing, on_other_host};
}

/// The time that a process waits for others.
class Wait {
 public:
  Wait(const std::string& path, const Patience& patience) : path_(path), patience_(patience) {}

  /// Sleeps for a moment, or throws LockHeld where there is no patience left.
  void go_on(const Held& held) {
    using namespace std::chrono_literals;
    const Patience::Duration waited = Clock::now() - began_,
                             limit = held.storing ? patience_.for_storing : patience_.for_runs;
    if (waited >= limit) throw held.error(path_, limit);
    if (!held.storing && !told_ && patience_.tell) {
      patience_.tell(finite_text("{}: {} is working on this file; waiting up to {:.3g} s", path_,
                                 held.process, limit.count()));
      told_ = true;
    }
    // Slurm is asked about other hosts; processes of one host do not look all at once.
    const Patience::Duration pause = held.on_other_host
                                         ? Patience::Duration(2s)
                                         : Patience::Duration(10ms + ::getpid() % 11 * 1ms);
    std::this_thread::sleep_for(std::min(pause, limit - waited));
  }

 private:
  using Clock = std::chrono::steady_clock;

  const std::string& path_;
  const Patience& patience_;
  Clock::time_point began_ = Clock::now();
  bool told_ = false;
};

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

/// The system's words; errno 524, which servers send on, has none there.
std::string reason_of(int error) {
  constexpr int not_supported_by_server = 524;  // ENOTSUPP of the kernel
  return std::strerror(error == not_supported_by_server ? ENOTSUP : error);
}

/// Content of a lock. It is written in place: other files must not be overwritten.
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

uid_t user_of(const std::string& path, int descriptor) {
  struct stat status;
  if (::fstat(descriptor, &status) != 0) fail_on_disk(path, "read", errno);
  return status.st_uid;
}

/// Refuses a lock that a living process holds.
void refuse_if_held(const std::string& path, const Descriptor& file, bool force) {
  auto owner = parse_owner(read_lock(path, file.get()));
  if (!owner) return;
  SlurmQueue queue;
  owner->alive = is_alive(*owner, user_of(path, file.get()), queue);
  refuse_living_owner(*owner, force);
}

/// A lock file, and what this process knows of it.
struct OpenedLock {
  Descriptor file;
  bool created = false;  // by this process: nobody else has it
  int flock_error = 0;   // why flock does not work here
};

/// Empty if it was deleted concurrently.
OpenedLock try_open(const std::string& path) {
  OpenedLock lock{open_lock(path, O_RDWR)};
  if (!lock.file && errno == ENOENT) {
    lock.file = open_lock(path, O_RDWR | O_CREAT | O_EXCL);
    if (!lock.file && errno == EEXIST) return {};
    lock.created = true;
  }
  if (!lock.file && (errno == EISDIR || errno == ENXIO || errno == ELOOP)) refuse_foreign(path);
  if (!lock.file) fail_on_disk(path, "create", errno);
  int result = 0;
  do {
    result = ::flock(lock.file.get(), LOCK_EX | LOCK_NB);
  } while (result != 0 && errno == EINTR);
  if (result != 0 && errno == EWOULDBLOCK) {
    const auto owner = parse_owner(read_lock(path, lock.file.get()));
    if (!owner) throw Held{"a process", true};
    const bool on_this_host = owner->host == this_host();
    // Who has only just taken it from a dead process has not written its name yet.
    const bool is_new = on_this_host && start_time_of(owner->pid) != owner->start_time;
    throw Held{owner_name(*owner), owner->storing || is_new};
  }
  if (result != 0) lock.flock_error = errno;
  return is_still_at(path, lock.file.get()) ? std::move(lock) : OpenedLock{};
}

/// Where flock does not work, a lock that is there is another's: empty while that one writes it,
/// which takes no second.
void await_text(const std::string& path, const Descriptor& file) {
  constexpr int most_looks = 20;
  for (int looks = 0; looks < most_looks; ++looks) {
    if (!is_half_written(read_lock(path, file.get()))) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

/// Takes a dead process's lock away, `seen` in it, so that this one can make its own. Between the
/// look and the move another may have done the same: its lock is put back.
void take_away(const std::string& path, const std::string& seen) {
  const std::string renamed = path_with_ending(path, "." + random_identity().substr(0, 8));
  if (::rename(path.c_str(), renamed.c_str()) != 0) {
    if (errno == ENOENT) return;
    fail_on_disk(path, "rename", errno);
  }
  const Descriptor file = open_lock(renamed, O_RDONLY);
  if (file && read_all(renamed, file.get()) != seen && ::link(renamed.c_str(), path.c_str()) != 0 &&
      errno != EEXIST)
    fail_on_disk(path, "link", errno);
  ::unlink(renamed.c_str());
}

}  // namespace

RunLock::RunLock(const std::string& results_path, bool force, LockUse use, const Patience& patience)
    : path_(lock_path(output_path(results_path))) {
  for (Wait wait(path_, patience);;) {
    try {
      acquire(force, use);
      return;
    } catch (const Held& held) {
      wait.go_on(held);
    }
  }
}

void RunLock::acquire(bool force, LockUse use) {
  OpenedLock lock;
  for (;;) {
    lock = try_open(path_);
    if (!lock.file) continue;
    const bool without_flock = lock.flock_error != 0 && !lock.created;
    if (without_flock) await_text(path_, lock.file);
    refuse_if_held(path_, lock.file, force);
    if (!without_flock) break;
    take_away(path_, read_all(path_, lock.file.get()));
  }
  file_ = std::move(lock.file);
  flock_error_ = lock.flock_error;
  const std::string text = text_of_this_process(use);
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

std::string RunLock::warning() const {
  if (flock_error_ == 0) return "";
  return fmt::format(
      "{}: this file system has no flock ({}); the file itself keeps other processes out", path_,
      reason_of(flock_error_));
}

std::optional<LockOwner> lock_owner(const std::string& results_path, SlurmQueue& queue) {
  const std::string path = lock_path(results_path);
  const Descriptor file = open_lock(path, O_RDONLY);
  struct stat status;
  if (!file || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  auto owner = parse_owner(read_all(path, file.get()));
  if (owner) owner->alive = is_alive(*owner, status.st_uid, queue);
  return owner;
}

std::optional<LockOwner> lock_owner(const std::string& results_path) {
  SlurmQueue queue;
  return lock_owner(results_path, queue);
}

}  // namespace jostle::inline results
