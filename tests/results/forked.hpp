#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <string>

/// End of a process.
struct Ending {
  int signal = 0;  // the signal that killed it, 0 if none
  int code = 0;    // its exit code
};

/// Runs `work` in a process of its own, with the given settings in its environment. A thrown
/// exception ends it with code 1 and its message in the file `messages`.
template <class Work>
Ending run_forked(const std::map<std::string, std::string>& environment,
                  const std::string& messages, Work&& work) {
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
    try {
      work();
      std::exit(0);
    } catch (const std::exception& error) {
      if (std::FILE* file = std::fopen(messages.c_str(), "w")) {
        std::fputs(error.what(), file);
        std::fclose(file);
      }
      std::exit(1);
    }
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) return {WTERMSIG(status), 0};
  return {0, WEXITSTATUS(status)};
}
