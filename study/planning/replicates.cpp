#include "study/planning/replicates.hpp"

#include <algorithm>
#include <map>

namespace jostle::inline study {

double replicates_done(std::span<const RealizationSummary> summaries_before,
                       std::span<const RealizationSummary> summaries_after) {
  std::map<RealizationId, double> known;
  for (const RealizationSummary& realization : summaries_before)
    known[realization.id] = realization.work.seconds;
  struct Setting {
    double seconds = 0, gained = 0;
    std::uint64_t realizations = 0;
  };
  std::map<std::uint32_t, Setting> settings;
  for (const RealizationSummary& realization : summaries_after) {
    if (realization.status != RealizationStatus::done) continue;
    Setting& setting = settings[realization.id.point];
    setting.seconds += realization.work.seconds;
    setting.gained += realization.work.seconds - known[realization.id];
    ++setting.realizations;
  }
  double of_a_replicate = 0, gained = 0;
  for (const auto& [point, setting] : settings) {
    of_a_replicate += setting.seconds / static_cast<double>(setting.realizations);
    gained += setting.gained;
  }
  return of_a_replicate > 0 ? gained / of_a_replicate : 0;
}

std::uint32_t affordable_replicates(std::uint32_t replicates, Seconds budget, Seconds spent,
                                    double done) {
  constexpr double most = 1e6;
  if (done <= 0) return spent < budget ? replicates + 1 : replicates;
  const double a_replicate = spent.count() / done;
  const double extra = std::max(0.0, (budget - spent).count() / a_replicate);
  return replicates + static_cast<std::uint32_t>(std::min(extra, most));
}

}  // namespace jostle::inline study
