#include "study/report/page_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>

#include "ensemble/moments.hpp"
#include "results/file/layout.hpp"
#include "study/report/page_json.hpp"
#include "study/report/page_packings.hpp"
#include "study/report/page_run.hpp"
#include "study/report/page_tables.hpp"
#include "study/report/thinning.hpp"
#include "study/scenes/stored_scene.hpp"

namespace jostle::inline study {
namespace {

template <class Value>
std::vector<Value> at_places(const std::vector<Value>& values,
                             const std::vector<std::size_t>& places) {
  std::vector<Value> out;
  for (const std::size_t place : places) out.push_back(values[place]);
  return out;
}

/// Taps of a curve that are drawn: a decade, and evenly.
struct CurveGrid {
  std::size_t per_decade, evenly;
  std::vector<std::size_t> taps(std::size_t n) const {
    return logarithmically_spread(n, per_decade, evenly);
  }
};
// From the finest on: the first that all sweep points have room with. Where the strength of the
// taps changes, later taps count as much as early ones.
constexpr CurveGrid relaxing_grids[] = {{40, 2}, {20, 2}, {10, 2}, {5, 2}};
constexpr CurveGrid changing_grids[] = {{40, 400}, {20, 100}, {10, 40}, {5, 20}};

bool changes_strength(const ResultsFile& file) {
  const Json scene = stored_scene(file);
  const Json* const protocol = scene.find("protocol");
  if (protocol == nullptr || !protocol->is_array()) return false;
  return protocol->size() > 1 || std::ranges::any_of(protocol->elements(), [](const Json& stage) {
           return stage.contains("ramp");
         });
}

constexpr std::size_t arrays_of_a_column = 4;

std::size_t curve_values(const ResultsFile& file, std::uint32_t point, const CurveGrid& grid) {
  return grid.taps(file.n_stored_rows(point)).size() *
         (1 + arrays_of_a_column * file.study().points[point].n_columns());
}

Json page_curve(const ResultsFile& file, std::uint32_t point, const CurveGrid& grid) {
  const std::vector<std::size_t> taps = grid.taps(file.n_stored_rows(point));
  Json columns = Json::array();
  const std::size_t n_observables = file.study().points[point].observables.size();
  std::size_t number = 0;
  for (const EnsembleSeries& series : file.ensemble(point)) {
    columns.push_back({{"name", page_text(series.label.name)},
                       {"kind", number++ < n_observables ? "observable" : "engine"},
                       {"shown", shown_names[static_cast<std::size_t>(series.label.shown)]},
                       {"units", page_text(series.label.units)},
                       {"long_name", page_text(series.label.long_name)},
                       {"source", page_text(series.label.source)},
                       {"mean", page_numbers(at_places(series.mean, taps))},
                       {"error", page_numbers(at_places(series.error, taps))},
                       {"sigma", page_numbers(at_places(series.sigma, taps))},
                       {"count", at_places(series.count, taps)}});
  }
  return {{"point", point}, {"taps", taps}, {"columns", columns}};
}

/// Numbers of the sweep points that have values.
std::vector<std::uint32_t> begun_points(const ResultsFile& file) {
  std::vector<std::uint32_t> begun;
  for (std::uint32_t p = 0; p < file.study().points.size(); ++p) {
    if (file.n_stored_rows(p) > 0) begun.push_back(p);
  }
  return begun;
}

std::vector<std::uint32_t> spread(const std::vector<std::uint32_t>& points, std::size_t most) {
  std::vector<std::uint32_t> chosen;
  for (const std::size_t i : evenly_spread(points.size(), most)) chosen.push_back(points[i]);
  return chosen;
}

Json page_curves(const ResultsFile& file, const std::vector<std::uint32_t>& begun, std::size_t room,
                 std::vector<std::string>& left_out) {
  Json curves = Json::array();
  if (begun.empty()) return curves;
  const CurveGrid* grid = nullptr;
  std::size_t needed = 0;
  const bool changing = changes_strength(file);
  for (const CurveGrid& one : changing ? std::span(changing_grids) : std::span(relaxing_grids)) {
    grid = &one;
    needed = 0;
    for (const std::uint32_t point : begun) needed += curve_values(file, point, one);
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
    curves.push_back(page_curve(file, point, *grid));
  }
  if (thinned_taps) {
    left_out.push_back(
        changing ? fmt::format("curves are drawn at {} taps a decade and {} evenly spread ones",
                               grid->per_decade, grid->evenly)
                 : fmt::format("curves are drawn at {} taps a decade", grid->per_decade));
  }
  return curves;
}

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

  Json json(std::uint32_t point, double bin_width) const {
    Json taps = Json::array(), means = Json::array(), errors = Json::array();
    for (const auto& [tap, moments] : coordination_) {
      taps.push_back(tap);
      means.push_back(page_number(moments.mean()));
      errors.push_back(page_number(moments.standard_error()));
    }
    Json heights = Json::array();
    for (const auto& [tap, mean] : heights_) {
      std::vector<double> share = mean.sums;
      for (double& value : share) value /= mean.n;
      heights.push_back({{"tap", tap}, {"n", page_numbers(share)}});
    }
    return {{"point", point},         {"taps", taps},
            {"coordination", means},  {"coordination_error", errors},
            {"bin_width", bin_width}, {"heights", heights}};
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

Json page_snapshots(const ResultsFile& file, const std::vector<std::uint32_t>& begun,
                    std::vector<std::string>& left_out) {
  Json all = Json::array();
  const std::uint32_t realizations = file.study().realizations;
  for (const std::uint32_t point : spread(begun, most_snapshot_points)) {
    const Snapshots& kept = file.study().points[point].snapshots;
    std::vector<std::uint64_t> taps;
    for (const std::size_t i : evenly_spread(kept.taps.size(), most_histograms)) {
      taps.push_back(kept.taps[i]);
    }
    SnapshotMeans means;
    for (const std::size_t r : evenly_spread(realizations, most_snapshot_realizations)) {
      means.add(*file.realization({point, static_cast<std::uint32_t>(r)}), taps);
    }
    if (!means.empty()) all.push_back(means.json(point, kept.bin_width));
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

}  // namespace

Json page_data(const ResultsFile& file, const std::string& digest, const PageRoom& room,
               int threads) {
  std::vector<std::string> left_out;
  Json data = page_run(file, digest, left_out);
  const std::vector<std::uint32_t> begun = begun_points(file);
  data["curves"] = page_curves(file, begun, room.curve_values, left_out);
  data["snapshots"] = page_snapshots(file, begun, left_out);
  data["tables"] = page_tables(file, room.table_values, left_out);
  data["packings"] = page_packings(file, room.packing_bytes, threads, left_out);
  Json texts = Json::array();
  for (const std::string& text : left_out) texts.push_back(page_text(text));
  data["left_out"] = texts;
  return data;
}

}  // namespace jostle::inline study
