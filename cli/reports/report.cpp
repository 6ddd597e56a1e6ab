#include "cli/reports/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "cli/reports/tap_table.hpp"
#include "cli/tables/durations.hpp"
#include "cli/tables/wrapped.hpp"
#include "ensemble/moments.hpp"
#include "ensemble/statistics/counted.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "fitting/value_text.hpp"
#include "study/amounts.hpp"
#include "study/drawing/drawn/thinning.hpp"
#include "study/tables/points/half_widths.hpp"

namespace jostle::inline cli {
namespace {

std::string sentence(std::string text, const std::string& number) {
  const auto place = text.find("{}");
  if (place != std::string::npos) text.replace(place, 2, number);
  return text.empty() ? text : text + "\n";
}

/// How often it happened, of the taps at which the engine did any work, the first column that it
/// shows: a start that is not relaxed has none.
std::string count_line(const EnsembleSeries& happened, const PointSeries& series) {
  const auto work = std::ranges::find(
      series.columns, Shown::mean,
      [](const EnsembleSeries& ensemble_series) { return ensemble_series.label.shown; });
  double taps = 0, times = 0;
  for (std::size_t tap = 0; tap < happened.count.size(); ++tap) {
    if (work != series.columns.end() && !(work->mean[tap] > 0)) continue;
    taps += happened.count[tap];
    times += happened.mean[tap] * happened.count[tap];
  }
  if (times < 0.5) return sentence(happened.label.if_none, "");
  return sentence(happened.label.if_any, finite_text("{:.0f} of {:.0f}", times, taps));
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
  return sentence(share.label.if_any, finite_text("{:.1f} %", 100 * sum / taps));
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
  const auto height = std::ranges::find(
      series.columns, "mean_height",
      [](const EnsembleSeries& ensemble_series) { return ensemble_series.label.name; });
  if (height == series.columns.end()) return "";
  const double first = height->mean[0], last = height->mean[series.reached.size() - 1];
  if (!(last > most_growth * first)) return "";
  return finite_text(
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
  const auto change = [](double old_value, double new_value) -> std::string {
    return std::isfinite(old_value) && std::isfinite(new_value)
               ? finite_text("{:.4f} -> {:.4f}", old_value, new_value)
               : "not known, the bed is too shallow for it";
  };
  return finite_text(
      "fitting between the walls moved {:.0f} of {} spheres, up by {:.2f} d on average: "
      "corrected fraction {}, away from the walls {}\n",
      mean.spheres_moved, file.study().points[point].n_spheres, mean.mean_rise,
      change(mean.corrected_fraction_before, mean.corrected_fraction_after),
      change(mean.central_fraction_before, mean.central_fraction_after));
}

/// Realizations of one point by how they ended, and what they cost.
struct PointCost {
  std::uint64_t done = 0, unfinished = 0, missing = 0, failed = 0;
  Work work;

  std::uint64_t all() const { return done + unfinished + missing + failed; }
};

std::string cost_line(const PointCost& cost, const std::string& unit) {
  std::string line = fmt::format("{} done", cost.done);
  if (cost.unfinished > 0) line += fmt::format(", {} unfinished", cost.unfinished);
  if (cost.missing > 0) line += fmt::format(", {} missing", cost.missing);
  line += fmt::format(", {} failed", cost.failed);
  if (!(cost.work.seconds > 0)) return line + "; no cost is recorded yet\n";
  line += fmt::format("; {} {} in {} of one core",
                      format_count(static_cast<double>(cost.work.effort.units)), unit,
                      format_duration(Seconds(cost.work.seconds)));
  line += fmt::format(", {} {}/s per core",
                      format_count(static_cast<double>(cost.work.effort.units) / cost.work.seconds),
                      unit);
  return line + "\n";
}

std::string failure_line(const RealizationSummary& failed, const StudyPoint& point) {
  return fmt::format("realization {} failed (seed {}): {}\n", failed.id.realization, point.seed,
                     failed.reason);
}

constexpr std::size_t most_failures = 20;  // listed one by one
constexpr std::size_t most_points = 40;    // whose curves are shown, and those with failures

std::string further_failures(std::size_t n) {
  return n <= most_failures ? ""
                            : fmt::format("and {} more failed: jostle info --json lists them\n",
                                          n - most_failures);
}

std::string failures_of(const StudyPoint& point, std::span<const RealizationSummary> realizations) {
  std::string lines;
  std::size_t n = 0;
  for (const auto& realization : realizations) {
    if (realization.status == RealizationStatus::failed && ++n <= most_failures)
      lines += failure_line(realization, point);
  }
  return lines + further_failures(n);
}

PointCost cost_of(const ResultsFile& file, std::span<const RealizationSummary> realizations) {
  PointCost cost;
  for (const auto& realization : realizations) {
    cost.work += realization.work;
    if (realization.status == RealizationStatus::done) {
      ++cost.done;
    } else if (realization.status == RealizationStatus::failed) {
      ++cost.failed;
    } else if (in_share(file.shard(), file.study(), realization.id)) {
      ++(realization.status == RealizationStatus::missing ? cost.missing : cost.unfinished);
    }
  }
  return cost;
}

/// The report of a sweep point in parts: points that agree have one sentence.
struct PointReport {
  std::string table, sentence, rest;
};

PointReport point_report(const ResultsFile& file, std::uint32_t point,
                         std::span<const RealizationSummary> realizations, const Layout& layout) {
  const StudyPoint& study = file.study().points[point];
  const PointSeries series = point_series(file, point, realizations);
  PointReport report;
  report.table = study.label.empty() ? "" : wrapped(study.label + "\n", layout.width);
  std::string rest;
  if (!series.reached.empty()) {
    report.table += tap_table(series, layout);
    if (!series.copies.empty()) report.table += wrapped(series.copies + ".\n", layout.width);
    report.sentence = wrapped(sentences(series), layout.width);
    rest = growth_line(series) + fitting_line(file, point);
  }
  rest += cost_line(cost_of(file, realizations), study.unit) + failures_of(study, realizations);
  report.rest = wrapped(rest, layout.width);
  return report;
}

/// Reports one after another, with the sentence once where it is the same for all.
std::string text_of(std::span<const PointReport> reports, const Layout& layout) {
  const bool agree = reports.size() > 1 && std::ranges::all_of(reports, [&](const auto& report) {
                       return report.sentence == reports.front().sentence;
                     });
  std::string text;
  for (const PointReport& report : reports) {
    if (&report != reports.data()) text += '\n';
    text += report.table + (agree ? "" : report.sentence) + report.rest;
  }
  if (!agree || reports.front().sentence.empty()) return text;
  return text + wrapped("\nat every sweep point: " + reports.front().sentence, layout.width);
}

/// The first packing fraction, else the first column; null without columns.
const EnsembleSeries* described_column(const PointSeries& series) {
  const auto named = [](const EnsembleSeries& ensemble_series) {
    return ensemble_series.label.shown == Shown::spread &&
           ensemble_series.label.name.ends_with("fraction");
  };
  auto shown = std::ranges::find_if(series.columns, named);
  if (shown == series.columns.end()) shown = series.columns.begin();
  return shown == series.columns.end() ? nullptr : &*shown;
}

/// "; bottom_fraction after tap 100: 0.586(2) at epsilon = 0.01, 0.594(2) at epsilon = 0.02" of a
/// few sweep points that reached one last tap.
std::string comparison_of(const ResultsFile& file,
                          std::span<const RealizationSummary> realizations) {
  constexpr std::size_t most_compared = 8;
  const std::vector<StudyPoint>& points = file.study().points;
  if (points.size() > most_compared) return "";
  const std::size_t a_point = file.study().realizations;
  std::string name, text;
  std::size_t last = 0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const PointSeries series = point_series(file, static_cast<std::uint32_t>(p),
                                            realizations.subspan(p * a_point, a_point));
    const EnsembleSeries* column = series.reached.empty() ? nullptr : described_column(series);
    if (column == nullptr || points[p].label.empty()) return "";
    if (p == 0) {
      name = column->label.name;
      last = series.reached.size() - 1;
    }
    if (column->label.name != name || series.reached.size() != last + 1) return "";
    text +=
        fmt::format("{}{} at {}", p == 0 ? "" : ", ", mean_text(*column, last), points[p].label);
  }
  return fmt::format("; {} after tap {}: {}", name, last, text);
}

/// "bottom_fraction 0.5413(20) at tap 0, 0.5591(13) at tap 100".
std::string change_of(const PointSeries& series) {
  if (series.reached.empty()) return "";
  const EnsembleSeries* const shown = described_column(series);
  if (shown == nullptr) return "";
  const std::size_t last = series.reached.size() - 1;
  const bool as_many = shown->count[0] == shown->count[last];
  const auto mean_at = [&](std::size_t tap) {
    return fmt::format("{} at tap {}{}", mean_text(*shown, tap), tap,
                       as_many ? "" : fmt::format(" (M = {})", shown->count[tap]));
  };
  std::string text = fmt::format("; {} {}", shown->label.name, mean_at(0));
  return last == 0 ? text : text + ", " + mean_at(last);
}

std::string verdict_line(const ResultsFile& file,
                         std::span<const RealizationSummary> realizations) {
  const PointCost cost = cost_of(file, realizations);
  std::string text = fmt::format("{} of {} done", cost.done, counted(cost.all(), "realization"));
  const std::size_t n_points = file.study().points.size();
  if (n_points > 1) text += fmt::format(" at {} sweep points", n_points);
  if (cost.failed > 0) text += fmt::format(", {} FAILED", cost.failed);
  if (cost.unfinished > 0) text += fmt::format(", {} unfinished", cost.unfinished);
  if (cost.missing > 0) text += fmt::format(", {} missing", cost.missing);
  text += n_points == 1 ? change_of(point_series(file, 0, realizations))
                        : comparison_of(file, realizations);
  return text + "\n\n";
}

/// Points whose curves are shown: of long sweeps some, the first with failures among them.
std::vector<std::size_t> shown_points(std::span<const RealizationSummary> realizations,
                                      std::size_t a_point, const Layout& layout) {
  const std::size_t n_points = realizations.size() / a_point;
  if (layout.columns == Columns::all) return evenly_spread(n_points, n_points);
  std::vector<std::size_t> with_failures;
  for (std::size_t i = 0; i < realizations.size() && with_failures.size() < most_failures; ++i) {
    const std::size_t point = i / a_point;
    const bool is_known = !with_failures.empty() && with_failures.back() == point;
    if (realizations[i].status == RealizationStatus::failed && !is_known)
      with_failures.push_back(point);
  }
  return joined(evenly_spread(n_points, most_points), with_failures);
}

/// How numbers are written, and what is not shown.
std::string legend(const Layout& layout) {
  std::string text =
      "a(b): mean over realizations; b, in the last digits of a, is half the 68 % interval";
  return text + (layout.columns == Columns::all ? "; sigma: deviation of realizations, 1/M\n"
                                                : "; --wide: sigma and all columns\n");
}

}  // namespace

std::string failure_lines(const ResultsFile& file) {
  std::string lines;
  std::size_t n = 0;
  for (const RealizationSummary& realization : file.realizations()) {
    if (realization.status != RealizationStatus::failed || ++n > most_failures) continue;
    if (file.study().points.size() > 1)
      lines += fmt::format("sweep point {}, ", realization.id.point);
    lines += failure_line(realization, file.study().points[realization.id.point]);
  }
  return lines + further_failures(n);
}

std::string report(const ResultsFile& file, const Layout& layout) {
  const std::vector<RealizationSummary> all = file.realizations();
  const std::size_t a_point = file.study().realizations;
  std::string text = wrapped(verdict_line(file, all), layout.width);
  const std::vector<std::size_t> shown = shown_points(all, a_point, layout);
  if (const std::size_t n = file.study().points.size(); shown.size() < n) {
    const std::size_t even = std::min(n, most_points);
    text +=
        wrapped(fmt::format("{} of {} sweep points, evenly spread{}; --wide shows all\n\n", even, n,
                            shown.size() > even
                                ? fmt::format(", and {} more with failures", shown.size() - even)
                                : ""),
                layout.width);
  }
  std::vector<PointReport> reports;
  for (const std::size_t point : shown) {
    reports.push_back(point_report(file, static_cast<std::uint32_t>(point),
                                   std::span(all).subspan(point * a_point, a_point), layout));
  }
  return text + text_of(reports, layout) + wrapped(legend(layout), layout.width);
}

}  // namespace jostle::inline cli
