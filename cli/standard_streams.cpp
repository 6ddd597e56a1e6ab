#include "cli/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <initializer_list>

namespace jostle {

void guard_files() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // open() takes the lowest number that is free: this one.
    if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDONLY) < 0) return;
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

void outlive_readers() {
  std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace jostle
