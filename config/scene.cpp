#include "config/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "config/parts/parts.hpp"
#include "config/sweep.hpp"
#include "config/swept_defaults.hpp"
#include "ensemble/statistics/counted.hpp"

namespace jostle::inline config {

namespace {

/// Text, or a list of texts that are joined by blanks.
struct Prose {};

bool read_value(const Prose&, const Reader& reader, std::string& prose) {
  if (reader.value().is_string()) {
    prose = reader.value().text();
  } else if (!reader.value().is_array()) {
    reader.fault("expected a string or a list of strings, found " + described(reader.value()));
  } else {
    for (std::size_t i = 0; i < reader.value().size(); ++i) {
      if (i > 0) prose += ' ';
      prose += reader.element(i).text().value_or("");
    }
  }
  return true;
}
Json written_value(const Prose&, const std::string& prose) {
  return prose;
}
Json value_schema(const Prose&, Definitions&) {
  const Json text{{"type", "string"}};
  return either(text, {{"type", "array"}, {"items", text}});
}

constexpr auto schema_link = irregular(
    "$schema",
    [](const Reader& reader, Scene&) {
      if (const auto link = reader.find("$schema")) link->text();
    },
    [](const Scene&, Json&) {},
    [](ObjectSchema& schema, Definitions&) {
      schema.properties["$schema"] =
          described_as({{"type", "string"}}, "Schema", "Path of scene.schema.json, for editors.",
                       std::nullopt, "");
    });

constexpr auto engine_field = irregular(
    "engine",
    [](const Reader& reader, Scene& scene) {
      if (const auto engine = reader.find("engine")) scene.grains = read_engine(*engine);
    },
    [](const Scene& scene, Json& json) {
      if (!scene.grains) return;
      json["engine"] = written_engine(*scene.grains);
      if (leaves_steps_out(scene)) json["engine"]["discrete_element"].erase("steps_per_contact");
    },
    [](ObjectSchema& schema, Definitions& definitions) {
      schema.properties["engine"] = described_as(engine_schema(definitions), "Engine",
                                                 "The engine that moves the spheres: Monte Carlo, "
                                                 "with its settings in relax and relax_start, or "
                                                 "discrete elements.",
                                                 "monte_carlo", "");
    });

/// A relaxation, which only Monte Carlo has.
void read_trials(const Reader& reader, std::string_view key, bool grains, Relaxation& relaxation) {
  const auto relax = reader.find(std::string(key));
  if (!relax) return;
  if (grains)
    relax->fault(
        "applies only to Monte Carlo: discrete elements come to rest by their key \"rest\"; remove "
        "this key");
  read_part(*relax, relaxation);
}

constexpr Object<Relaxation> relaxation_form{"relax"};

constexpr auto relax_field = irregular(
    "relax",
    [](const Reader& reader, Scene& scene) {
      read_trials(reader, "relax", scene.grains.has_value(), scene.relax);
    },
    [](const Scene& scene, Json& json) {
      if (!scene.grains) json["relax"] = written_part(scene.relax);
    },
    [](ObjectSchema& schema, Definitions& definitions) {
      schema.properties["relax"] =
          described_as(value_schema(relaxation_form, definitions), "Relaxation after a tap",
                       "Monte Carlo: the moves after a tap, and the rule "
                       "that ends them.",
                       Json::object(), "");
    });

constexpr auto relax_start_field = irregular(
    "relax_start",
    [](const Reader& reader, Scene& scene) {
      if (reader.find("relax_start"))
        read_trials(reader, "relax_start", scene.grains.has_value(), scene.relax_start.emplace());
    },
    [](const Scene& scene, Json& json) {
      if (scene.relax_start) json["relax_start"] = written_part(*scene.relax_start);
    },
    [](ObjectSchema& schema, Definitions& definitions) {
      schema.properties["relax_start"] = described_as(
          value_schema(relaxation_form, definitions), "Relaxation of the start",
          "How the start is relaxed before tap 0. Absent: random_settle as after a tap, a fitted "
          "pour not at all. Other starts are at rest and take none.",
          std::nullopt, "");
    });

// The engine decides what is kept by default.
constexpr auto snapshots_field = irregular(
    "snapshots",
    [](const Reader& reader, Scene& scene) {
      scene.snapshots = default_snapshots(scene.grains.has_value());
      if (const auto snapshots = reader.find("snapshots")) read_part(*snapshots, scene.snapshots);
    },
    [](const Scene& scene, Json& json) {
      Json& snapshots = json["snapshots"] = written_part(scene.snapshots);
      if (leaves_kept_data_out(scene)) snapshots.erase("keep");
    },
    [](ObjectSchema& schema, Definitions& definitions) {
      schema.properties["snapshots"] =
          described_as(part_schema(std::type_identity<SnapshotChoice>{}, definitions), "Snapshots",
                       "Packings kept at chosen taps; tap 0 is the start.", Json::object(), "");
    });

constexpr auto spheres_field = irregular(
    "spheres",
    [](const Reader& reader, Scene& scene) {
      if (const auto spheres = reader.find("spheres"))
        read_spheres(*spheres, scene);
      else
        reader.missing("spheres", "the number of spheres, a whole number, or a list of kinds");
    },
    [](const Scene& scene, Json& json) { json["spheres"] = written_spheres(scene); },
    [](ObjectSchema& schema, Definitions& definitions) {
      schema.properties["spheres"] = described_as(
          spheres_schema(definitions), "Spheres",
          "The number of equal spheres of diameter 1, or the kinds of a mixture. A start from a "
          "file takes the sizes that the file holds.",
          std::nullopt, "[4096, 3456]");
      schema.required.emplace_back("spheres");
    });

// Equal spheres are poured as they are numbered: they have no order that scenes could name.
constexpr auto pour_order_field = irregular(
    "pour_order",
    [](const Reader& reader, Scene& scene) {
      if (const auto order = reader.find("pour_order"))
        read_value(word(pour_orders), *order, scene.pour_order);
    },
    [](const Scene& scene, Json& json) {
      if (!scene.kinds.empty()) json["pour_order"] = name_in(pour_orders, scene.pour_order);
    },
    [](ObjectSchema& schema, Definitions& definitions) {
      schema.properties["pour_order"] = described_as(
          value_schema(word(pour_orders), definitions), "Order of pouring",
          "The order in which the spheres of a mixture are poured. Spheres with a place come "
          "first. The numbers of the spheres are those of the list of kinds.",
          "random", "");
    });

constexpr auto observe_form = list_of(OneOf<Observable>{.by_name = true}, 0, 100, "observables");

/// A mixture observes other quantities by default than equal spheres do: the height of every kind.
constexpr auto observe_field = irregular(
    "observe",
    [](const Reader& reader, Scene& scene) {
      if (const auto observe = reader.find("observe"))
        read_value(observe_form, *observe, scene.observables);
      else if (!scene.kinds.empty())
        scene.observables = default_observables(scene.kinds);
    },
    [](const Scene& scene, Json& json) {
      json["observe"] = written_value(observe_form, scene.observables);
      if (leaves_observables_out(scene)) json.erase("observe");
    },
    [](ObjectSchema& schema, Definitions& definitions) {
      schema.properties["observe"] =
          described_as(value_schema(observe_form, definitions), "Observables",
                       "Observables measured at the start and after every tap.",
                       written_default(observe_form, Scene{}.observables), "");
    });

constexpr auto identity_fields() {
  return std::tuple{
      schema_link,
      field("name", &Scene::name,
            Text{"A-Za-z0-9", "A-Za-z0-9._-", 100,
                 "a name has 1 to 100 letters, digits, dots, hyphens and underscores, a letter or "
                 "digit first"},
            "Short name of the study", {.title = "Name", .examples = R"(["quickstart"])"}),
      field("description", &Scene::description, Prose{},
            "A description of the study for readers. A list of strings is joined by blanks",
            {.title = "Description"}),
      field("seed", &Scene::seed, Whole{},
            "Seed of all random numbers: the same scene with the same seed gives the same bytes",
            {.required = "a whole number; the same scene with the same seed gives the same bytes",
             .title = "Seed",
             .examples = "[20010222]"}),
      field("realizations", &Scene::realizations, Whole{1, most_realizations},
            "Independent repetitions of every sweep point",
            {.title = "Realizations", .examples = "[10]"}),
      field("streams", &Scene::streams, word(stream_kinds),
            "independent: every sweep point draws its own numbers. matched: starts and taps draw "
            "the same numbers at all points, for paired comparisons",
            {.title = "Random streams of sweep points"})};
}

constexpr auto simulation_fields() {
  return std::tuple{
      field("container", &Scene::container, OneOf<Container>{},
            "Container of the spheres; a floor at z = 0 and an open top, except for fully_periodic",
            {.required = "an object with the key sides",
             .title = "Container",
             .examples = R"([{"sides": "periodic", "width": 16}, {"sides": "walls", "width": 16},
                             {"sides": "cylinder", "diameter": 19}])"}),
      spheres_field,
      pour_order_field,
      field("start", &Scene::start, OneOf<StartChoice>{}, "How the packing begins: tap 0",
            {.title = "Starting packing",
             .examples = R"([{"pour": "steepest_descent"}, {"pour": "fitted"},
                             {"random_settle": {"dilute_fraction": 0.1}}, {"crystal": "hcp"},
                             {"file": "earlier.h5"}])"}),
      field("protocol", &Scene::protocol, list_of(Object<ProtocolLine>{}, 0, 1000, "stages"),
            "Stages of taps, one after another. [] makes the starting packings only",
            {.required = "a list of stages; [] makes the starting packings only",
             .title = "Protocol",
             .examples = R"([[{"tap": {"dilate": 0.02}, "count": 4000}],
                             [{"ramp": {"dilate": {"sqrt_from": 0.025, "sqrt_to": 0.4,
                               "sqrt_step": 0.025}}, "count": 4000}]])"}),
      engine_field,
      relax_field,
      relax_start_field};
}

constexpr auto measured_fields() {
  return std::tuple{
      observe_field,
      snapshots_field,
      field("motion", &Scene::motion, Object<MotionChoice>{},
            "Displacements over many taps, measured while the bed is tapped: mean square "
            "displacements, overlaps and chi_4 (docs/reference/analyses.md). Nothing is kept "
            "without this "
            "key",
            {.title = "Motion of the spheres",
             .examples = R"([{}, {"overlap_lengths": [0.05, 0.1, 0.3], "layers": 10}])"}),
      field("sweep", &Scene::sweep, SweptPointers{},
            "JSON pointers into the scene, each with a list of values. All are crossed, the first "
            "varies slowest; those inside a zip vary together",
            {.title = "Sweep", .examples = R"([{"/protocol/0/tap/dilate": [0.005, 0.05, 0.15]}])"}),
      field("point_labels", &Scene::point_labels,
            list_of(Text{"A-Za-z0-9", "A-Za-z0-9 .,_=+()/%-", 40,
                         "a label has 1 to 40 letters, digits, blanks and . , _ = + ( ) / % -, a "
                         "letter or digit first"},
                    0, 100'000, "labels"),
            "Labels of the sweep points in tables and figures, in the order of the points: the "
            "last list of the sweep varies fastest. Absent: the swept values",
            {.unless_default = true, .title = "Labels of sweep points"}),
      field("until", &Scene::until, Object<TargetPrecision>{},
            "Realizations are added, the same number at every sweep point, until every target is "
            "met at every point",
            {.unless_default = true,
             .title = "Enough realizations",
             .examples = R"([{"targets": [{"observable": "bulk_fraction",
                              "standard_error": 0.001}], "at_most": 200}])"}),
      field("fits", &Scene::fits, list_of(Object<FitRequest>{}, 0, 100, "fits"),
            "Laws fitted to the mean of an observable against taps, at every sweep point, when the "
            "run ends",
            {.title = "Fits"}),
      field("analyse", &Scene::analyse, Object<Analyses>{},
            "Analyses at the end of the run, at every sweep point: docs/reference/analyses.md",
            {.title = "Analyses"}),
      field(
          "structure", &Scene::structure, Object<StructureSettings>{},
          "Parts of structure that the run measures in the kept packings at its end, averaged over "
          "realizations; parts that are not named are not measured. docs/reference/structure.md",
          {.title = "Structure",
           .examples = R"([{"profile": {}, "pores": {"bin_width": 0.01}}])"})};
}

