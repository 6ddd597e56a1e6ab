#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "cli/durations.hpp"

namespace jostle {

/// While it lives, SIGINT, SIGTERM and SIGUSR1 ask for a stop instead of ending the process, and so
/// does the time limit. A second SIGINT ends the process at once. One at a time.
class StopRequest {
 public:
  explicit StopRequest(std::optional<Seconds> time_limit);
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// Set once a stop is asked for.
  const std::atomic<bool>& flag() const;
  /// "SIGTERM" or "the time limit"; empty while nothing asked.
  std::string reason() const;

 private:
  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::jthread clock_;
};

}  // namespace jostle
