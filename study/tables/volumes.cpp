#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>

#include "config/grids.hpp"
#include "config/json/json_text.hpp"
#include "ensemble/analysis/hysteresis.hpp"
#include "ensemble/analysis/volumes/volume_table.hpp"
#include "ensemble/protocol_steps.hpp"
#include "results/groups/layout.hpp"
#include "study/bad_input.hpp"
#include "study/tables/analyse.hpp"
#include "study/tables/observable_series.hpp"
#include "study/tables/points/over_points.hpp"
#include "study/tables/points/swept_place.hpp"

namespace jostle::inline study {

namespace {

/// The last taps of one strength, at one point of the file.
struct Source {
  std::uint32_t point = 0;
  double strength = 0;
  StepTaps taps{};
};

struct Sources {
  std::string control, units;
  std::vector<Source> all;
  std::vector<std::string> left_out;  // points, and why
  std::string fault{};                // why its states are not compared
};

/// Whose volume an observable is that of; `mean`: its mean. Nothing of one that measures order.
struct SpheresOf {
  const Scene& scene;
  double mean;

  double n() const { return static_cast<double>(scene.n_spheres); }
  double area() const { return footprint_area(scene.container); }
  VolumeOf volume_at(double height) const { return {area() * height * mean / sphere_volume}; }

