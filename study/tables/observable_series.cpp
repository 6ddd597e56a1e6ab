#include "study/tables/observable_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/json/json_text.hpp"
#include "config/json/suggestion.hpp"
#include "engine/numbers.hpp"
#include "ensemble/fold.hpp"
#include "ensemble/moments.hpp"
#include "study/bad_input.hpp"
#include "study/tables/repeated_series.hpp"

namespace jostle::inline study {

namespace {

constexpr std::uint64_t piece_values = 128'000'000 / sizeof(double);

bool is_usable(const RealizationSummary& summary) {
  return summary.rows > 0 && (summary.status == RealizationStatus::done ||
                              summary.status == RealizationStatus::running);
}

/// "sweep points 1, 2"; empty where there is none.
std::string points_with(const ResultsFile& file, const std::string& observable) {
  std::vector<std::string> points;
  for (std::uint32_t point = 0; point < file.study().points.size(); ++point) {
    const auto labels = file.columns(point);
    if (std::ranges::find(labels, observable, &Column::name) != labels.end()) {
      points.push_back(fmt::to_string(point));
    }
  }
  if (points.empty()) return {};
  return (points.size() == 1 ? "sweep point " : "sweep points ") + joined(points, ", ");
}

Column label_named(const ResultsFile& file, std::uint32_t point, const std::string& observable) {
  const std::vector<Column> labels = file.columns(point);
  const auto found = std::ranges::find(labels, observable, &Column::name);
  if (found != labels.end()) return *found;
  std::vector<std::string> names;
  for (const Column& label : labels) names.push_back(label.name);
  const std::string other_points = points_with(file, observable);
  if (other_points.empty()) {
    throw BadArgument(Argument::observable, observable,
                      fmt::format("there is none; {} has {}.{}", file.path(), joined(names, ", "),
                                  did_you_mean(observable, names)));
  }
  throw BadArgument(Argument::observable, observable,
                    fmt::format("there is none at sweep point {}, which has {}. It is at {}", point,
                                joined(names, ", "), other_points),
                    Argument::sweep_point);
}

}  // namespace

ObservableSeries::ObservableSeries(const ResultsFile& file, std::uint32_t point,
                                   const std::string& observable)
    : file_(file), point_(point), label_(label_named(file, point, observable)) {
  for (const RealizationSummary& summary : file.realizations_at(point)) {
    if (!is_usable(summary)) continue;
    n_rows_ = used_.empty() ? summary.rows : std::min(n_rows_, summary.rows);
    used_.push_back(summary.id.realization);
    reached_.push_back(summary.rows);
  }
  leave_out_copies();
}

void ObservableSeries::leave_out_copies() {
  const std::vector<std::uint32_t> distinct =
      distinct_realizations(file_, point_, label_.name, used_, n_rows_);
  n_copies_ = used_.size() - distinct.size();
  if (n_copies_ == 0) return;
  std::vector<std::uint64_t> reached;
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (std::ranges::binary_search(distinct, used_[i])) reached.push_back(reached_[i]);
  }
  used_ = distinct;
  reached_ = std::move(reached);
}

std::string ObservableSeries::copies() const {
  return copies_text(n_copies_, used_.size());
}

Repetitions repetitions(const ResultsFile& file, std::uint32_t point) {
  const std::vector<Column> columns = file.columns(point);
  return columns.empty() ? Repetitions{} : repetitions(file, point, columns.front().name);
}

Repetitions repetitions(const ResultsFile& file, std::uint32_t point,
                        const std::string& observable) {
  const ObservableSeries series(file, point, observable);
  Repetitions found{.text = series.copies(), .leave_one = series.realizations().size() == 1};
  if (found.text.empty()) return found;
  for (const RealizationSummary& summary : file.realizations_at(point)) {
    if (is_usable(summary) &&
        !std::ranges::binary_search(series.realizations(), summary.id.realization)) {
      found.realizations.push_back(summary.id.realization);
    }
  }
  return found;
}

