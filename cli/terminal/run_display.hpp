#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "cli/terminal/progress_display.hpp"
#include "study/running/run.hpp"

namespace jostle::inline cli {

/// Messages of a run: its extent, progress, and the state of its targets.
class RunDisplay : public RunObserver {
 public:
  /// `file` is printed with the extent; nothing is printed where it is empty.
  RunDisplay(ProgressStyle style, std::string file, int threads, bool prints_targets)
      : style_(style), file_(std::move(file)), threads_(threads), prints_targets_(prints_targets) {}

  /// The realizations are pilots, whose budget of wall-clock time begins here.
  void begin_budget(std::chrono::duration<double> whole) {
    budget_ = {std::chrono::steady_clock::now(), whole};
  }

  void computing(const Progress& progress, const WorkAhead& ahead, std::uint64_t pending,
                 std::uint64_t all) override;
  void computed() override;
  void storing(std::uint64_t done, std::uint64_t total) override;
  void stored() override { storing_.reset(); }
  void compared(const PrecisionStatus& status) override;

 private:
  ProgressStyle style_;
  std::string file_;
  int threads_;
  bool prints_targets_;
  std::optional<PilotBudget> budget_;
  std::optional<ProgressDisplay> computing_;
  std::optional<StoringDisplay> storing_;
};

/// One line for people: whether it is enough, and the target that is farthest from being met.
std::string precision_line(const PrecisionStatus& status);

}  // namespace jostle::inline cli
