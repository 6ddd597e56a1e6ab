#include "cli/terminal/run_display.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cli/terminal/log.hpp"
#include "cli/terminal/screen.hpp"
#include "ensemble/statistics/counted.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "results/disk/printable.hpp"

namespace jostle::inline cli {

void RunDisplay::computing(const Progress& progress, const WorkAhead& ahead, std::uint64_t pending,
                           std::uint64_t all) {
  if (!file_.empty()) {
    log_line(fmt::format("{}: {} of {} to do on {}", printable_name(file_), pending,
                         counted(all, "realization"),
                         counted(static_cast<std::uint64_t>(threads_), "thread")));
  }
  computing_.emplace(progress, ahead, style_, budget_);
}

void RunDisplay::computed() {
  computing_.reset();
  storing_.emplace(style_);
}

void RunDisplay::storing(std::uint64_t done, std::uint64_t total) {
  if (storing_) storing_->show(done, total);
}

void RunDisplay::compared(const PrecisionStatus& status) {
  if (prints_targets_) print_wrapped(precision_line(status));
}

std::string precision_line(const PrecisionStatus& status) {
  const char* const verdict = status.met                          ? "reached"
                              : status.next > status.realizations ? "not reached yet"
                              : status.copies.empty() ? "NOT reached, and no more are allowed"
                                                      : "NOT reached";
  const PrecisionStatus::Target& farthest = status.farthest;
  const std::string value = std::isnan(farthest.value)
                                ? "not known (fewer than two independent realizations)"
                                : finite_text("{:.2g}", farthest.value);
  const std::string copies = status.copies.empty() ? "" : "; " + status.copies;
  return finite_text("{}: target precision {}: {} of {} is {}, target at most {:.2g}{}\n",
                     counted(status.realizations, "realization"), verdict, farthest.spread,
                     farthest.observable, value, farthest.at_most, copies);
}

}  // namespace jostle::inline cli
