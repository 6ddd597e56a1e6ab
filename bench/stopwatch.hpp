#pragma once

#include <ctime>

namespace jostle::bench {

/// Seconds of processor time of this thread: other programs on the machine do not count.
inline double thread_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace jostle::bench