std::vector<EnsembleSeries> distinct_ensemble(const ResultsFile& file, std::uint32_t point,
                                              const Repetitions& copies) {
  std::vector<EnsembleSeries> all = file.ensemble(point);
  if (copies.realizations.empty()) return all;
  const std::uint32_t m = file.study().realizations;
  const std::uint64_t n_rows = file.n_stored_rows(point);
  for (EnsembleSeries& series : all) {
    std::vector<double> values = file.block(point, series.label.name, {0, n_rows}, {0, m});
    for (const std::uint32_t copy : copies.realizations)
      for (std::size_t i = copy; i < values.size(); i += m) values[i] = not_a_number;
    FoldedColumn folded = fold(values, m);
    series.mean = std::move(folded.mean);
    series.sigma = std::move(folded.sigma);
    series.error = std::move(folded.error);
    series.count = std::move(folded.count);
  }
  return all;
}

std::string ObservableSeries::held_back() const {
  if (used_.empty()) return {};
  const auto [least, most] = std::ranges::minmax_element(reached_);
  if (*least == *most) return {};
  return fmt::format("; realization {} has reached only tap {}, the farthest tap {}",
                     used_[static_cast<std::size_t>(least - reached_.begin())], *least - 1,
                     *most - 1);
}

void ObservableSeries::for_each(const TapRange& taps,
                                const std::function<void(std::span<const double>)>& take) const {
  for_each_of(used_, taps, take);
}

void ObservableSeries::for_each_of(const std::vector<std::uint32_t>& realizations,
                                   const TapRange& taps,
                                   const std::function<void(std::span<const double>)>& take) const {
  const std::uint64_t n_taps = taps.end - taps.first;
  if (n_taps == 0) return;
  const auto at_once = static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(piece_values / n_taps, 1, file_.study().realizations));
  std::vector<double> series(n_taps);
  auto next = realizations.begin();
  while (next != realizations.end()) {
    const RealizationRange range{*next, std::min(*next + at_once, file_.study().realizations)};
    const std::uint32_t width = range.end - range.first;
    const std::vector<double> block = file_.block(point_, label_.name, taps, range);
    for (; next != realizations.end() && *next < range.end; ++next) {
      for (std::uint64_t t = 0; t < n_taps; ++t) series[t] = block[t * width + *next - range.first];
      if (!std::ranges::all_of(series, [](double value) { return std::isfinite(value); })) {
        throw BadInput(
            fmt::format("{} is not a number at every tap from {} to {}: perhaps no sphere is "
                        "where it is measured",
                        label_.name, taps.first, taps.end - 1));
      }
      take(series);
    }
  }
}

std::vector<double> ObservableSeries::means(const TapRange& taps) const {
  std::vector<double> means(used_.size(), std::numeric_limits<double>::quiet_NaN());
  if (taps.first >= taps.end) return means;
  std::vector<std::uint32_t> available;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (reached_[i] < taps.end) continue;
    available.push_back(used_[i]);
    places.push_back(i);
  }
  auto place = places.begin();
  for_each_of(available, taps, [&](std::span<const double> values) {
    Moments moments;
    for (const double value : values) moments.add(value);
    means[*place++] = moments.mean();
  });
  return means;
}

std::vector<double> ObservableSeries::values(const TapRange& taps) const {
  const std::uint32_t width = file_.study().realizations;
  const std::uint64_t at_once = std::max<std::uint64_t>(1, piece_values / width);
  std::vector<double> values;
  values.reserve((taps.end - taps.first) * used_.size());
  for (std::uint64_t first = taps.first; first < taps.end; first += at_once) {
    const TapRange piece{first, std::min(first + at_once, taps.end)};
    const std::vector<double> block = file_.block(point_, label_.name, piece, {0, width});
    for (std::uint64_t row = 0; row < piece.end - piece.first; ++row) {
      for (const std::uint32_t r : used_) values.push_back(block[row * width + r]);
    }
  }
  return values;
}

std::vector<double> ObservableSeries::rows(std::span<const std::uint64_t> taps) const {
  std::vector<double> rows;
  rows.reserve(taps.size() * used_.size());
  for (const std::uint64_t tap : taps) {
    const std::vector<double> row = values({tap, tap + 1});
    rows.insert(rows.end(), row.begin(), row.end());
  }
  return rows;
}

}  // namespace jostle::inline study
