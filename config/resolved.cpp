#include <algorithm>
#include <cmath>

#include "config/names.hpp"
#include "config/parts/parts.hpp"

namespace jostle::inline config {

Json plain_number(double value) {
  if (value == std::trunc(value) && std::abs(value) < 0x1p53) {
    return static_cast<std::int64_t>(value);
  }
  return value;
}

namespace {

// What is kept by default depends on the engine: where that is swept, it is not spelled out.
bool sweeps_engine(const Scene& scene) {
  return std::ranges::any_of(scene.sweep, [](const SweepAxis& axis) {
    return std::ranges::any_of(axis.columns,
                               [](const auto& one) { return one.first == "/engine"; });
  });
}
bool keeps_default(const Scene& scene) {
  return written(scene.snapshots).at("keep") ==
         written(default_snapshots(scene.grains.has_value())).at("keep");
}

}  // namespace

Json resolved(const Scene& scene) {
  Json out;
  out["name"] = scene.name;
  out["description"] = scene.description;
  out["seed"] = scene.seed;
  out["realizations"] = scene.realizations;
  out["streams"] = name_in(stream_kinds, scene.streams);
  out["container"] = written(scene.container);
  out["spheres"] = scene.n_spheres;
  out["start"] = written(scene.start);
  out["protocol"] = written(scene.protocol);
  if (scene.grains) {
    out["engine"] = written_engine(*scene.grains);
  } else {
    out["relax"] = written(scene.relax);
  }
  if (scene.relax_start) out["relax_start"] = written(*scene.relax_start);
  out["observe"] = written(scene.observables);
  out["snapshots"] = written(scene.snapshots);
  if (sweeps_engine(scene) && keeps_default(scene)) out["snapshots"].erase("keep");
  if (scene.motion) out["motion"] = written(*scene.motion);
  out["sweep"] = written(scene.sweep);
  if (!scene.until.targets.empty()) out["until"] = written(scene.until);
  out["fits"] = written(scene.fits);
  out["analyse"] = written(scene.analyse);
  out["structure"] = written(scene.structure);
  return out;
}

}  // namespace jostle::inline config
