#include "study/tables/fit_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/tables/observable_series.hpp"

namespace jostle::inline study {

namespace {

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
  source.units = {series.label().units, "taps"};
  source.curve = collect(series, range);
  if (const double end = std::min(range.last, static_cast<double>(series.n_rows()) - 1);
      !source.curve.t.empty() && source.curve.t.back() < std::floor(end)) {
    source.notes.push_back(
        fmt::format("The curve ends at tap {}: {} has no finite value at the next.",
                    source.curve.t.back(), observable));
  }
  if (!source.curve.t.empty()) {
    source.title += fmt::format(", {} realization{}", series.n_realizations(),
                                series.n_realizations() == 1 ? "" : "s");
  }
  if (const std::string copies = series.copies(); !copies.empty()) {
    source.notes.push_back(copies + ".");
  }
  return source;
}

}  // namespace

std::vector<FitSource> results_curves(const ResultsFile& file,
                                      std::span<const std::uint32_t> points,
                                      const std::string& observable, const FitRange& range) {
  std::vector<FitSource> sources;
  for (const std::uint32_t point : points) {
    sources.push_back(point_curve(file, point, observable, range));
  }
  return sources;
}

}  // namespace jostle::inline study