  std::optional<VolumeOf> operator()(const MeanHeight&) const {
    return VolumeOf{n(), 2 * area() / sphere_volume};
  }
  std::optional<VolumeOf> operator()(const BottomFraction&) const {
    return volume_at(4 * sphere_radius);
  }
  std::optional<VolumeOf> operator()(const CorrectedFraction& corrected) const {
    return VolumeOf{n() * corrected.depth};
  }
  std::optional<VolumeOf> operator()(const BulkFraction& bulk) const {
    if (const auto* heights = std::get_if<HeightWindow>(&bulk.window))
      return volume_at(heights->high - heights->low);
    const auto& quantiles = std::get<QuantileWindow>(bulk.window);
    return VolumeOf{n() * (quantiles.high - quantiles.low)};
  }
  template <class Other>
  std::optional<VolumeOf> operator()(const Other&) const {
    return std::nullopt;
  }
};

VolumeOf volume_of(const Scene& scene, const std::string& observable, double mean,
                   const VolumesSettings& settings) {
  for (const Observable& candidate : scene.observables) {
    if (label(candidate).name != observable) continue;
    std::optional<VolumeOf> found = std::visit(SpheresOf{scene, mean}, candidate);
    if (!found) break;
    if (!settings.spheres) return *found;
    if (found->per_height) *found->per_height *= *settings.spheres / found->spheres;
    found->spheres = *settings.spheres;
    return *found;
  }
  throw BadInput(
      fmt::format("{} is no packing fraction and no mean height, so that no volume "
                  "can be made of it",
                  observable));
}

double mean_over(const ObservableSeries& series, const StepTaps& taps) {
  double sum = 0;
  for (const double mean : series.means({taps.first, taps.last + 1})) sum += mean;
  return sum / series.n_realizations();
}

/// Realizations that all sources have, ascending.
std::vector<std::uint32_t> common_realizations(const ResultsFile& file, const Sources& sources,
                                               const std::string& observable, PointNotes& copies) {
  std::vector<std::uint32_t> common;
  for (const Source& source : sources.all) {
    if (file.study().points[source.point].mixture)
      throw BadInput("volumes per sphere are defined for equal spheres, and these are a mixture");
    const ObservableSeries series(file, source.point, observable);
    require_taps(file, source.point, series.n_realizations());
    if (source.taps.last >= series.n_rows())
      throw BadInput(
          fmt::format("tap {} is not reached at sweep point {}", source.taps.last, source.point));
    copies.add(file.study().points[source.point].label, series.copies());
    if (&source == &sources.all.front()) common = series.realizations();
    std::erase_if(common, [&](std::uint32_t r) {
      return !std::ranges::binary_search(series.realizations(), r);
    });
  }
  if (common.empty()) throw BadInput("there is no realization that all points have");
  return common;
}

template <class Take>
void for_each(const ObservableSeries& series, const StepTaps& taps,
              const std::vector<std::uint32_t>& realizations, const Take& take) {
  std::size_t place = 0;
  series.for_each({taps.first, taps.last + 1}, [&](std::span<const double> values) {
    if (std::ranges::binary_search(realizations, series.realizations()[place++])) take(values);
  });
}

std::vector<double> volumes_of(std::span<const double> values, const VolumeOf& volume) {
  std::vector<double> volumes;
  for (const double value : values) volumes.push_back(volume(value));
  return volumes;
}

/// The volume of the first point is that of all.
void require_one_size(const ResultsFile& file, const Sources& sources) {
  const StudyPoint& first = file.study().points[sources.all.front().point];
  for (const Source& source : sources.all) {
    const StudyPoint& point = file.study().points[source.point];
    if (point.n_spheres != first.n_spheres || point.container != first.container)
      throw BadInput(fmt::format(
          "volumes are compared in beds of one size, and {} has other spheres or sides than {}",
          point.label, first.label));
  }
}

Table table_of(const ResultsFile& file, const PointScenes& scenes,
               std::span<const std::uint32_t> points, const Sources& sources,
               const AnalysisRequest<VolumesSettings>& request) {
  if (!sources.fault.empty()) throw BadInput(sources.fault);
  if (sources.all.size() < 2 && !sources.left_out.empty())
    throw BadInput("fewer than two strengths can be used. Left out: " +
                   joined(sources.left_out, "; "));
  if (sources.all.size() < 2)
    throw BadInput("needs two strengths at least: a sweep of them, or a ramp in the protocol" +
                   of_chosen_points(file, points));
  require_one_size(file, sources);
  const std::string& observable = request.observable;
  PointNotes copies;
  const std::vector<std::uint32_t> realizations =
      common_realizations(file, sources, observable, copies);
  const Source& first = sources.all.front();
  const ObservableSeries first_series(file, first.point, observable);
  const VolumeOf volume = volume_of(scenes.point_scene(first.point), observable,
                                    mean_over(first_series, first.taps), request.settings);
  std::vector<VolumeState> states;
  for (const Source& source : sources.all) {
    VolumeState& state =
        states.emplace_back(VolumeState{source.strength, source.taps.first, source.taps.last});
    SteadyStateTest steady;
    for_each(ObservableSeries(file, source.point, observable), source.taps, realizations,
             [&](std::span<const double> values) {
               steady.add(values);
               state.observable.add(values);
               state.volumes.add(volumes_of(values, volume));
             });
    state.steady = steady.result();
  }
  std::vector<SteadyVolumes> used;
  for (const VolumeState& state : states) {
    if (state.used()) used.push_back(state.volumes);
  }
  VolumeBins bins;
  try {
    bins = volume_bins(used.empty() ? std::vector{states.front().volumes} : used);
  } catch (const std::invalid_argument& refusal) {
    throw BadInput(refusal.what());
  }
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Source& source = sources.all[i];
    for_each(ObservableSeries(file, source.point, observable), source.taps, realizations,
             [&](std::span<const double> values) {
               states[i].volumes.count(volumes_of(values, volume), bins);
             });
  }
  Table table =
      volume_table("", first_series.label(), sources.control, sources.units, volume, states, bins);
  copies.note("copies", table);
  return table;
}

/// The steps of the last branch of a protocol that goes through several strengths.
std::optional<Sources> last_branch(const PointScenes& scenes, std::uint32_t point,
                                   const std::optional<std::uint64_t>& last) {
  const std::vector<Stage> protocol = stages(scenes.point_scene(point).protocol);
  if (protocol.size() < 2) return std::nullopt;
  const std::uint64_t shortest = std::ranges::min(protocol, {}, &Stage::count).count;
  const auto found = protocol_steps(
      protocol, last.value_or(std::max<std::uint64_t>(SteadyStateTest::fewest_taps, shortest / 4)));
  const auto* steps = std::get_if<ProtocolSteps>(&found);
  if (!steps) return std::nullopt;
  Sources sources{steps->control, steps->units, {}, {}};
  const std::vector<std::vector<std::size_t>> all = branches(steps->strengths);
  for (const std::size_t step : all.back()) {
    const StepTaps taps = steps->windows[step];
    if (taps.last + 1 - taps.first < SteadyStateTest::fewest_taps)
      throw BadInput(fmt::format("needs at least {} taps per step; a step has {}",
                                 SteadyStateTest::fewest_taps, taps.last + 1 - taps.first));
    sources.all.push_back({point, steps->strengths[step], taps});
  }
  return sources;
}

/// One table of volumes with its name.
void add_table(const ResultsFile& file, const PointScenes& scenes,
               std::span<const std::uint32_t> points, const Sources& sources,
               const AnalysisRequest<VolumesSettings>& request, const std::string& name,
               std::vector<Table>& tables) {
  Table table;
  try {
    table = table_of(file, scenes, points, sources, request);
  } catch (const BadInput& refusal) {
    table.notes = {{"refused", refusal.what()}};
  }
  table.name = name;
  tables.push_back(std::move(table));
}

void add_tables(const ResultsFile& file, const PointScenes& scenes,
                std::span<const std::uint32_t> points,
                const AnalysisRequest<VolumesSettings>& request, std::vector<Table>& tables) {
  const auto& [observable, settings] = request;
  const std::string name = "volumes/" + observable;
  std::map<std::string, Sources> groups;  // by the other values of the sweep
  for (const std::uint32_t point : points) {
    const ObservableSeries series(file, point, observable);
    if (const auto branch = last_branch(scenes, point, settings.last)) {
      add_table(file, scenes, points, *branch, request, point_name(point) + "/" + name, tables);
      continue;
    }
    const SweptPlace place =
        swept_place(file.study().points[point], scenes, point, settings.against);
    Sources& group = groups[place.fixed_values];
    try {
      require_taps(file, point, series.n_realizations());
      const AnalysedSeries taps = last_taps(series, settings.last, 4, SteadyStateTest::fewest_taps);
      if (!group.control.empty() && group.control != place.swept.name)
        group.fault = fmt::format("{} and {} are not one sweep", group.control, place.swept.name);
      group.control = place.swept.name;
      group.units = place.swept.units;
      group.all.push_back({point, place.x, {taps.first_tap, taps.last_tap}});
    } catch (const BadInput& refusal) {
      group.left_out.push_back(
          fmt::format("{}: {}", file.study().points[point].label, refusal.what()));
    }
  }
  for (auto& [fixed_values, sources] : groups) {
    std::ranges::stable_sort(sources.all, {}, &Source::strength);
    add_table(file, scenes, points, sources, request,
              groups.size() == 1 ? name : fmt::format("{}_{:04}", name, tables.size()), tables);
    if (!fixed_values.empty()) tables.back().notes.emplace_back("at", fixed_values);
    if (!sources.left_out.empty())
      tables.back().notes.emplace_back("points_left_out", joined(sources.left_out, "; "));
  }
}

}  // namespace

std::vector<Table> volume_tables(const ResultsFile& file, const PointScenes& scenes,
                                 std::span<const std::uint32_t> points,
                                 std::span<const AnalysisRequest<VolumesSettings>> requests) {
  std::vector<Table> tables;
  for (const auto& request : requests) {
    try {
      std::vector<Table> made;
      add_tables(file, scenes, points, request, made);
      std::ranges::move(made, std::back_inserter(tables));
    } catch (const BadArgument&) {
      throw;
    } catch (const BadInput& refusal) {
      tables.push_back(
          {.name = "volumes/" + request.observable, .notes = {{"refused", refusal.what()}}});
    }
  }
  return tables;
}

}  // namespace jostle::inline study
