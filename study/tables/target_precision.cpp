#include "study/tables/target_precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/numbers.hpp"
#include "ensemble/moments.hpp"
#include "study/tables/points/over_points.hpp"
#include "study/tables/repeated_series.hpp"

namespace jostle::inline study {

namespace {

/// The target's largest spread over its taps; NaN where one has fewer than two realizations that
/// repeat no other.
double largest_spread(const ResultsFile& file, std::uint32_t point, const SpreadTarget& target,
                      const std::vector<std::uint32_t>& copies) {
  std::vector<std::uint64_t> taps = target.taps;
  if (taps.empty()) taps = {file.study().points[point].taps};
  double largest = 0;
  for (const std::uint64_t tap : taps) {
    Moments moments;
    std::vector<double> values =
        file.block(point, target.observable, {tap, tap + 1}, {0, file.study().realizations});
    for (const std::uint32_t copy : copies) values[copy] = not_a_number;
    for (const double value : values) moments.add(value);
    const double error = moments.standard_error();  // NaN below two, where sigma is 0
    const double spread = target.spread == Spread::sigma && error >= 0 ? moments.sigma() : error;
    if (std::isnan(spread)) return spread;
    largest = std::max(largest, spread);
  }
  return largest;
}

const char* name_of(Spread spread) {
  return spread == Spread::sigma ? "sigma" : "standard_error";
}

}  // namespace

PrecisionStatus precision_status(const ResultsFile& file, const TargetPrecision& until) {
  PrecisionStatus status;
  status.realizations = file.study().realizations;
  std::vector<SpreadFound> found, improvable;
  PointNotes copies;
  std::vector<std::uint64_t> rows, points;
  std::vector<std::string> observables, spreads;
  std::vector<double> values, limits;
  for (std::uint32_t point = 0; point < file.study().points.size(); ++point) {
    for (const SpreadTarget& target : until.targets) {
      const Repetitions repeated = repetitions(file, point, target.observable);
      copies.add(file.study().points[point].label, repeated.text);
      const double value = largest_spread(file, point, target, repeated.realizations);
      found.push_back({target.spread, value, target.at_most});
      // Where all realizations are copies of one, another would be a copy, too.
      if (repeated.text.empty() || !repeated.leave_one) improvable.push_back(found.back());
      // One that is not known is farther than all that are.
      const double excess = value / target.at_most,
                   most = status.farthest.value / status.farthest.at_most;
      if (rows.empty() || (!std::isnan(most) && !(excess <= most)))
        status.farthest = {target.observable, name_of(target.spread), value, target.at_most};
      rows.push_back(rows.size());
      points.push_back(point);
      observables.push_back(target.observable);
      spreads.emplace_back(name_of(target.spread));
      values.push_back(value);
      limits.push_back(target.at_most);
    }
  }
  status.met = std::ranges::all_of(found, [](const SpreadFound& spread) { return spread.met(); });
  status.next = next_realizations(status.realizations, improvable, until.at_most);
  const std::vector<std::string> axes = {"target"};
  status.table = {.name = "target_precision",
                  .axes = {{"target", axes, rows, "1", "targets at sweep points", ""}},
                  .quantities = {{"point", axes, points, "1", "sweep point", ""},
                                 {"observable", axes, observables, "1", "observable", ""},
                                 {"spread", axes, spreads, "1", "what is to be small", ""},
                                 {"value", axes, values, "", "largest over the taps", ""},
                                 {"at_most", axes, limits, "", "what was asked for", ""}},
                  .notes = {{"realizations", fmt::to_string(status.realizations)},
                            {"verdict", status.met ? "met" : "not met"}}};
  copies.note("copies", status.table);
  if (!copies.is_empty()) status.copies = status.table.notes.back().second;
  return status;
}

}  // namespace jostle::inline study
