#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace jostle::inline results {

/// How long a process waits for a results file that another one works on.
struct Patience {
  using Duration = std::chrono::duration<double>;

  Duration for_storing{10};  // another process that stores tables, which takes moments
  Duration for_runs{0};      // a run, which may take days
  /// Receives what is waited for, once, before the wait for a run begins. May be empty.
  std::function<void(const std::string&)> tell = {};
};

}  // namespace jostle::inline results
