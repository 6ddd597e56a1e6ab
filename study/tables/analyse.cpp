#include "study/tables/analyse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>

#include "config/grids.hpp"
#include "ensemble/analysis/ageing/ageing_table.hpp"
#include "ensemble/analysis/hysteresis.hpp"
#include "results/groups/layout.hpp"
#include "study/bad_input.hpp"
#include "study/tables/points/ordering.hpp"
#include "study/tables/points/over_points.hpp"
#include "study/tables/points/point_scenes.hpp"

namespace jostle::inline study {

namespace {

/// Where an analysis finds what is not in its series.
struct AnalysisContext {
  const ResultsFile& file;
  std::uint32_t point;
  int threads;
  const std::function<const PointScenes&()>& scenes;  // read when first asked for
};

/// Adds the note on taps of several strengths, where there are some.
Table with_strengths(Table table, const AnalysedSeries& taps, const AnalysisContext& context) {
  std::string note = several_strengths(context.scenes().point_scene(context.point), taps);
  if (!note.empty()) table.notes.emplace_back("strengths", std::move(note));
  return table;
}

Table make_table(const ObservableSeries& series, const SteadySettings& settings,
                 const AnalysisContext& context) {
  const AnalysedSeries analysed = last_taps(series, settings.last, 4, SteadyStateTest::fewest_taps);
  SteadyStateTest test;
  series.for_each({analysed.first_tap, analysed.last_tap + 1},
                  [&](std::span<const double> values) { test.add(values); });
  return with_strengths(steady_table(analysed, test.result()), analysed, context);
}

Table make_table(const ObservableSeries& series, const SpectrumSettings& settings,
                 const AnalysisContext& context) {
  const AnalysedSeries analysed = last_taps(series, settings.last, 2, fewest_spectrum_taps);
  if (settings.segment && *settings.segment > analysed.n_taps()) {
    throw BadInput(fmt::format("a segment of {} taps is longer than the {} analysed",
                               *settings.segment, analysed.n_taps()));
  }
  SpectrumAnalysis analysis(analysed, settings);
  series.for_each({analysed.first_tap, analysed.last_tap + 1},
                  [&](std::span<const double> values) { analysis.add(values); });
  return with_strengths(analysis.table(), analysed, context);
}

/// A lag of a tap follows the last waiting time.
void require_reached(const char* subject, std::span<const std::uint64_t> taps, std::uint64_t last) {
  const auto beyond = std::ranges::find_if(taps, [&](std::uint64_t tap) { return tap > last; });
  if (beyond == taps.end()) return;
  throw BadInput(fmt::format("{} {} is too late: the last possible is {}", subject, *beyond, last));
}

Table make_table(const ObservableSeries& series, const AgeingSettings& settings,
                 const AnalysisContext& context) {
  if (series.n_rows() < 3) throw BadInput("needs two taps");
  require_reached("waiting time", settings.waiting_times, series.n_rows() - 2);
  require_reached("lag", settings.lags, series.n_rows() - 1);
  AgeingGrid grid = ageing_grid(series.n_rows());
  if (!settings.waiting_times.empty()) grid.waiting_times = settings.waiting_times;
  if (!settings.lags.empty()) grid.lags = settings.lags;
  TapRows rows{.taps = taps_of(grid), .realizations = series.n_realizations(), .values = {}};
  std::erase_if(rows.taps, [&](std::uint64_t tap) { return tap >= series.n_rows(); });
  rows.values = series.rows(rows.taps);
  return ageing_table("", series.label(), rows, grid, context.threads);
}

Table make_table(const ObservableSeries& series, const HysteresisSettings& settings,
                 const AnalysisContext& context) {
  const std::vector<Stage> protocol = stages(context.scenes().point_scene(context.point).protocol);
  std::uint64_t shortest = std::numeric_limits<std::uint64_t>::max();
  for (const Stage& stage : protocol) shortest = std::min(shortest, stage.count);
  if (protocol.empty()) throw BadInput("the protocol has no taps");
  const std::uint64_t last = settings.last.value_or(std::max<std::uint64_t>(1, shortest / 4));
  const auto found = protocol_steps(protocol, last);
  if (const auto* refusal = std::get_if<std::string>(&found)) throw BadInput(*refusal);
  const auto& steps = std::get<ProtocolSteps>(found);
  std::vector<double> values;
  for (const StepTaps& window : steps.windows) {
    const std::vector<double> means = series.means({window.first, window.last + 1});
    values.insert(values.end(), means.begin(), means.end());
  }
  return hysteresis_table("", series.label(), steps, values, series.n_realizations());
}

Table make_table(const ObservableSeries& series, const OrderingSettings& settings,
                 const AnalysisContext&) {
  return ordering_of(series, settings).table();
}

template <class Settings>
void add_tables(const AnalysisContext& context, const char* kind,
                const std::vector<AnalysisRequest<Settings>>& requests,
                std::vector<Table>& tables) {
  for (const auto& request : requests) {
    const ResultsFile& file = context.file;
    const std::uint32_t point = context.point;
    const ObservableSeries series(file, point, request.observable);
    Table table;
    try {
      require_taps(file, point, series.n_realizations());
      table = make_table(series, request.settings, context);
    } catch (const BadInput& refusal) {
      table.notes = {{"refused", refusal.what()}};
    }
    if (const std::string copies = series.copies(); !copies.empty()) {
      table.notes.emplace_back("copies", copies);
    }
    table.name = fmt::format("{}/{}/{}", point_name(point), kind, request.observable);
    const std::string& label = file.study().points[point].label;
    if (!label.empty()) table.notes.insert(table.notes.begin(), {"sweep_point", label});
    tables.push_back(std::move(table));
  }
}

}  // namespace

std::vector<Table> analyse(const ResultsFile& file, std::span<const std::uint32_t> points,
                           const Analyses& analyses, int threads) {
  std::vector<Table> tables;
  std::optional<PointScenes> read;
  const std::function<const PointScenes&()> scenes = [&]() -> const PointScenes& {
    return read ? *read : read.emplace(file);
  };
  for (const auto& request : analyses.ordering) require_equilibrium(file, points, request.settings);
  for (const std::uint32_t point : points) {
    const AnalysisContext context{file, point, threads, scenes};
    add_tables(context, "steady", analyses.steady, tables);
    add_tables(context, "spectrum", analyses.spectrum, tables);
    add_tables(context, "ageing", analyses.ageing, tables);
    add_tables(context, "hysteresis", analyses.hysteresis, tables);
    add_tables(context, "ordering", analyses.ordering, tables);
  }
  if (points.size() > 1 && !analyses.ordering.empty()) {
    const Scene& scene = scenes().scene();
    for (const auto& request : analyses.ordering) {
      tables.push_back(ordering_over_points(file, points, request, scene.streams));
    }
  }
  if (!analyses.volumes.empty())
    std::ranges::move(volume_tables(file, scenes(), points, analyses.volumes),
                      std::back_inserter(tables));
  if (!analyses.memory.empty())
    std::ranges::move(memory_tables(file, scenes(), points, analyses.memory),
                      std::back_inserter(tables));
  return tables;
}

AnalysedSeries last_taps(const ObservableSeries& series, std::optional<std::uint64_t> n_taps,
                         std::uint64_t divisor, std::uint64_t least,
                         std::optional<std::uint64_t> rows) {
  const std::uint64_t n_rows = std::min(series.n_rows(), rows.value_or(series.n_rows()));
  const std::uint64_t available = n_rows == 0 ? 0 : n_rows - 1;
  const std::uint64_t wanted = n_taps.value_or(std::max(least, available / divisor));
  if (available < least) {
    throw BadInput(fmt::format("needs at least {} taps; there {} {}{}", least,
                               available == 1 ? "is" : "are", available, series.held_back()));
  }
  if (wanted < least) {
    throw BadInput(fmt::format("asks for the last {} taps; at least {} are needed", wanted, least));
  }
  if (wanted > available) {
    throw BadInput(fmt::format("asks for the last {} taps; there are {}{}", wanted, available,
                               series.held_back()));
  }
  return {.observable = series.label().name,
          .units = series.label().units,
          .first_tap = available + 1 - wanted,
          .last_tap = available};
}

std::string several_strengths(const Scene& scene, const AnalysedSeries& taps) {
  const std::vector<Stage> protocol = stages(scene.protocol);
  std::uint64_t first = 1, next = 1;  // tap of the last strength; of the stage
  for (std::size_t i = 0; i < protocol.size() && next <= taps.last_tap; ++i) {
    if (i > 0 && !(protocol[i].tap == protocol[i - 1].tap)) first = next;
    next += protocol[i].count;
  }
  if (taps.first_tap >= first) return "";
  return fmt::format(
      "taps {} to {} have other strengths than taps {} to {}: for one strength set last to {} or "
      "less",
      taps.first_tap, first - 1, first, taps.last_tap, taps.last_tap + 1 - first);
}

std::optional<Verdict> steadiness(const ObservableSeries& series, const AnalysedSeries& taps) {
  if (taps.n_taps() < SteadyStateTest::fewest_taps) return std::nullopt;
  SteadyStateTest test;
  series.for_each({taps.first_tap, taps.last_tap + 1},
                  [&](std::span<const double> values) { test.add(values); });
  return test.result().verdict();
}

}  // namespace jostle::inline study
