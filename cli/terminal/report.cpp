#include "cli/terminal/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cli/terminal/durations.hpp"
#include "cli/terminal/text_table.hpp"
#include "ensemble/moments.hpp"

namespace jostle {
namespace {

/// The observables of a point, and the relaxation columns that follow them.
struct PointSeries {
  std::vector<EnsembleSeries> observables;
  EnsembleSeries sweeps, acceptance, capped, dropped_offsets;
};

PointSeries point_series(const ResultsFile& file, std::uint32_t point) {
  PointSeries series;
  for (EnsembleSeries& column : file.ensemble(point)) {
    const std::string& name = column.label.name;
    if (name == "sweeps") {
      series.sweeps = std::move(column);
    } else if (name == "acceptance") {
      series.acceptance = std::move(column);
    } else if (name == "capped") {
      series.capped = std::move(column);
    } else if (name == "dropped_offsets") {
      series.dropped_offsets = std::move(column);
    } else {
      series.observables.push_back(std::move(column));
    }
  }
  return series;
}

/// The last tap that any realization has reached; nothing where none has begun.
std::optional<std::uint64_t> last_tap(const EnsembleSeries& column) {
  const auto reached = std::find_if(column.count.rbegin(), column.count.rend(),
                                    [](std::uint32_t count) { return count > 0; });
  if (reached == column.count.rend()) return {};
  return static_cast<std::uint64_t>(column.count.rend() - reached) - 1;
}

/// Decimals that show the smallest error of a column to two digits; -1 where no error is known.
int decimals_of(const EnsembleSeries& column, const std::vector<std::uint64_t>& taps) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint64_t tap : taps) {
    if (column.error[tap] > 0) least = std::min(least, column.error[tap]);
  }
  return std::isinf(least) ? -1 : decimals_for(least);
}

std::string cell(double value, int decimals) {
  if (std::isnan(value)) return "-";
  return decimals < 0 ? fmt::format("{:.6g}", value) : fmt::format("{:.{}f}", value, decimals);
}

std::string tap_table(const PointSeries& series, std::uint64_t last) {
  const auto taps = reported_taps(last);
  const std::vector<std::uint32_t>& reached = series.sweeps.count;
  const bool partial = std::ranges::any_of(
      taps, [&](std::uint64_t tap) { return reached[tap] != reached[taps.front()]; });
  std::vector<std::string> headers{"tap"};
  if (partial) headers.emplace_back("M");
  std::vector<int> decimals;
  for (const auto& column : series.observables) {
    decimals.push_back(decimals_of(column, taps));
    headers.insert(headers.end(), {column.label.name, "+- error", "sigma"});
  }
  headers.insert(headers.end(), {"sweeps", "acceptance"});
  TextTable table(headers);
  for (const std::uint64_t tap : taps) {
    std::vector<std::string> row{fmt::to_string(tap)};
    if (partial) row.push_back(fmt::to_string(reached[tap]));
    for (std::size_t i = 0; i < series.observables.size(); ++i) {
      const auto& column = series.observables[i];
      for (const double value : {column.mean[tap], column.error[tap], column.sigma[tap]}) {
        row.push_back(cell(value, decimals[i]));
      }
    }
    row.push_back(cell(series.sweeps.mean[tap], 0));
    row.push_back(cell(series.acceptance.mean[tap], 4));
    table.add(std::move(row));
  }
  return table.text();
}

std::string capped_line(const EnsembleSeries& capped, const EnsembleSeries& sweeps) {
  double relaxations = 0, at_cap = 0;
  for (std::size_t tap = 0; tap < capped.count.size(); ++tap) {
    const bool relaxed = tap > 0 || sweeps.mean[tap] > 0;  // a poured start is not relaxed
    if (capped.count[tap] == 0 || !relaxed) continue;
    relaxations += capped.count[tap];
    at_cap += capped.mean[tap] * capped.count[tap];
  }
  if (at_cap < 0.5) return "no relaxation ended at the cap on sweeps\n";
  return fmt::format("{:.0f} of {:.0f} relaxations ended at the cap on sweeps: raise max_sweeps\n",
                     at_cap, relaxations);
}

