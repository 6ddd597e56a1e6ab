#include "cli/terminal/run_display.hpp"

#include <fmt/format.h>

#include "cli/terminal/log.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "ensemble/statistics/counted.hpp"
#include "results/export/printable.hpp"

namespace jostle::inline cli {

void RunDisplay::computing(const Progress& progress, const WorkAhead& ahead, std::uint64_t pending,
                           std::uint64_t all) {
  if (!file_.empty()) {
    log_line(fmt::format("{}: {} of {} to do on {}", printable(file_), pending,
                         counted(all, "realization"),
                         counted(static_cast<std::uint64_t>(threads_), "thread")));
  }
  computing_.emplace(progress, ahead, style_);
}

void RunDisplay::computed() {
  computing_.reset();
  storing_.emplace(style_);
}

void RunDisplay::storing(std::uint64_t done, std::uint64_t of) {
  if (storing_) storing_->show(done, of);
}

void RunDisplay::compared(const PrecisionStatus& status) {
  if (prints_targets_) print(precision_line(status));
}

std::string precision_line(const PrecisionStatus& status) {
  const auto& values = std::get<std::vector<double>>(status.table.quantities[3].values);
  const auto& limits = std::get<std::vector<double>>(status.table.quantities[4].values);
  std::size_t farthest = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double excess = values[i] / limits[i], most = values[farthest] / limits[farthest];
    if (!(excess <= most)) farthest = i;
  }
  const auto text = [&](std::size_t column) {
    return std::get<std::vector<std::string>>(status.table.quantities[column].values)[farthest];
  };
  const char* const verdict = status.met                          ? "enough"
                              : status.next > status.realizations ? "not enough yet"
                                                                  : "NOT enough, but the limit";
  return fmt::format("{} {} {}: {} of {} is {:.2g}, wanted at most {:.2g}\n",
                     counted(status.realizations, "realization"),
                     status.realizations == 1 ? "is" : "are", verdict, text(2), text(1),
                     values[farthest], limits[farthest]);
}

}  // namespace jostle::inline cli
