#include "cli/analyse_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "cli/observable_series.hpp"
#include "cli/provenance.hpp"
#include "cli/scene_file.hpp"
#include "cli/table_output.hpp"
#include "results/layout.hpp"
#include "results/tables.hpp"

namespace jostle {

namespace {

/// The last taps, without the start.
AnalysedSeries last_taps(const ObservableSeries& series, std::uint64_t n_taps,
                         std::uint64_t least) {
  const std::uint64_t available = series.n_rows() == 0 ? 0 : series.n_rows() - 1;
  if (n_taps > available || n_taps < least) {
    throw BadInput(fmt::format("asks for the last {} taps, at least {}; there are {}",
                               std::max(n_taps, least), least, available));
  }
  return {.observable = series.label().name,
          .units = series.label().units,
          .first_tap = available + 1 - n_taps,
          .last_tap = available};
}

std::uint64_t part_of(const ObservableSeries& series, std::uint64_t divisor, std::uint64_t least) {
  const std::uint64_t available = series.n_rows() == 0 ? 0 : series.n_rows() - 1;
  return std::max(least, available / divisor);
}

Table made(const ObservableSeries& series, const SteadySettings& settings) {
  const std::uint64_t least = SteadyStateTest::fewest_taps;
  const AnalysedSeries analysed =
      last_taps(series, settings.last.value_or(part_of(series, 4, least)), least);
  SteadyStateTest test;
  series.for_each({analysed.first_tap, analysed.last_tap + 1},
                  [&](std::span<const double> values) { test.add(values); });
  return steady_table(analysed, test.result());
}

Table made(const ObservableSeries& series, const SpectrumSettings& settings) {
  const std::uint64_t least = fewest_spectrum_taps;
  const AnalysedSeries analysed =
      last_taps(series, settings.last.value_or(part_of(series, 2, least)), least);
  if (settings.segment && *settings.segment > analysed.n_taps()) {
    throw BadInput(fmt::format("a segment of {} taps is longer than the {} analysed",
                               *settings.segment, analysed.n_taps()));
  }
  SpectrumAnalysis analysis(analysed, settings);
  series.for_each({analysed.first_tap, analysed.last_tap + 1},
                  [&](std::span<const double> values) { analysis.add(values); });
  return analysis.table();
}

template <class Settings>
void add_tables(const ResultsFile& file, std::uint32_t point, const char* kind,
                const std::vector<AnalysisRequest<Settings>>& requests,
                std::vector<Table>& tables) {
  for (const auto& request : requests) {
    const ObservableSeries series(file, point, request.observable);
    Table table;
    try {
      if (series.n_realizations() == 0) throw BadInput("there is no realization with taps");
      table = made(series, request.settings);
    } catch (const BadInput& refusal) {
      table.notes = {{"refused", refusal.what()}};
    }
    table.name = fmt::format("{}/{}/{}", point_name(point), kind, request.observable);
    const std::string& label = file.study().points[point].label;
    if (!label.empty()) table.notes.insert(table.notes.begin(), {"sweep_point", label});
    tables.push_back(std::move(table));
  }
}

}  // namespace

std::vector<Table> analyse(const ResultsFile& file, std::span<const std::uint32_t> points,
                           const Analyses& analyses) {
  std::vector<Table> tables;
  for (const std::uint32_t point : points) {
    add_tables(file, point, "steady", analyses.steady, tables);
    add_tables(file, point, "spectrum", analyses.spectrum, tables);
  }
  return tables;
}

bool is_made(const Table& table) {
  return std::ranges::none_of(table.notes,
                              [](const auto& note) { return note.first == "refused"; });
}

void make_scene_analyses(const std::string& results, int threads, bool quiet) {
  std::vector<Table> tables;
  {
    const ResultsFile file(results);
    const ParsedScene parsed = parse_scene(file.study().resolved_scene);
    if (!parsed.scene || parsed.scene->analyse.empty()) return;
    std::vector<std::uint32_t> points(file.study().points.size());
    for (std::uint32_t p = 0; p < points.size(); ++p) points[p] = p;
    tables = analyse(file, points, parsed.scene->analyse);
  }
  for (const Table& table : tables) {
    if (!quiet) fmt::print("\n{}", table_text(table, Detail::brief));
  }
  store_tables(results, "analysis", tables, provenance_of_this_run(fmt::to_string(threads)));
}

}  // namespace jostle
