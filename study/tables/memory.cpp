#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "config/grids.hpp"
#include "config/json/json_text.hpp"
#include "ensemble/analysis/memory/memory.hpp"
#include "study/bad_input.hpp"
#include "study/tables/observable_series.hpp"
#include "study/tables/points/over_points.hpp"

namespace jostle::inline study {

namespace {

/// The taps of one point before and after its last stage begins.
struct Switch {
  std::uint32_t point = 0;
  Stage last{};
  Control earlier{};
  std::uint64_t tap = 0;  // the last before it
};

Switch switch_of(const PointScenes& scenes, std::uint32_t point) {
  const std::vector<Stage> protocol = stages(scenes.point_scene(point).protocol);
  if (protocol.size() < 2)
    throw BadInput(
        "needs protocols of at least two stages: ways of reaching a packing fraction, "
        "then a common one");
  Switch found{point, protocol.back(), control(protocol[protocol.size() - 2].tap), 0};
  for (std::size_t i = 0; i + 1 < protocol.size(); ++i) found.tap += protocol[i].count;
  return found;
}

/// Values of chosen realizations; `all` is in the order of those of the series.
std::vector<double> chosen(const ObservableSeries& series, const std::vector<double>& all,
                           const std::vector<std::uint32_t>& realizations) {
  std::vector<double> values;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::ranges::binary_search(realizations, series.realizations()[i]))
      values.push_back(all[i]);
  }
  return values;
}

std::vector<LagWindow> windows_within(const MemorySettings& settings, std::uint64_t last) {
  if (last < 1) throw BadInput("there is no tap after the switch");
  if (settings.lags.empty()) return lag_windows(last);
  if (settings.lags.front() < 1) throw BadInput("a lag is at least 1 tap");
  if (settings.lags.back() > last) {
    throw BadInput(
        fmt::format("lag {} is too late: the last possible is {}", settings.lags.back(), last));
  }
  return lag_windows(settings.lags);
}

Table table_of(const ResultsFile& file, const PointScenes& scenes,
               std::span<const std::uint32_t> points,
               const AnalysisRequest<MemorySettings>& request) {
  if (points.size() < 2)
    throw BadInput("needs two sweep points at least, each a history" +
                   of_chosen_points(file, points));
  std::vector<Switch> switches;
  std::vector<ObservableSeries> series;
  std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
  bool matched = true;
  std::vector<std::uint32_t> realizations;
  std::vector<std::string> left_out;
  PointNotes copies;
  for (const std::uint32_t point : points) {
    const Switch current = switch_of(scenes, point);
    if (!switches.empty() && !(current.last.tap == switches.front().last.tap))
      throw BadInput(
          "the last stage must tap alike at all points: it is what histories are "
          "compared under");
    if (!switches.empty() && current.earlier.name != switches.front().earlier.name)
      throw BadInput(fmt::format("the points tap in different ways before the switch ({}, {})",
                                 switches.front().earlier.name, current.earlier.name));
    const ObservableSeries here_all(file, point, request.observable);
    if (here_all.n_rows() <= current.tap + 1) {
      left_out.push_back(fmt::format("{}: {}", file.study().points[point].label,
                                     here_all.n_rows() == 0
                                         ? "no realization has taps"
                                         : "not all its realizations have reached the last stage"));
      continue;
    }
    copies.add(file.study().points[point].label, here_all.copies());
    const ObservableSeries& all = series.emplace_back(here_all);
    last = std::min({last, current.last.count, all.n_rows() - 1 - current.tap});
    matched = matched && scenes.point_scene(point).streams == Streams::matched;
    if (switches.empty()) realizations = all.realizations();
    std::erase_if(realizations, [&](std::uint32_t r) {
      return !std::ranges::binary_search(all.realizations(), r);
    });
    switches.push_back(current);
  }
  if (switches.size() < 2)
    throw BadInput("needs two sweep points at least; left out: " + joined(left_out, "; "));
  if (realizations.empty()) throw BadInput("there is no realization that all points have");
  std::vector<LagWindow> windows = windows_within(request.settings, last);
  std::vector<History> histories;
  for (std::size_t i = 0; i < switches.size(); ++i) {
    const std::uint64_t switch_tap = switches[i].tap;
    History history{switches[i].earlier.value,
                    switch_tap,
                    chosen(series[i], series[i].means({switch_tap, switch_tap + 1}), realizations),
                    {}};
    for (const LagWindow& window : windows) {
      const std::vector<double> means =
          series[i].means({switch_tap + window.first, switch_tap + window.last + 1});
      std::ranges::copy(chosen(series[i], means, realizations),
                        std::back_inserter(history.responses));
    }
    histories.push_back(std::move(history));
  }
  const Control& control_before = switches.front().earlier;
  Table table = memory_table("", series.front().label(), control_before.name, control_before.units,
                             histories, memory_test(histories, std::move(windows)));
  if (!left_out.empty()) table.notes.emplace_back("left_out", joined(left_out, "; "));
  copies.note("copies", table);
  table.notes.emplace_back("streams", matched ? "matched" : "independent");
  return table;
}

}  // namespace

std::vector<Table> memory_tables(const ResultsFile& file, const PointScenes& scenes,
                                 std::span<const std::uint32_t> points,
                                 std::span<const AnalysisRequest<MemorySettings>> requests) {
  std::vector<Table> tables;
  for (const auto& request : requests) {
    Table table;
    try {
      table = table_of(file, scenes, points, request);
    } catch (const BadArgument&) {
      throw;
    } catch (const BadInput& refusal) {
      table.notes = {{"refused", refusal.what()}};
    }
    table.name = "memory/" + request.observable;
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace jostle::inline study