constexpr auto scene_fields() {
  return std::tuple_cat(identity_fields(), simulation_fields(), measured_fields());
}

/// One label for each point, no two alike.
void check_point_labels(const Scene& scene, std::size_t n_points, std::vector<Fault>& faults) {
  const std::vector<std::string>& labels = scene.point_labels;
  if (labels.empty()) return;
  if (scene.sweep.empty() || labels.size() != n_points) {
    faults.push_back({"/point_labels",
                      fmt::format("{} for {}: list one label for each sweep point, in their order",
                                  counted(labels.size(), "label"),
                                  scene.sweep.empty() ? "a scene without a sweep"
                                                      : counted(n_points, "sweep point"))});
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (seen.insert(labels[i]).second) continue;
    faults.push_back(
        {pointer_to("/point_labels", i),
         fmt::format("\"{}\" is the label of an earlier point: labels must differ", labels[i])});
  }
}

/// `faults`: those that the text has already.
ParsedScene checked(const Json& document, std::vector<Fault> faults) {
  ParsedScene parsed{.scene = std::nullopt, .points = {}, .faults = std::move(faults)};
  Scene scene = read_scene(Reader{document, "", parsed.faults});
  check_consistency(scene, parsed.faults);
  check_sweep_analyses(scene, parsed.faults);
  const Json* sweep = document.find("sweep");
  std::vector<Scene> points =
      read_sweep_points(scene, sweep != nullptr ? *sweep : Json(), parsed.faults);
  if (parsed.faults.empty()) check_point_labels(scene, points.size(), parsed.faults);
  if (!parsed.faults.empty()) return parsed;
  parsed.scene = std::move(scene);
  parsed.points = std::move(points);
  return parsed;
}

}  // namespace

