#include "study/cost/rounds.hpp"

#include <algorithm>
#include <map>

namespace jostle {

double rounds_done(std::span<const RealizationSummary> before,
                   std::span<const RealizationSummary> after) {
  std::map<RealizationId, double> known;
  for (const RealizationSummary& one : before) known[one.id] = one.work.seconds;
  struct Setting {
    double seconds = 0, gained = 0;
    std::uint64_t realizations = 0;
  };
  std::map<std::uint32_t, Setting> settings;
  for (const RealizationSummary& one : after) {
    if (one.status != RealizationStatus::done) continue;
    Setting& setting = settings[one.id.point];
    setting.seconds += one.work.seconds;
    setting.gained += one.work.seconds - known[one.id];
    ++setting.realizations;
  }
  double of_a_round = 0, gained = 0;
  for (const auto& [point, setting] : settings) {
    of_a_round += setting.seconds / static_cast<double>(setting.realizations);
    gained += setting.gained;
  }
  return of_a_round > 0 ? gained / of_a_round : 0;
}

std::uint32_t affordable_rounds(std::uint32_t rounds, Seconds budget, Seconds spent, double done) {
  constexpr double most = 1e6;
  if (done <= 0) return spent < budget ? rounds + 1 : rounds;
  const double a_round = spent.count() / done;
  const double more = std::max(0.0, (budget - spent).count() / a_round);
  return rounds + static_cast<std::uint32_t>(std::min(more, most));
}

}  // namespace jostle
