#include "study/tables/points/over_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "config/json/json_text.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "study/bad_input.hpp"

namespace jostle::inline study {

std::string of_chosen_points(const ResultsFile& file, std::span<const std::uint32_t> points) {
  const std::size_t all = file.study().points.size();
  if (points.size() >= all) return {};
  return fmt::format("; a choice of sweep points leaves {} of the file's {}: take all",
                     points.size(), all);
}

SharedTaps shared_taps(std::span<const ReachedTaps> points) {
  std::map<std::uint64_t, std::uint64_t> farthest, shared;  // rows, by the planned taps
  for (const ReachedTaps& point : points)
    farthest[point.planned] = std::max(farthest[point.planned], point.rows);
  const auto last = [](std::uint64_t rows) { return rows - 1; };
  SharedTaps found;
  for (const ReachedTaps& point : points) {
    const std::uint64_t most = farthest.at(point.planned);
    std::string reason;
    if (point.rows == 0) {
      reason = "no realization has taps";
    } else if (2 * last(point.rows) < last(most)) {
      reason = fmt::format(
          "its realizations have all reached tap {}, fewer than half of the {} taps that those of "
          "another point reached",
          last(point.rows), last(most));
    } else {
      const auto [place, first] = shared.try_emplace(point.planned, point.rows);
      if (!first) place->second = std::min(place->second, point.rows);
    }
    found.reasons.push_back(std::move(reason));
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    found.rows.push_back(found.reasons[i].empty() ? shared.at(points[i].planned) : 0);
  return found;
}

namespace {

const char* advice_on(const std::string& quantity) {
  if (quantity == "value") return "Run realizations that reach their last taps";
  if (quantity.starts_with("steady/"))
    return "Average over more taps, tap longer, or sweep the mean of the last taps "
           "(quantity value)";
  return "Tap longer or run more realizations, or sweep another quantity";
}

}  // namespace

std::string without_any_value(const std::string& quantity, const std::string& observable,
                              const std::string& axis,
                              const std::vector<std::pair<double, std::string>>& reasons) {
  std::map<std::string, std::set<double>> places;
  for (const auto& [place, reason] : reasons)
    places[reason.empty() ? "it is not defined for these taps" : reason].insert(place);
  std::vector<std::string> texts;
  for (const auto& [reason, all] : places) {
    std::vector<std::string> numbers;
    for (const double place : all) numbers.push_back(finite_text("{:.4g}", place));
    texts.push_back(fmt::format("at {} = {}: {}", axis, joined(numbers, ", "), reason));
  }
  return fmt::format("no sweep point has a value of {}{}; {}. {}",
                     quantity == "value" ? "" : quantity + " of ", observable, joined(texts, "; "),
                     advice_on(quantity));
}

void PointNotes::add(const std::string& label, const std::string& text) {
  if (text.empty()) return;
  std::string line = label.empty() ? text : label + ": " + text;
  if (std::ranges::find(texts_, line) == texts_.end()) texts_.push_back(std::move(line));
}

void PointNotes::note(const std::string& name, Table& table) const {
  if (!texts_.empty()) table.notes.emplace_back(name, joined(texts_, "; "));
}

void require_taps(const ResultsFile& file, std::uint32_t point, std::size_t n_realizations) {
  if (n_realizations > 0) return;
  const std::string& label = file.study().points[point].label;
  throw BadInput(fmt::format("no realization has taps{}", label.empty() ? "" : " at " + label));
}

}  // namespace jostle::inline study
