#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace jostle::inline cli {

/// A thread that waits for times, and ends when this does: std::jthread with a stop token, which
/// libc++ before version 20 keeps behind an option.
class ClockThread {
 public:
  ClockThread() = default;
  ClockThread(const ClockThread&) = delete;
  ClockThread& operator=(const ClockThread&) = delete;
  ~ClockThread() { end(); }

  /// Once. `work` is to return soon after wait() has returned true.
  void begin(std::function<void()> work) { thread_ = std::thread(std::move(work)); }
  bool has_begun() const { return thread_.joinable(); }

  /// In `work`: waits so long, or until the end is asked for, and returns whether it is.
  template <class Rep, class Period>
  bool wait(std::chrono::duration<Rep, Period> time) {
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, time, [this] { return end_asked_; });
  }

  /// Asks for the end and waits for it.
  void end() {
    if (!has_begun()) return;
    {
      const std::lock_guard lock(mutex_);
      end_asked_ = true;
    }
    ended_.notify_all();
    thread_.join();
  }

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_asked_ = false;
  std::thread thread_;
};

}  // namespace jostle::inline cli
