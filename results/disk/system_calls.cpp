#include "results/disk/system_calls.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <string>

namespace jostle::inline results {

bool open_pipe(std::array<int, 2>& ends) {
#if defined(__linux__) && !defined(JOSTLE_PORTABLE)
  return ::pipe2(ends.data(), O_CLOEXEC) == 0;
#else
  if (::pipe(ends.data()) != 0) return false;
  for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  return true;
#endif
}

ChangeTime change_time(const struct stat& status) {
#if defined(__APPLE__)
  return {status.st_mtimespec.tv_sec, status.st_mtimespec.tv_nsec};
#elif defined(JOSTLE_PORTABLE)
  return {status.st_mtime, 0};
#else
  return {status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
#endif
}

std::uint64_t start_time_of(long pid) {
#if defined(__linux__) && !defined(JOSTLE_PORTABLE)
  std::ifstream file(fmt::format("/proc/{}/stat", pid));
  std::string line;
  if (!std::getline(file, line)) return 0;
  // The second field, the program's name, may hold blanks and brackets: count from its last
  // bracket.
  std::istringstream rest(line.substr(line.rfind(')') + 1));
  std::string word;
  rest >> word;
  if (word == "Z" || word == "X") return 0;  // a zombie, as in a container without init
  for (int field = 4; field <= 22; ++field) rest >> word;
  return rest ? std::stoull(word) : 0;
#else
  siginfo_t ended{};
  const bool is_ended_child =
      ::waitid(P_PID, static_cast<id_t>(pid), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
      ended.si_pid == pid;
  if (is_ended_child) return 0;
  return ::kill(static_cast<pid_t>(pid), 0) == 0 || errno == EPERM ? 1 : 0;
#endif
}

}  // namespace jostle::inline results
