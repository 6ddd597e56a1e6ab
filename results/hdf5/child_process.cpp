#include "results/hdf5/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <new>
#include <span>

#include "results/disk/error.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/system_calls.hpp"
#include "results/hdf5/handle.hpp"

namespace jostle::inline results {
namespace {

/// How the work ended: the first byte that the child sends.
enum Ending : char { with_text = 't', hdf5_error = 'h', results_error = 'r', out_of_memory = 'm' };

/// `path` and `reason`, separated by a zero, which neither holds.
std::string packed(const ResultsError& error) {
  return error.path() + '\0' + std::string(error.what()).substr(error.path().size() + 2);
}

std::string outcome_of(const std::function<std::string()>& work) {
  try {
    return char{with_text} + work();
  } catch (const ResultsError& error) {
    return char{results_error} + packed(error);
  } catch (const std::bad_alloc&) {
    return {char{out_of_memory}};
  } catch (const std::exception& error) {
    return char{hdf5_error} + std::string(error.what());
  }
}

/// A damaged length of a text would make HDF5 take and clear gigabytes: what is read piece by piece
/// needs less.
void limit_memory() {
  constexpr rlim_t enough = rlim_t{3} << 29;  // 1.5 GB
  std::uint64_t pages = 0;  // pages of this process; unknown where there is no /proc
  if (!(std::ifstream("/proc/self/statm") >> pages)) return;
  struct rlimit limit;
  if (::getrlimit(RLIMIT_AS, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_cur,
                                    pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + enough);
  ::setrlimit(RLIMIT_AS, &limit);
}

/// A crash is expected here: it leaves no core, and the heap's last words are for nobody.
[[noreturn]] void run_as_child(const std::function<std::string()>& work, int pipe) {
  const struct rlimit none {};
  ::setrlimit(RLIMIT_CORE, &none);
  limit_memory();
#ifndef __SANITIZE_ADDRESS__
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
#endif
  const std::string outcome = outcome_of(work);
  try {
    write_all("", pipe, std::as_bytes(std::span(outcome)));
  } catch (const std::exception&) {
    ::_exit(1);
  }
  ::_exit(0);
}

std::string read_to_end(int pipe) {
  std::string text;
  std::array<char, 4096> piece;
  for (;;) {
    const ssize_t n = ::read(pipe, piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(n));
  }
}

std::string text_of(const std::string& outcome) {
  const std::string text = outcome.substr(1);
  switch (outcome.front()) {
    case with_text:
      return text;
    case out_of_memory:
      throw std::bad_alloc();
    case results_error: {
      const auto end = text.find('\0');
      throw ResultsError(text.substr(0, end), text.substr(end + 1));
    }
    default:
      throw Hdf5Error(text);
  }
}

}  // namespace

std::string in_child_process(const std::function<std::string()>& work) {
  std::array<int, 2> ends;
  if (!open_pipe(ends)) return work();
  const Descriptor from_child(ends[0]);
  Descriptor to_parent(ends[1]);
  const pid_t child = ::fork();
  if (child < 0) return work();
  if (child == 0) run_as_child(work, to_parent.get());
  to_parent = Descriptor();
  const std::string outcome = read_to_end(from_child.get());
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (outcome.empty() || status != 0) {
    const std::string cause =
        WIFSIGNALED(status) ? fmt::format(", signal {}", WTERMSIG(status)) : "";
    throw Hdf5Error(
        fmt::format("is damaged or forged: HDF5 crashes when it reads the file{}; restore it from "
                    "a copy",
                    cause));
  }
  return text_of(outcome);
}

}  // namespace jostle::inline results
