#pragma once

namespace jostle {

/// First thing in the program. A standard stream that the caller closed is opened, so that no
/// results file takes its number and is written over by messages; writing to it still fails. Beyond
/// a limit on file sizes (ulimit -f) a write fails and says so, where it would kill.
void guard_files();

/// From now on a reader of standard output or error that went away costs the text, not the run.
void outlive_readers();

}  // namespace jostle
