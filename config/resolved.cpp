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
  out["sweep"] = written(scene.sweep);
  if (!scene.until.targets.empty()) out["until"] = written(scene.until);
  out["fits"] = written(scene.fits);
  out["analyse"] = written(scene.analyse);
  out["structure"] = written(scene.structure);
  return out;
}

}  // namespace jostle::inline config
