#include "cli/terminal/progress_display.hpp"

#include <fmt/format.h>

#include <new>

#include "cli/tables/durations.hpp"
#include "cli/tables/text_table.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "study/amounts.hpp"

namespace jostle::inline cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds live_interval{500};
constexpr std::chrono::seconds plain_interval{30};
constexpr const char* clear_line = "\r\033[K";

std::string counts(const Progress& progress, const WorkAhead& ahead, std::uint64_t taps,
                   double rate) {
  const std::string line = fmt::format("{}/{} done, {} running, {} failed; taps {}/{}",
                                       progress.realizations_done.load(), ahead.realizations,
                                       progress.realizations_running.load(),
                                       progress.realizations_failed.load(), taps, ahead.taps);
  return ahead.unit.empty() ? line
                            : line + fmt::format("; {} {}/s", format_count(rate), ahead.unit);
}

Clock::duration interval_of(ProgressStyle style) {
  return style == ProgressStyle::live ? Clock::duration(live_interval) : plain_interval;
}

}  // namespace

std::string progress_line(const Progress& progress, const WorkAhead& ahead, double rate,
                          std::chrono::duration<double> elapsed) {
  const std::uint64_t taps = progress.taps_done;
  std::string line = counts(progress, ahead, taps, rate);
  if (taps > 0 && taps <= ahead.taps) {
    const double left = static_cast<double>(ahead.taps - taps) / static_cast<double>(taps);
    line += fmt::format("; {} left", format_duration(elapsed * left));
  }
  return line;
}

std::string pilot_line(const Progress& progress, const WorkAhead& ahead, double rate,
                       std::chrono::duration<double> used, std::chrono::duration<double> budget) {
  return fmt::format("pilots: {}; {} of the budget of {} used",
                     counts(progress, ahead, progress.taps_done, rate), format_duration(used),
                     format_duration(budget));
}

ProgressDisplay::ProgressDisplay(const Progress& progress, WorkAhead ahead, ProgressStyle style,
                                 std::optional<PilotBudget> budget)
    : progress_(progress), ahead_(ahead), style_(style), budget_(budget) {
  if (style == ProgressStyle::none) return;
  clock_.begin([this] {
    try {
      show_until_end();
    } catch (const std::bad_alloc&) {  // no more lines; the run reports lack of memory
    }
  });
}

ProgressDisplay::~ProgressDisplay() {
  if (!clock_.has_begun()) return;
  clock_.end();
  if (style_ == ProgressStyle::live) print_to_standard_error_exactly(clear_line);
}

void ProgressDisplay::show_until_end() {
  const bool live = style_ == ProgressStyle::live;
  const Clock::duration interval = interval_of(style_);
  const auto began = Clock::now();
  auto last_time = began;
  std::uint64_t last_units = progress_.units_done;
  while (!clock_.wait(interval)) {
    const auto now = Clock::now();
    const std::uint64_t units = progress_.units_done;
    const std::chrono::duration<double> since = now - last_time;
    const double rate = static_cast<double>(units - last_units) / since.count();
    const std::string line =
        budget_ ? pilot_line(progress_, ahead_, rate, now - budget_->began, budget_->whole)
                : progress_line(progress_, ahead_, rate, now - began);
    print_to_standard_error_exactly(live ? clear_line + line : "jostle: " + line + "\n");
    last_time = now;
    last_units = units;
  }
}

StoringDisplay::~StoringDisplay() {
  if (shown_ && style_ == ProgressStyle::live) print_to_standard_error_exactly(clear_line);
}

void StoringDisplay::show(std::uint64_t done, std::uint64_t total) {
  const auto now = Clock::now();
  if (style_ == ProgressStyle::none || now - last_ < interval_of(style_)) return;
  last_ = now;
  shown_ = true;
  const std::string line = fmt::format("writing the results: {}/{} realizations", done, total);
  const bool live = style_ == ProgressStyle::live;
  print_to_standard_error_exactly(live ? clear_line + line : "jostle: " + line + "\n");
}

}  // namespace jostle::inline cli
