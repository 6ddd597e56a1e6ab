#include "study/tables/points/ordering.hpp"

#include <fmt/format.h>

#include <limits>

#include "config/json/json_text.hpp"
#include "study/bad_input.hpp"
#include "study/tables/analyse.hpp"
#include "study/tables/points/over_points.hpp"

namespace jostle::inline study {

namespace {

void set_last_values(const ObservableSeries& series, const OrderingSettings& settings,
                     std::uint64_t rows, std::size_t n_realizations, OrderingPoint& point,
                     ComparedValue& value) {
  const AnalysedSeries last = last_taps(series, settings.last, 4, 1, rows);
  const TapRange range{last.first_tap, last.last_tap + 1};
  value.units = last.units;
  const std::string taps = fmt::format("{} to {}", last.first_tap, last.last_tap);
  const bool is_known = (", " + value.taps + ",").find(", " + taps + ",") != std::string::npos;
  if (!is_known)  // several, where protocols differ in length
    value.taps.append(value.taps.empty() ? "" : ", ").append(taps);
  point.last_values.assign(n_realizations, std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> means = series.means(range);
  for (std::size_t i = 0; i < means.size(); ++i) {
    point.last_values[series.realizations()[i]] = means[i];
  }
  point.steady = steadiness(series, last);
}

}  // namespace

OrderingAnalysis ordering_of(const ObservableSeries& series, const OrderingSettings& settings) {
  if (series.n_rows() < settings.hold) {
    throw BadInput(fmt::format("{} values cannot show one held for {} taps: take a smaller hold",
                               series.n_rows(), settings.hold));
  }
  OrderingAnalysis analysis({.observable = series.label().name,
                             .units = series.label().units,
                             .first_tap = 0,
                             .last_tap = series.n_rows() - 1},
                            settings);
  std::size_t next = 0;
  series.for_each({0, series.n_rows()}, [&](std::span<const double> values) {
    analysis.add(series.realizations()[next++], values);
  });
  return analysis;
}

void require_equilibrium(const ResultsFile& file, std::span<const std::uint32_t> points,
                         const OrderingSettings& settings) {
  if (settings.equilibrium.empty()) return;
  try {
    for (const std::uint32_t point : points) ObservableSeries(file, point, settings.equilibrium);
  } catch (const BadArgument& fault) {
    throw BadArgument(Argument::equilibrium, fault.value(), fault.reason(), fault.remedy());
  }
}

Table ordering_over_points(const ResultsFile& file, std::span<const std::uint32_t> points,
                           const AnalysisRequest<OrderingSettings>& request, Streams streams) {
  const auto& [observable, settings] = request;
  const std::size_t n = file.study().realizations;
  ComparedValue value{settings.equilibrium.empty() ? observable : settings.equilibrium, "", ""};
  std::vector<OrderingPoint> compared;
  std::vector<ReachedTaps> reached;
  for (const std::uint32_t point : points) {
    const ObservableSeries series(file, point, observable);
    reached.push_back({file.study().points[point].taps, series.n_rows()});
  }
  const SharedTaps shared = shared_taps(reached);
  std::vector<std::string> left_out;
  PointNotes copies;
  try {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::uint32_t number = points[i];
      const std::string& label = file.study().points[number].label;
      if (!shared.reasons[i].empty()) {
        left_out.push_back(label + ": " + shared.reasons[i]);
        continue;
      }
      const ObservableSeries series(file, number, observable);
      copies.add(label, series.copies());
      OrderingPoint point{.label = label, .times = ordering_of(series, settings).times(n)};
      set_last_values(ObservableSeries(file, number, value.observable), settings, shared.rows[i], n,
                      point, value);
      compared.push_back(std::move(point));
    }
    if (compared.size() < 2)
      throw BadInput("needs two sweep points at least; left out: " + joined(left_out, "; "));
    Table table = ordering_comparison(observable, settings, value, compared, streams);
    if (!left_out.empty()) table.notes.emplace_back("left_out", joined(left_out, "; "));
    copies.note("copies", table);
    return table;
  } catch (const BadInput& refusal) {
    return {.name = "ordering/" + observable, .notes = {{"refused", refusal.what()}}};
  }
}

}  // namespace jostle::inline study
