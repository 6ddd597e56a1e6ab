#include <fmt/format.h>

#include <algorithm>

#include "config/names.hpp"
#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

constexpr std::size_t longest_name = 100;

bool is_file_name(const std::string& name) {
  const auto letter_or_digit = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  return !name.empty() && name.size() <= longest_name && letter_or_digit(name.front()) &&
         std::all_of(name.begin(), name.end(), [&](char c) {
           return letter_or_digit(c) || c == '.' || c == '_' || c == '-';
         });
}

void read_name(const Reader& in, std::string& name) {
  const auto text = in.text();
  if (!text) return;
  name = *text;
  if (is_file_name(name)) return;
  in.fault(
      fmt::format("a name has 1 to {} letters, digits, dots, hyphens and underscores, a letter "
                  "or digit first",
                  longest_name));
}

/// A string, or a list of strings that are joined by blanks.
void read_description(const Reader& in, std::string& description) {
  if (in.value().is_string()) {
    description = in.value().text();
  } else if (!in.value().is_array()) {
    in.fault("expected a string or a list of strings, found " + described(in.value()));
  } else {
    for (std::size_t i = 0; i < in.value().size(); ++i) {
      if (i > 0) description += ' ';
      description += in.element(i).text().value_or("");
    }
  }
}

void read_identity(const Reader& in, Scene& scene) {
  if (const auto link = in.find("$schema")) link->text();
  if (const auto name = in.find("name")) read_name(*name, scene.name);
  if (const auto description = in.find("description")) {
    read_description(*description, scene.description);
  }
  if (!in.find("seed")) {
    in.missing("seed", "a whole number; the same scene with the same seed gives the same bytes");
  }
  in.read_whole("seed", scene.seed, 0, std::numeric_limits<std::uint64_t>::max());
  in.read_whole("realizations", scene.realizations, 1, most_realizations);
  in.read_name("streams", scene.streams, stream_kinds);
}

void read_simulation(const Reader& in, Scene& scene) {
  if (const auto container = in.find("container")) {
    scene.container = read_container(*container);
  } else {
    in.missing("container", "an object with the key sides");
  }
  if (!in.find("spheres")) in.missing("spheres", "the number of spheres, a whole number");
  in.read_whole("spheres", scene.n_spheres, 1, most_spheres);
  if (const auto start = in.find("start")) scene.start = read_start(*start);
  if (const auto protocol = in.find("protocol")) {
    scene.protocol = read_protocol(*protocol);
  } else {
    in.missing("protocol", "a list of stages; [] makes the starting packings only");
  }
  if (const auto engine = in.find("engine")) scene.grains = read_engine(*engine);
  const auto read_trials = [&](const std::string& key) -> std::optional<Relaxation> {
    const auto relax = in.find(key);
    if (!relax) return std::nullopt;
    if (scene.grains)
      relax->fault(
          "trials are of Monte Carlo: discrete elements come to rest as their key "
          "\"rest\" says; leave this out");
    return read_relaxation(*relax);
  };
  scene.relax = read_trials("relax").value_or(Relaxation{});
  scene.relax_start = read_trials("relax_start");
}

}  // namespace

Scene read_scene(const Reader& in) {
  Scene scene;
  scene.observables = default_observables();
  if (!in.is_object_of({"$schema",  "name",      "description", "seed",    "realizations",
                        "streams",  "container", "spheres",     "start",   "protocol",
                        "engine",   "relax",     "relax_start", "observe", "snapshots",
                        "motion",   "sweep",     "until",       "fits",    "analyse",
                        "structure"})) {
    return scene;
  }
  read_identity(in, scene);
  read_simulation(in, scene);
  if (const auto observe = in.find("observe")) scene.observables = read_observables(*observe);
  const bool grains = scene.grains.has_value();
  scene.snapshots = default_snapshots(grains);
  if (const auto snapshots = in.find("snapshots"))
    scene.snapshots = read_snapshots(*snapshots, grains);
  if (const auto motion = in.find("motion")) scene.motion = read_motion(*motion);
  if (const auto sweep = in.find("sweep")) scene.sweep = read_sweep(*sweep);
  if (const auto until = in.find("until")) scene.until = read_until(*until);
  if (const auto fits = in.find("fits")) scene.fits = read_fits(*fits);
  if (const auto analyse = in.find("analyse")) scene.analyse = read_analyses(*analyse);
  if (const auto structure = in.find("structure")) scene.structure = read_structure(*structure);
  return scene;
}

}  // namespace jostle::inline config
