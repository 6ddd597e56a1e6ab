#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>

#include "ensemble/moments.hpp"
#include "fitting/fit.hpp"
#include "results/groups/layout.hpp"
#include "study/drawing/drawn/drawn_results.hpp"
#include "study/drawing/drawn/thinning.hpp"
#include "study/running/stored_scene.hpp"
#include "study/tables/points/half_widths.hpp"
#include "study/tables/repeated_series.hpp"

namespace jostle::inline study {
namespace {

template <class Value>
std::vector<Value> at_places(const std::vector<Value>& values,
                             const std::vector<std::size_t>& places) {
  std::vector<Value> chosen;
  for (const std::size_t place : places) chosen.push_back(values[place]);
  return chosen;
}

/// Numbers of taps of a curve that are drawn: per decade, and evenly.
struct CurveGrid {
  std::size_t per_decade, evenly;
  std::vector<std::size_t> taps(std::size_t n) const {
    return logarithmically_spread(n, per_decade, evenly);
  }
};
// From the finest on: the first that all sweep points have room with.
constexpr CurveGrid relaxing_grids[] = {{40, 2}, {20, 2}, {10, 2}, {5, 2}};
constexpr CurveGrid changing_grids[] = {{40, 400}, {20, 100}, {10, 40}, {5, 20}};

constexpr std::size_t arrays_of_a_column = 4;

// Single realizations are drawn beside the means of few curves, and read of no endless series.
constexpr std::size_t most_curves_with_realizations = 4, most_thin_lines = 5;
constexpr std::uint64_t most_rows_of_realizations = 200'000;

/// Realizations of a sweep point that have taps, without those that repeat an earlier one.
std::vector<std::uint32_t> distinct_with_taps(const ResultsFile& file, std::uint32_t point) {
  std::vector<std::uint32_t> available = realizations_with_taps(file, point);
  if (available.size() < 2) return available;
  const std::vector<std::uint32_t> copies = repetitions(file, point).realizations;
  std::erase_if(available, [&](std::uint32_t r) { return std::ranges::binary_search(copies, r); });
  return available;
}

/// Adds some distinct realizations of the observables; a point with one of them needs none.
void add_realizations(const ResultsFile& file, DrawnCurve& curve) {
  const std::uint64_t rows = file.n_stored_rows(curve.point);
  if (rows > most_rows_of_realizations) return;
  const std::vector<std::uint32_t> available = distinct_with_taps(file, curve.point);
  if (available.size() < 2) return;
  for (DrawnColumn& column : curve.columns) {
    if (!column.is_observable) continue;
    for (const std::uint32_t r : spread(available, most_thin_lines)) {
      const std::vector<double> values =
          file.block(curve.point, column.label.name, {0, rows}, {r, r + 1});
      column.realizations.push_back({r, at_places(values, curve.taps)});
    }
  }
}

std::size_t curve_values(const ResultsFile& file, std::uint32_t point, const CurveGrid& grid) {
  const std::size_t n_columns = file.study().points[point].n_columns();
  const std::size_t n_extremes = 2 * n_columns;  // at most, of taps
  return std::min<std::size_t>(grid.taps(file.n_stored_rows(point)).size() + n_extremes,
                               file.n_stored_rows(point)) *
         (1 + arrays_of_a_column * n_columns);
}

DrawnCurve drawn_curve(const ResultsFile& file, std::uint32_t point, const CurveGrid& grid) {
  DrawnCurve curve{point, grid.taps(file.n_stored_rows(point)), {}};
  const std::size_t n_observables = file.study().points[point].observables.size();
  const std::vector<EnsembleSeries> ensemble =
      distinct_ensemble(file, point, repetitions(file, point));
  for (const EnsembleSeries& series : ensemble) {
    curve.taps = joined(std::move(curve.taps), extremes_of(series.mean));
  }
  for (const EnsembleSeries& series : ensemble) {
    curve.columns.push_back({.label = series.label,
                             .is_observable = curve.columns.size() < n_observables,
                             .mean = at_places(series.mean, curve.taps),
                             .half_width = at_places(half_widths(series), curve.taps),
                             .sigma = at_places(series.sigma, curve.taps),
                             .count = at_places(series.count, curve.taps),
                             .realizations = {}});
  }
  return curve;
}

/// Numbers of the requested sweep points that have values.
std::vector<std::uint32_t> begun_points(const ResultsFile& file, const WantedPoints& wanted) {
  std::vector<std::uint32_t> begun;
  for (std::uint32_t p = 0; p < file.study().points.size(); ++p) {
    if (!wanted.empty() && std::ranges::find(wanted, p) == wanted.end()) continue;
    if (file.n_stored_rows(p) > 0) begun.push_back(p);
  }
  return begun;
}

constexpr std::size_t most_bins = 2000;  // per histogram; beyond it, neighbours are joined

/// Means over realizations of what snapshots keep beside positions.
class SnapshotMeans {
 public:
  void add(StoredRealization& realization, std::span<const std::uint64_t> histogram_taps) {
    for (const SnapshotOutline& outline : realization.snapshots()) {
      if (outline.coordination) coordination_[outline.tap].add(*outline.coordination);
      if (std::ranges::find(histogram_taps, outline.tap) == histogram_taps.end()) continue;
      const std::vector<double> histogram = realization.profile(outline.tap, kept_histogram);
      if (histogram.empty()) continue;
      Histogram& mean = heights_[outline.tap];
      mean.sums.resize(std::max(mean.sums.size(), histogram.size()));
      for (std::size_t i = 0; i < histogram.size(); ++i) mean.sums[i] += histogram[i];
      ++mean.n;
    }
  }

