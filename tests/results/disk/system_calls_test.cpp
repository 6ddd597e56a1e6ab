#include "results/disk/system_calls.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/results/temporary_folder.hpp"

using namespace jostle;

TEST_CASE("a process has a start time while it lives, and none once it has ended") {
  const std::uint64_t own = start_time_of(::getpid());
  CHECK(own != 0);
  CHECK(start_time_of(::getpid()) == own);
  const pid_t child = ::fork();
  if (child == 0) {
    for (;;) ::pause();
  }
  CHECK(start_time_of(child) != 0);
  ::kill(child, SIGKILL);
  siginfo_t ended;
  REQUIRE(::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT) == 0);
  CHECK(start_time_of(child) == 0);  // a zombie
  ::waitpid(child, nullptr, 0);
  CHECK(start_time_of(child) == 0);
}

TEST_CASE("a pipe carries bytes and is not inherited by programs") {
  std::array<int, 2> ends{};
  REQUIRE(open_pipe(ends));
  const Descriptor read_end(ends[0]), write_end(ends[1]);
  for (const int end : ends) CHECK((::fcntl(end, F_GETFD) & FD_CLOEXEC) != 0);
  char byte = 0;
  CHECK(::write(write_end.get(), "a", 1) == 1);
  CHECK(::read(read_end.get(), &byte, 1) == 1);
  CHECK(byte == 'a');
}

TEST_CASE("a file's change time is the one it was given") {
  const TemporaryFolder folder;
  const std::string path = folder / "file";
  std::ofstream(path) << "text";
  const timespec times[2] = {{1, 0}, {1'234'567'890, 123'000'000}};
  REQUIRE(::utimensat(AT_FDCWD, path.c_str(), times, 0) == 0);
  struct stat status;
  REQUIRE(::stat(path.c_str(), &status) == 0);
  CHECK(change_time(status).seconds == 1'234'567'890);
#ifdef JOSTLE_PORTABLE
  CHECK(change_time(status).nanoseconds == 0);
#else
  CHECK(change_time(status).nanoseconds == 123'000'000);
#endif
}
