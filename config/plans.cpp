#include <fmt/format.h>

#include <map>

#include "config/grids.hpp"
#include "config/parts/parts.hpp"
#include "config/sweep.hpp"
#include "ensemble/statistics/counted.hpp"

namespace jostle::inline config {

namespace {

/// A packing of a file, its centres shared by all plans.
struct LoadedPacking {
  std::shared_ptr<const std::vector<Vec3>> centres;
  std::shared_ptr<const Sizes> sizes;  // null: equal spheres
};

/// Starts with every file read once.
class StartMaker {
 public:
  explicit StartMaker(const PackingLoader& load) : load_(load) {}

  Start operator()(const Scene& scene) {
    return std::visit([&](const auto& start) { return start_of(start, scene); }, scene.start);
  }

 private:
  template <class Other>
  Start start_of(const Other& start, const Scene&) {
    return start;
  }
  Start start_of(const PackingFile& file, const Scene& scene) {
    LoadedPacking& loaded = loaded_[file];
    if (!loaded.centres) {
      Packing packing = load_(file);
      loaded = {std::make_shared<const std::vector<Vec3>>(std::move(packing.centres)),
                std::move(packing.sizes)};
    }
    const std::size_t n = loaded.centres->size();
    if (n != scene.n_spheres) {
      const std::string mend =
          scene.kinds.empty() ? fmt::format("set \"spheres\" to {}", n) : "correct their counts";
      throw StartError(fmt::format("{} holds {}, the scene {}: {}", file.path, counted(n, "sphere"),
                                   scene.n_spheres, mend));
    }
    return GivenPacking{loaded.centres, file.overlap, sizes_for(loaded.sizes, scene, file.path)};
  }

  const PackingLoader& load_;
  std::map<PackingFile, LoadedPacking> loaded_;
};

/// Kinds of the mixture, drawn or of a file; 0 of equal spheres.
std::size_t n_kinds(const Plan& plan) {
  const auto* given = std::get_if<GivenPacking>(&plan.start);
  if (given == nullptr) return plan.kinds.size();
  return given->sizes ? given->sizes->kinds().size() : 0;
}

Snapshots snapshots(const SnapshotChoice& choice, std::uint64_t taps) {
  return {.taps = snapshot_taps(choice, taps),
          .positions = choice.positions,
          .coordination = choice.coordination,
          .contact_cut = choice.contact_cut,
          .height_histogram = choice.height_histogram,
          .bin_width = choice.bin_width,
          .velocities = choice.velocities,
          .contacts = choice.contacts,
          .granular_temperature = choice.granular_temperature,
          .forces = choice.forces,
          .driven_temperature = choice.driven_temperature};
}

}  // namespace

EngineSettings engine_of(const Scene& scene) {
  if (scene.grains) return *scene.grains;
  return MonteCarlo{scene.relax, scene.relax_start};
}

std::size_t n_sweep_points(const Scene& scene) {
  std::size_t points = 1;
  for (const SweepAxis& axis : scene.sweep) points *= axis.size();
  return points;
}

std::vector<Plan> make_plans(const Scene& scene, const PackingLoader& load) {
  return make_plans(scene, point_scenes(scene), load);
}

std::vector<Plan> make_plans(const Scene& scene, const std::vector<Scene>& points,
                             const PackingLoader& load) {
  StartMaker make_start_of(load);
  std::vector<Plan> plans;
  auto scene_of_point = points.begin();
  for (const SweepPoint& point : sweep_points(scene.sweep)) {
    const Scene& point_scene = *scene_of_point++;
    Plan plan;
    plan.label =
        scene.point_labels.empty() ? point_label(point) : scene.point_labels.at(plans.size());
    for (const auto& [pointer, value] : point.values) {
      plan.sweep_values.emplace_back(pointer, canonical_text(value));
    }
    plan.point_id = point_id(point);
    plan.seed = point_scene.seed;
    plan.streams = point_scene.streams;
    plan.container = point_scene.container;
    plan.n_spheres = point_scene.n_spheres;
    plan.kinds = point_scene.kinds;
    plan.pour_order = point_scene.pour_order;
    plan.start = make_start_of(point_scene);
    plan.protocol = stages(point_scene.protocol);
    plan.engine = engine_of(point_scene);
    plan.observables = point_scene.observables;
    plan.snapshots = snapshots(point_scene.snapshots, total_taps(point_scene.protocol));
    if (point_scene.motion)
      plan.motion = motion_settings(*point_scene.motion, total_taps(plan), n_kinds(plan));
    plans.push_back(std::move(plan));
  }
  return plans;
}

}  // namespace jostle::inline config
