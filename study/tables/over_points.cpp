#include "study/tables/over_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "study/bad_input.hpp"

namespace jostle::inline study {

std::string of_chosen_points(const ResultsFile& file, std::span<const std::uint32_t> points) {
  const std::size_t all = file.study().points.size();
  if (points.size() >= all) return {};
  return fmt::format("; a choice of sweep points leaves {} of the file's {}: take all",
                     points.size(), all);
}

std::vector<std::string> reasons_left_out(const ResultsFile& file,
                                          std::span<const std::uint32_t> points) {
  std::map<std::uint32_t, std::uint64_t> rows;  // of points, that all their realizations have
  for (const RealizationSummary& one : file.realizations()) {
    const bool usable =
        one.status == RealizationStatus::done || one.status == RealizationStatus::running;
    if (!usable || one.rows == 0) continue;
    const auto [at, first] = rows.try_emplace(one.id.point, one.rows);
    if (!first) at->second = std::min(at->second, one.rows);
  }
  const auto planned = [&](std::uint32_t point) { return file.study().points[point].taps; };
  std::map<std::uint64_t, std::uint64_t> farthest;  // of runs that are as long
  for (const std::uint32_t point : points) {
    if (rows.contains(point))
      farthest[planned(point)] = std::max(farthest[planned(point)], rows.at(point));
  }
  std::vector<std::string> reasons;
  for (const std::uint32_t point : points) {
    if (!rows.contains(point)) {
      reasons.emplace_back("no realization has taps");
    } else if (rows.at(point) < farthest.at(planned(point))) {
      reasons.push_back(fmt::format("its realizations have come to tap {} together, others to {}",
                                    rows.at(point) - 1, farthest.at(planned(point)) - 1));
    } else {
      reasons.emplace_back();
    }
  }
  return reasons;
}

std::string left_out_text(const ResultsFile& file, std::span<const std::uint32_t> points,
                          const std::vector<std::string>& reasons) {
  std::string text;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (reasons[i].empty()) continue;
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", file.study().points[points[i]].label,
                        reasons[i]);
  }
  return text;
}

void require_taps(const ResultsFile& file, std::uint32_t point, std::size_t n_realizations) {
  if (n_realizations > 0) return;
  const std::string& label = file.study().points[point].label;
  throw BadInput(fmt::format("no realization has taps{}", label.empty() ? "" : " at " + label));
}

}  // namespace jostle::inline study
