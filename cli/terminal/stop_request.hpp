#pragma once

#include <atomic>
#include <string>

#include "cli/tables/durations.hpp"
#include "cli/terminal/clock_thread.hpp"

namespace jostle::inline cli {

/// While it lives, SIGINT, SIGTERM and SIGUSR1 ask for a stop instead of ending the process. A
/// second SIGINT ends the process at once. One at a time.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// A time limit asks likewise, so long after this; once.
  void stop_after(Seconds limit);
  /// Set once a stop is asked for.
  const std::atomic<bool>& flag() const;
  /// "SIGTERM" or "the time limit"; empty while nothing asked.
  std::string reason() const;

 private:
  ClockThread clock_;
};

}  // namespace jostle::inline cli