/// Of the taps that dropped any; nothing where none did, as without a shake.
std::string dropped_offsets_line(const EnsembleSeries& dropped) {
  double taps = 0, share = 0;
  for (std::size_t tap = 0; tap < dropped.count.size(); ++tap) {
    if (!(dropped.mean[tap] > 0)) continue;
    ++taps;
    share += dropped.mean[tap];
  }
  if (taps == 0) return "";
  return fmt::format("shakes dropped {:.1f} % of their lateral offsets for want of room\n",
                     100 * share / taps);
}

/// Means over realizations; nothing of a start that is no fitted pour.
std::string fitting_line(const ResultsFile& file, std::uint32_t point) {
  FittingReport mean;
  for (const RealizationValues& column : file.fittings(point)) {
    Moments moments;
    for (const double value : column.values) moments.add(value);
    for (const FittingColumn& field : fitting_columns) {
      if (column.label.name == field.name) mean.*field.field = moments.mean();
    }
  }
  if (!(mean.spheres_moved > 0)) return "";
  return fmt::format(
      "fitting between the walls moved {:.0f} of {} spheres, up by {:.2f} d on average: "
      "corrected fraction {:.4f} -> {:.4f}, away from the walls {:.4f} -> {:.4f}\n",
      mean.spheres_moved, file.study().points[point].n_spheres, mean.mean_rise,
      mean.corrected_fraction_before, mean.corrected_fraction_after, mean.central_fraction_before,
      mean.central_fraction_after);
}

/// Realizations of one point by how they ended, and what they cost.
struct PointCost {
  std::uint64_t done = 0, unfinished = 0, failed = 0;
  Work work;
};

std::string cost_line(const PointCost& cost) {
  std::string line = fmt::format("{} done", cost.done);
  if (cost.unfinished > 0) line += fmt::format(", {} unfinished", cost.unfinished);
  line += fmt::format(", {} failed; {} trials in {} of one core", cost.failed,
                      format_count(static_cast<double>(cost.work.trials)),
                      format_duration(Seconds(cost.work.seconds)));
  if (cost.work.seconds > 0) {
    line += fmt::format(", {} trials/s a core",
                        format_count(static_cast<double>(cost.work.trials) / cost.work.seconds));
  }
  return line + "\n";
}

std::string failure_line(const RealizationSummary& failed, const StudyPoint& point) {
  return fmt::format("realization {} failed (seed {}): {}\n", failed.id.realization, point.seed,
                     failed.reason);
}

std::string point_report(const ResultsFile& file, std::uint32_t point,
                         const std::vector<RealizationSummary>& realizations) {
  const StudyPoint& study = file.study().points[point];
  PointCost cost;
  std::string failures;
  for (const auto& one : realizations) {
    if (one.id.point != point) continue;
    cost.work += one.work;
    if (one.status == RealizationStatus::done) {
      ++cost.done;
    } else if (one.status == RealizationStatus::failed) {
      ++cost.failed;
      failures += failure_line(one, study);
    } else if (in_share(file.shard(), file.study(), one.id)) {
      ++cost.unfinished;
    }
  }
  std::string text = study.label.empty() ? "" : study.label + "\n";
  const PointSeries series = point_series(file, point);
  if (const auto last = last_tap(series.sweeps)) {
    text += tap_table(series, *last) + capped_line(series.capped, series.sweeps) +
            dropped_offsets_line(series.dropped_offsets) + fitting_line(file, point);
  }
  return text + cost_line(cost) + failures;
}

}  // namespace

std::string failure_lines(const ResultsFile& file) {
  std::string lines;
  for (const RealizationSummary& one : file.realizations()) {
    if (one.status != RealizationStatus::failed) continue;
    if (file.study().points.size() > 1) lines += fmt::format("sweep point {}, ", one.id.point);
    lines += failure_line(one, file.study().points[one.id.point]);
  }
  return lines;
}

std::vector<std::uint64_t> reported_taps(std::uint64_t last) {
  std::vector<std::uint64_t> taps{0};
  for (std::uint64_t decade = 1; decade < last; decade *= 10) {
    for (const std::uint64_t tap : {decade, 2 * decade, 5 * decade}) {
      if (tap < last) taps.push_back(tap);
    }
  }
  if (last > 0) taps.push_back(last);
  return taps;
}

std::string report(const ResultsFile& file) {
  const std::vector<RealizationSummary> realizations = file.realizations();
  std::string text;
  for (std::uint32_t point = 0; point < file.study().points.size(); ++point) {
    if (!text.empty()) text += '\n';
    text += point_report(file, point, realizations);
  }
  return text;
}

}  // namespace jostle