  DrawnSnapshots means(std::uint32_t point, double bin_width) const {
    DrawnSnapshots drawn;
    drawn.point = point;
    drawn.bin_width = bin_width;
    for (const auto& [tap, moments] : coordination_) {
      drawn.taps.push_back(tap);
      drawn.coordination.push_back(moments.mean());
      drawn.coordination_half_width.push_back(
          half_width(moments.standard_error(), static_cast<double>(moments.count()) - 1));
    }
    std::size_t longest = 0;
    for (const auto& [tap, mean] : heights_) longest = std::max(longest, mean.sums.size());
    const std::size_t joined_bins = std::max<std::size_t>(1, (longest + most_bins - 1) / most_bins);
    drawn.bin_width *= static_cast<double>(joined_bins);
    for (const auto& [tap, mean] : heights_) {
      std::vector<double> n((mean.sums.size() + joined_bins - 1) / joined_bins);
      for (std::size_t i = 0; i < mean.sums.size(); ++i)
        n[i / joined_bins] += mean.sums[i] / mean.n;
      drawn.heights.push_back({tap, std::move(n)});
    }
    return drawn;
  }
  bool empty() const { return coordination_.empty() && heights_.empty(); }

 private:
  struct Histogram {
    std::vector<double> sums;
    double n = 0;
  };
  std::map<std::uint64_t, Moments> coordination_;
  std::map<std::uint64_t, Histogram> heights_;
};

constexpr std::size_t most_snapshot_points = 24, most_snapshot_realizations = 64,
                      most_histograms = 6;

}  // namespace

std::vector<std::uint32_t> realizations_with_taps(const ResultsFile& file, std::uint32_t point) {
  std::vector<std::uint32_t> begun;
  for (const RealizationSummary& realization : file.realizations_at(point)) {
    if (realization.rows > 0 && realization.status != RealizationStatus::failed)
      begun.push_back(realization.id.realization);
  }
  return begun;
}

DrawnRoom DrawnRoom::of_one_in(std::size_t n_files) {
  const DrawnRoom all;
  const std::size_t n = std::max<std::size_t>(1, n_files);
  return {all.curve_values / n, all.table_values / n};
}

bool changes_strength(const ResultsFile& file) {
  const Json scene = stored_scene(file);
  const Json* const protocol = scene.find("protocol");
  if (protocol == nullptr || !protocol->is_array()) return false;
  return protocol->size() > 1 || std::ranges::any_of(protocol->elements(), [](const Json& stage) {
           return stage.contains("ramp");
         });
}

std::vector<DrawnCurve> drawn_curves(const ResultsFile& file, const DrawnRoom& all_room,
                                     const WantedPoints& wanted,
                                     std::vector<std::string>& left_out) {
  const std::size_t room = all_room.curve_values;
  const std::vector<std::uint32_t> begun = begun_points(file, wanted);
  std::vector<DrawnCurve> curves;
  if (begun.empty()) return curves;
  const CurveGrid* grid = nullptr;
  std::size_t needed = 0;
  const bool changing = changes_strength(file);
  for (const CurveGrid& taps_grid :
       changing ? std::span(changing_grids) : std::span(relaxing_grids)) {
    grid = &taps_grid;
    needed = 0;
    for (const std::uint32_t point : begun) needed += curve_values(file, point, taps_grid);
    if (needed <= room) break;
  }
  std::vector<std::uint32_t> points = begun;
  if (needed > room) {
    const double share = static_cast<double>(room) / static_cast<double>(needed);
    points = spread(
        begun, std::max<std::size_t>(1, static_cast<std::size_t>(share * double(begun.size()))));
    left_out.push_back(fmt::format("curves are drawn of {} of {} sweep points, evenly spread",
                                   points.size(), begun.size()));
  }
  bool thinned_taps = false;
  for (const std::uint32_t point : points) {
    const std::uint64_t rows = file.n_stored_rows(point);
    thinned_taps = thinned_taps || grid->taps(rows).size() < rows;
    curves.push_back(drawn_curve(file, point, *grid));
    if (points.size() <= most_curves_with_realizations) add_realizations(file, curves.back());
  }
  if (thinned_taps) {
    left_out.push_back(fmt::format(
        "curves are drawn at {} taps per decade{}, and where they are highest and lowest",
        grid->per_decade, changing ? fmt::format(" and {} evenly spread ones", grid->evenly) : ""));
  }
  return curves;
}

std::vector<DrawnSnapshots> drawn_snapshots(const ResultsFile& file, const WantedPoints& wanted,
                                            std::vector<std::string>& left_out) {
  const std::vector<std::uint32_t> begun = begun_points(file, wanted);
  std::vector<DrawnSnapshots> all;
  std::size_t realizations = 0;
  for (const std::uint32_t point : spread(begun, most_snapshot_points)) {
    const Snapshots& kept = file.study().points[point].snapshots;
    if (kept.taps.empty()) continue;
    const std::vector<std::uint64_t> taps = spread(kept.taps, most_histograms);
    SnapshotMeans means;
    const std::vector<std::uint32_t> available = distinct_with_taps(file, point);
    realizations = std::max(realizations, available.size());
    for (const std::uint32_t r : spread(available, most_snapshot_realizations)) {
      means.add(*file.realization({point, r}), taps);
    }
    if (!means.empty()) all.push_back(means.means(point, kept.bin_width));
  }
  if (!all.empty() && begun.size() > most_snapshot_points) {
    left_out.push_back(fmt::format("coordination and n(z) of snapshots: {} of {} sweep points",
                                   most_snapshot_points, begun.size()));
  }
  if (!all.empty() && realizations > most_snapshot_realizations) {
    left_out.push_back(fmt::format("coordination and n(z) of snapshots: {} of {} realizations",
                                   most_snapshot_realizations, realizations));
  }
  return all;
}

}  // namespace jostle::inline study
