#include "results/locks/lock.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "results/disk/error.hpp"
#include "results/disk/system_calls.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;
using Catch::Matchers::Contains;

namespace {

std::string this_host() {
  char name[256] = {};
  ::gethostname(name, sizeof name - 1);
  return name;
}

void write_lock(const std::string& path, const std::string& host, long pid, std::uint64_t start) {
  std::ofstream(path + ".lock") << host << ' ' << pid << ' ' << start << '\n';
}

}  // namespace

TEST_CASE("a lock names its owner and goes with it") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  {
    const RunLock lock(path, false);
    const auto owner = lock_owner(path);
    REQUIRE(owner);
    CHECK(owner->host == this_host());
    CHECK(owner->pid == ::getpid());
    CHECK(owner->alive);
    CHECK_THROWS_WITH(RunLock(path, false),
                      Contains(fmt::format("process {} on host {}", ::getpid(), this_host())));
    CHECK_THROWS_AS(RunLock(path, true), ResultsError);  // a living owner yields to nobody
  }
  CHECK_FALSE(lock_owner(path));
  CHECK(std::filesystem::is_empty(folder.path()));
  CHECK_NOTHROW(RunLock(path, false));
}

TEST_CASE("the lock of a living process that flock does not show is respected") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const pid_t child = ::fork();
  if (child == 0) {
    for (;;) ::pause();
  }
  const std::uint64_t start = start_time_of(child);
#if defined(__linux__) && !defined(JOSTLE_PORTABLE)
  {
    std::ifstream file(fmt::format("/proc/{}/stat", child));
    std::string word;
    for (int field = 1; field <= 22; ++field)
      file >> word;  // the name of this program has no blank
    CHECK(start == std::stoull(word));
  }
#endif
  CHECK(start != 0);
  write_lock(path, this_host(), child, start);
  CHECK(lock_owner(path)->alive);
  CHECK_THROWS_WITH(RunLock(path, false), Contains(fmt::format("process {}", child)));
  write_lock(path, this_host(), child, start + 1);  // another process once had this number
  CHECK_FALSE(lock_owner(path)->alive);
  CHECK_NOTHROW(RunLock(path, false));
  write_lock(path, this_host(), child, start);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  CHECK_FALSE(lock_owner(path)->alive);
  CHECK_NOTHROW(RunLock(path, false));
}

TEST_CASE("a killed owner leaves a lock that the next process takes over, reaped or a zombie") {
  const bool reaped = GENERATE(true, false);
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const pid_t child = ::fork();
  if (child == 0) {
    const RunLock lock(path, false);
    ::kill(::getpid(), SIGKILL);
  }
  siginfo_t ended;
  REQUIRE(::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | (reaped ? 0 : WNOWAIT)) == 0);
  REQUIRE(lock_owner(path));
  CHECK(lock_owner(path)->pid == child);
  CHECK_FALSE(lock_owner(path)->alive);
  {
    const RunLock lock(path, false);
    CHECK(lock_owner(path)->pid == ::getpid());
  }
  if (!reaped) ::waitpid(child, nullptr, 0);
}

TEST_CASE("the lock of another host is taken over by force only") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  write_lock(path, "elsewhere", 1234, 5);
  CHECK(lock_owner(path)->alive);
  CHECK_THROWS_WITH(RunLock(path, false),
                    Contains("process 1234 on host elsewhere") && Contains("takes the file over"));
  const RunLock lock(path, true);
  CHECK(lock_owner(path)->host == this_host());
}

TEST_CASE("a file that somebody put in the place of the lock stays there") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  {
    const RunLock lock(path, false);
    std::filesystem::remove(path + ".lock");
    std::ofstream(path + ".lock") << "notes";
  }
  CHECK(std::filesystem::file_size(path + ".lock") == 5);
}

TEST_CASE("an empty lock file, left between its creation and its writing, is taken over") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  std::ofstream(path + ".lock").close();
  CHECK_FALSE(lock_owner(path));
  CHECK_NOTHROW(RunLock(path, false));
}
