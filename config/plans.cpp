#include <fmt/format.h>

#include <map>

#include "config/grids.hpp"
#include "config/sweep.hpp"
#include "ensemble/statistics/counted.hpp"

namespace jostle::inline config {

namespace {

/// Starts with every file read once, its centres shared by all plans.
class StartMaker {
 public:
  explicit StartMaker(const PackingLoader& load) : load_(load) {}

  Start operator()(const StartChoice& choice, std::uint32_t n_spheres) {
    return std::visit([&](const auto& start) { return start_of(start, n_spheres); }, choice);
  }

 private:
  template <class Other>
  Start start_of(const Other& start, std::uint32_t) {
    return start;
  }
  Start start_of(const PackingFile& file, std::uint32_t n_spheres) {
    auto& centres = loaded_[file];
    if (!centres) centres = std::make_shared<const std::vector<Vec3>>(load_(file));
    if (centres->size() != n_spheres) {
      throw StartError(fmt::format("{} holds {}, the scene {}: set \"spheres\" to {}", file.path,
                                   counted(centres->size(), "sphere"), n_spheres, centres->size()));
    }
    return GivenPacking{centres, file.overlap};
  }

  const PackingLoader& load_;
  std::map<PackingFile, std::shared_ptr<const std::vector<Vec3>>> loaded_;
};

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
    const Scene& here = *scene_of_point++;
    Plan plan;
    plan.label = point_label(point);
    for (const auto& [pointer, value] : point.values) {
      plan.sweep_values.emplace_back(pointer, canonical_text(value));
    }
    plan.point_id = point_id(point);
    plan.seed = here.seed;
    plan.streams = here.streams;
    plan.container = here.container;
    plan.n_spheres = here.n_spheres;
    plan.start = make_start_of(here.start, here.n_spheres);
    plan.protocol = stages(here.protocol);
    plan.engine = engine_of(here);
    plan.observables = here.observables;
    plan.snapshots = snapshots(here.snapshots, total_taps(here.protocol));
    if (here.motion) plan.motion = motion_settings(*here.motion, total_taps(plan));
    plans.push_back(std::move(plan));
  }
  return plans;
}

}  // namespace jostle::inline config