Scene read_scene(const Reader& reader) {
  Scene scene;
  read_object(scene_fields(), reader, scene);
  return scene;
}

Json resolved(const Scene& scene) {
  return written_object(scene_fields(), scene);
}

std::vector<std::string> requested_tables(const Scene& scene) {
  std::vector<std::string> keys;
  if (!scene.until.targets.empty()) keys.emplace_back("until");
  if (!scene.fits.empty()) keys.emplace_back("fits");
  if (!scene.analyse.empty()) keys.emplace_back("analyse");
  if (scene.motion) keys.emplace_back("motion");
  if (!scene.structure.empty()) keys.emplace_back("structure");
  return keys;
}

std::string scene_schema() {
  Definitions definitions;
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", "jostle scene"},
              {"description",
               "One study of a tapped packing of hard spheres, equal ones or a mixture. Lengths in "
               "sphere diameters, "
               "angles in radians. docs/reference/scene.md explains every key."}};
  schema.update(object_schema(scene_fields(), definitions).json());
  schema["definitions"] = definitions.all();
  return schema.dump(2) + '\n';
}

ParsedScene checked_scene(const Json& document) {
  return checked(document, {});
}

ParsedScene parse_scene(std::string_view json_text) {
  std::vector<Fault> faults;
  const auto json = read_json(json_text, faults);
  if (!json) return {.scene = std::nullopt, .points = {}, .faults = std::move(faults)};
  return checked(*json, std::move(faults));
}

}  // namespace jostle::inline config
