#pragma once

namespace jostle::inline cli {

/// Exit codes of the program; docs/reference/commands.md documents them for scripts.
enum ExitCode : int {
  exit_ok = 0,
  exit_requests = 1,             // `requests` of jostle_first_run: only jostle suffices
  exit_bad_input = 2,            // the scene or the command line; nothing was run or written
  exit_failed_realizations = 3,  // the rest is stored
  exit_io_error = 4,             // a file or the disk
  exit_stopped = 75,             // by a signal or the time limit; resumable (EX_TEMPFAIL)
};

}  // namespace jostle::inline cli
