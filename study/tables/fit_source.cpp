#include "study/tables/fit_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "cli/terminal/results_input.hpp"
#include "results/results_file.hpp"
#include "study/observable_series.hpp"
#include "study/scene_file.hpp"

namespace jostle {

namespace {

double read_end(const std::string& text, double otherwise, const std::string& option,
                const std::string& range) {
  if (text.empty()) return otherwise;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || std::isnan(value)) {
    throw BadInput(
        fmt::format("{} {}: not FIRST:LAST, two numbers of which one may be left "
                    "out",
                    option, range));
  }
  return value;
}

// Taps of the range that all realizations have reached, up to the first without a finite value.
Curve collect(const ObservableSeries& series, const FitRange& range) {
  const std::uint32_t n = series.n_realizations();
  const double rows = static_cast<double>(series.n_rows());
  const auto first = static_cast<std::uint64_t>(std::clamp(std::ceil(range.first), 0.0, rows));
  const auto end = static_cast<std::uint64_t>(std::clamp(std::floor(range.last) + 1, 0.0, rows));
  if (first >= end || n == 0) return {.t = {}, .x = {}};
  std::vector<double> values = series.values({first, end});
  const auto finite = [](double value) { return std::isfinite(value); };
  const auto broken = std::ranges::find_if_not(values, finite) - values.begin();
  const std::uint64_t taps = static_cast<std::uint64_t>(broken) / n;
  values.resize(taps * n);
  std::vector<double> t;
  for (std::uint64_t i = 0; i < taps; ++i) t.push_back(static_cast<double>(first + i));
  return mean_curve(std::move(t), std::move(values), n);
}

FitSource point_curve(const ResultsFile& file, std::uint32_t point, const std::string& observable,
                      const FitRange& range) {
  const ObservableSeries series(file, point, observable);
  FitSource source;
  source.point = point;
  source.observable = observable;
  source.label = file.study().points[point].label;
  source.title = fmt::format("{} {}sweep point {}", observable,
                             source.label.empty() ? "" : source.label + ", ", point);
  source.curve = collect(series, range);
  if (!source.curve.t.empty()) {
    source.title += fmt::format(", {} realization{}", series.n_realizations(),
                                series.n_realizations() == 1 ? "" : "s");
  }
  return source;
}

}  // namespace

FitRange read_range(const std::string& option, const std::string& text) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const auto colon = text.find(':');
  const std::string first = text.substr(0, colon);
  const std::string last = colon == std::string::npos ? "?" : text.substr(colon + 1);
  const FitRange range{read_end(first, -infinite, option, text),
                       read_end(last, infinite, option, text)};
  if (range.first <= range.last) return range;
  throw BadInput(fmt::format("{} {}: FIRST:LAST, and no number is so", option, text));
}

std::vector<FitSource> results_curves(const std::string& path, const std::string& observable,
                                      const std::string& point, const FitRange& range, Live live) {
  const ResultsFile file = open_results(path, live);
  std::vector<FitSource> sources;
  for (const std::uint32_t chosen : chosen_points(file.study(), point)) {
    sources.push_back(point_curve(file, chosen, observable, range));
  }
  return sources;
}

}  // namespace jostle
