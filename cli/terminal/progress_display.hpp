#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include "cli/terminal/clock_thread.hpp"
#include "study/running/run.hpp"

namespace jostle::inline cli {

/// How progress is shown on stderr: a line rewritten in place, a plain line every half minute, or
/// not at all.
enum class ProgressStyle { live, plain, none };

/// Wall-clock time that a series of pilots may take, since it began.
struct PilotBudget {
  std::chrono::steady_clock::time_point began;
  std::chrono::duration<double> whole;
};

/// Shows a run's progress from its own thread while it lives.
class ProgressDisplay {
 public:
  ProgressDisplay(const Progress& progress, WorkAhead ahead, ProgressStyle style,
                  std::optional<PilotBudget> budget = std::nullopt);
  /// Clears a live line; prints nothing further.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

 private:
  void show_until_end();

  const Progress& progress_;
  WorkAhead ahead_;
  ProgressStyle style_;
  std::optional<PilotBudget> budget_;
  ClockThread clock_;
};

/// Shows how far the writing of a results file is, which takes its time with many sweep points.
class StoringDisplay {
 public:
  explicit StoringDisplay(ProgressStyle style)
      : style_(style), last_(std::chrono::steady_clock::now()) {}
  /// Clears a live line; prints nothing further.
  ~StoringDisplay();
  StoringDisplay(const StoringDisplay&) = delete;
  StoringDisplay& operator=(const StoringDisplay&) = delete;

  /// Realizations that are written, of how many. A line where the last is old enough.
  void show(std::uint64_t done, std::uint64_t total);

 private:
  ProgressStyle style_;
  std::chrono::steady_clock::time_point last_;
  bool shown_ = false;
};

/// One line of progress: "3/8 done, 2 running, 0 failed; taps 120/408; 41.0 M trials/s; 1 min 5 s
/// left". `rate` in units of the engine a second; `elapsed` since the run began.
std::string progress_line(const Progress& progress, const WorkAhead& ahead, double rate,
                          std::chrono::duration<double> elapsed);

/// One line about pilots that a budget of wall-clock time limits: "pilots: 3/8 done, 2 running, 0
/// failed; taps 120/408; 41.0 M trials/s; 1 min 5 s of the budget of 10 min 0 s used". Pilots of
/// rough and strict settings differ too much to extrapolate the time left.
std::string pilot_line(const Progress& progress, const WorkAhead& ahead, double rate,
                       std::chrono::duration<double> used, std::chrono::duration<double> budget);

}  // namespace jostle::inline cli
