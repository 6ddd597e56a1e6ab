#include "cli/reports/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "cli/reports/durations.hpp"
#include "cli/reports/text_table.hpp"
#include "ensemble/moments.hpp"
#include "study/amounts.hpp"

namespace jostle::inline cli {
namespace {

/// The columns of a point, and how many realizations have come to each tap.
struct PointSeries {
  std::vector<EnsembleSeries> columns;
  std::vector<std::uint32_t> reached;  // [n_taps]
};

PointSeries point_series(const ResultsFile& file, std::uint32_t point,
                         std::span<const RealizationSummary> realizations) {
  PointSeries series{file.ensemble(point), {}};
  for (const RealizationSummary& one : realizations) {
    if (one.rows == 0) continue;
    series.reached.resize(std::max(series.reached.size(), static_cast<std::size_t>(one.rows)));
    ++series.reached[one.rows - 1];  // for now, of those that end here
  }
  for (std::size_t tap = series.reached.size(); tap-- > 1;) {
    series.reached[tap - 1] += series.reached[tap];
  }
  return series;
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

std::string tap_table(const PointSeries& series) {
  const auto taps = reported_taps(series.reached.size() - 1);
  const std::vector<std::uint32_t>& reached = series.reached;
  const bool partial = std::ranges::any_of(
      taps, [&](std::uint64_t tap) { return reached[tap] != reached[taps.front()]; });
  std::vector<std::string> headers{"tap"};
  if (partial) headers.emplace_back("M");
  std::vector<int> decimals;
  for (const auto& column : series.columns) {
    const Column& label = column.label;
    decimals.push_back(label.shown == Shown::spread ? decimals_of(column, taps) : label.decimals);
    if (label.shown == Shown::spread || label.shown == Shown::mean) headers.push_back(label.name);
    if (label.shown == Shown::spread) headers.insert(headers.end(), {"+- error", "sigma"});
  }
  TextTable table(headers);
  for (const std::uint64_t tap : taps) {
    std::vector<std::string> row{fmt::to_string(tap)};
    if (partial) row.push_back(fmt::to_string(reached[tap]));
    for (std::size_t i = 0; i < series.columns.size(); ++i) {
      const auto& column = series.columns[i];
      const Shown shown = column.label.shown;
      if (shown == Shown::spread || shown == Shown::mean) {
        row.push_back(cell(column.mean[tap], decimals[i]));
      }
      if (shown != Shown::spread) continue;
      for (const double value : {column.error[tap], column.sigma[tap]}) {
        row.push_back(cell(value, decimals[i]));
      }
    }
    table.add(std::move(row));
  }
  return table.text();
}

std::string sentence(std::string text, const std::string& number) {
  const auto place = text.find("{}");
  if (place != std::string::npos) text.replace(place, 2, number);
  return text.empty() ? text : text + "\n";
}

/// How often it happened, of the taps at which the engine moved anything: a start that is not
/// relaxed leaves columns of the engine without a value.
std::string count_line(const EnsembleSeries& happened, const PointSeries& series) {
  double taps = 0, times = 0;
  for (std::size_t tap = 0; tap < happened.count.size(); ++tap) {
    const bool moved = std::ranges::all_of(series.columns, [&](const EnsembleSeries& column) {
      return column.label.shown == Shown::spread || column.count[tap] > 0;
    });
    if (!moved) continue;
    taps += happened.count[tap];
    times += happened.mean[tap] * happened.count[tap];
  }
  if (times < 0.5) return sentence(happened.label.if_none, "");
  return sentence(happened.label.if_any, fmt::format("{:.0f} of {:.0f}", times, taps));
}

/// The mean over the taps that have any.
std::string share_line(const EnsembleSeries& share) {
  double taps = 0, sum = 0;
  for (std::size_t tap = 0; tap < share.count.size(); ++tap) {
    if (!(share.mean[tap] > 0)) continue;
    ++taps;
    sum += share.mean[tap];
  }
  if (taps == 0) return sentence(share.label.if_none, "");
  return sentence(share.label.if_any, fmt::format("{:.1f} %", 100 * sum / taps));
}

std::string sentences(const PointSeries& series) {
  std::string lines;
  for (const EnsembleSeries& column : series.columns) {
    if (column.label.shown == Shown::count) lines += count_line(column, series);
    if (column.label.shown == Shown::share) lines += share_line(column);
  }
  return lines;
}

/// A bed that is tapped again before it has come back grows without end.
std::string growth_line(const PointSeries& series) {
  constexpr double most_growth = 10;  // the papers' beds change by a tenth
  const auto height = std::ranges::find(series.columns, "mean_height",
                                        [](const EnsembleSeries& one) { return one.label.name; });
  if (height == series.columns.end()) return "";
  const double first = height->mean[0], last = height->mean[series.reached.size() - 1];
  if (!(last > most_growth * first)) return "";
  return fmt::format(
      "<Z> has grown from {:.3g} d to {:.3g} d: these taps lift the bed further than it comes down "
      "before the next; tap less strongly, or stop relaxing later\n",
      first, last);
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

std::string cost_line(const PointCost& cost, const std::string& unit) {
  std::string line = fmt::format("{} done", cost.done);
  if (cost.unfinished > 0) line += fmt::format(", {} unfinished", cost.unfinished);
  line += fmt::format(", {} failed; {} {} in {} of one core", cost.failed,
                      format_count(static_cast<double>(cost.work.effort.units)), unit,
                      format_duration(Seconds(cost.work.seconds)));
  if (cost.work.seconds > 0) {
    line += fmt::format(
        ", {} {}/s a core",
        format_count(static_cast<double>(cost.work.effort.units) / cost.work.seconds), unit);
  }
  return line + "\n";
}

std::string failure_line(const RealizationSummary& failed, const StudyPoint& point) {
  return fmt::format("realization {} failed (seed {}): {}\n", failed.id.realization, point.seed,
                     failed.reason);
}

std::string point_report(const ResultsFile& file, std::uint32_t point,
                         std::span<const RealizationSummary> realizations) {
  const StudyPoint& study = file.study().points[point];
  PointCost cost;
  std::string failures;
  for (const auto& one : realizations) {
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
  const PointSeries series = point_series(file, point, realizations);
  if (!series.reached.empty()) {
    text += tap_table(series) + sentences(series) + growth_line(series) + fitting_line(file, point);
  }
  return text + cost_line(cost, study.unit) + failures;
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
  const std::vector<RealizationSummary> all = file.realizations();
  const std::size_t a_point = file.study().realizations;
  std::string text;
  for (std::uint32_t point = 0; point < file.study().points.size(); ++point) {
    if (!text.empty()) text += '\n';
    text += point_report(file, point, std::span(all).subspan(point * a_point, a_point));
  }
  return text;
}

}  // namespace jostle::inline cli
