#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "cli/reports/durations.hpp"

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
  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::jthread clock_;
};

}  // namespace jostle::inline cli
