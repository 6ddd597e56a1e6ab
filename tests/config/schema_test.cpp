#include <algorithm>
#include <catch2/catch.hpp>
#include <regex>
#include <set>

#include "tests/config/scene_files.hpp"
#include "tests/config/schema_validator.hpp"
#include "tests/test_files.hpp"

namespace jostle {

namespace {

/// The rules that JSON Schema cannot express, as docs/reference/scene.md lists them: by a part of
/// the message.
const std::vector<std::string> cross_field_messages{
    "written twice in one object",
    "is empty: the first number must be the lower",
    "is empty: from must not be above to",
    "do not reach",
    "a ramp has at most 1000",
    "the name \"",
    "a fully_periodic container has neither floor nor gravity",
    "spheres grow in a fully_periodic container only",
    "growing without order ends at",
    "a fitted pour is fitted between walls",
    "stretch spaces rows out to a period",
    "the pour before the fitting needs periodic sides",
    "polar moves fall",
    "applies only to Monte Carlo",
    "discrete elements fall on a floor",
    "the contacts with floor and sides have the law",
    "the floor moves under discrete elements only",
    "half a period of the floor takes",
    "at this acceleration and frequency",
    "trials move hard spheres: a packing that overlaps",
    "nothing settles",
    "an order is that of poured spheres",
    "can reach below the floor",
    "this start is at rest",
    "skipping needs trials that only fall",
    "skipping does not see the upward trials",
    "is measured from a floor",
    "a tap has no meaning without gravity",
    "every relaxation would end capped",
    "requires discrete elements",
    "requires positions",
    "is beyond the last tap",
    "zipped lists must have the same length",
    "more than 100000 points",
    "leads to no value of the resolved scene",
    "belongs to the study as a whole",
    "sweep one of them",
    "list a value once",
    "is empty: the first tap must be the lower",
    "is not observed (observed:",
    "hysteresis needs a ramp",
    "a protocol of at least two stages",
    "but the last stage has",
    "after the last one,",
    "the lowest frequency comes first",
    "but the protocol has",
    "that are analysed",
    "and a lag follows",
    "are possible: diameters must lie",
    "are given: the first must not exceed the second",
    "diameters are listed for",
    "a place is that of",
    "does not lie within the container: move it inwards",
    "two kinds are named",
    "the kinds have",
    "the largest must not exceed",
    "with spheres of",
    "equal spheres have no order",
    "no kind of spheres is named",
    "is measured of kinds of spheres",
    "is that of two kinds of spheres",
    "is defined for equal spheres alone",
    "equal spheres of diameter 1",
    "are defined for equal spheres: leave them out",
    "partial g(r)",
    "a lag is at least 1 tap",
    "needs a sweep",
    "realizations to begin with",
    "is not swept (swept:",
    "is not made by this scene",
    "and no part to measure in it",
    "structure is measured in kept packings",
    "first must not be above last",
    "expected at least one tap",
    "layers of",
    "MB per realization, more than",
    "numbers per sweep point",
    "taps are more than",
};

bool is_beyond_schema(const Fault& fault) {
  // The schema does not look into swept values, which are judged where they are put.
  static const std::regex swept_value(R"(/sweep/(zip/(\d+/)?)?~1[^/]*/\d+(/.*)?)");
  if (std::regex_match(fault.pointer, swept_value)) return true;
  if (fault.message.find("sweep point") != std::string::npos) return true;
  return std::any_of(
      cross_field_messages.begin(), cross_field_messages.end(),
      [&](const std::string& part) { return fault.message.find(part) != std::string::npos; });
}

/// Tests if schema and parser agree: the schema rejects exactly what the parser rejects, except for
/// the rules above.
bool agree(SchemaValidator& schema, const std::string& text, const PlainJson& scene) {
  const ParsedScene parsed = parse_scene(text);
  const bool refused = !std::all_of(parsed.faults.begin(), parsed.faults.end(), is_beyond_schema);
  return schema.accepts(scene) != refused;
}

/// Replacements of a value.
const std::vector<PlainJson> replacements{
    nullptr,
    true,
    "text",
    "",
    0,
    -1,
    1,
    2,
    0.5,
    3.5,
    1e-7,
    1e3,
    1.5e9,
    2e12,
    1e300,
    PlainJson::array(),
    PlainJson::object(),
    {1, 2},
    {0.2, 0.1},
    {1.5, 4},
    "infinity",
    "last",
    "a.xyz",
    "hcp",
    {{"name", "x"}},
};

/// A shipped scene is named after its folders and its file, so that results of two papers differ.
std::string name_of_file(const std::filesystem::path& scene) {
  std::string name;
  for (const auto& part : std::filesystem::relative(scene, shipped_scenes).parent_path()) {
    name += part.string() + "-";
  }
  return name + scene.stem().string();
}

/// Calls visit(mutant) for the scene with one value replaced, removed or added.
template <class Visit>
void for_each_mutant(const PlainJson& scene, const Visit& visit) {
  const PlainJson leaves = scene.flatten();
  for (const auto& [pointer, value] : leaves.items()) {
    // The value and everything that holds it, up to the scene.
    for (PlainJson::json_pointer place(pointer); !place.empty(); place.pop_back()) {
      for (const PlainJson& replacement : replacements) {
        PlainJson mutant = scene;
        mutant[place] = replacement;
        visit(mutant);
      }
      PlainJson reduced = scene;
      const auto parent = place.parent_pointer();
      if (reduced[parent].is_object()) {
        reduced[parent].erase(place.back());
        visit(reduced);
        reduced[parent][place.back() + "x"] = value;
        visit(reduced);
      } else {
        reduced[parent].push_back(reduced[parent][0]);
        visit(reduced);
      }
    }
  }
}

/// Checks every `every`-th change.
void check_changes_of_one_value(std::size_t every) {
  SchemaValidator schema;
  std::set<std::string> seen;
  std::size_t refused = 0, tried = 0;
  for (const auto& file : json_files(good_scenes)) {
    for_each_mutant(PlainJson::parse(text_of(file)), [&](const PlainJson& mutant) {
      const std::string text = mutant.dump();
      if (!seen.insert(text).second || seen.size() % every != 0) return;
      ++tried;
      refused += !schema.accepts(mutant);
      if (agree(schema, text, mutant)) return;
      INFO(file.filename().string()
           << ": " << text << "\nparser: " << lines(parse_scene(text).faults)
           << "schema accepts: " << schema.accepts(mutant));
      CHECK(agree(schema, text, mutant));
    });
  }
  CHECK(seen.size() > 1000);
  CHECK(refused > tried / 2);
}

}  // namespace

TEST_CASE("The schema accepts every good scene and every shipped one") {
  SchemaValidator schema;
  const auto shipped = json_files(shipped_scenes);
  CHECK_FALSE(shipped.empty());
  for (const auto& files : {json_files(good_scenes), shipped}) {
    for (const auto& file : files) {
      INFO(file.string());
      CHECK(schema.accepts(PlainJson::parse(text_of(file))));
    }
  }
}

TEST_CASE("Shipped scenes are scenes, named as their files, that link their schema") {
  const auto files = json_files(shipped_scenes);
  REQUIRE_FALSE(files.empty());
  for (const auto& file : files) {
    INFO(file.string());
    const ParsedScene parsed = parse_scene(text_of(file));
    CHECK(lines(parsed.faults).empty());
    REQUIRE(parsed.scene.has_value());
    CHECK(parsed.scene->name == name_of_file(file));
    CHECK_FALSE(parsed.scene->description.empty());
    const auto json = PlainJson::parse(text_of(file));
    REQUIRE(json.contains("$schema"));
    const auto linked = file.parent_path() / json["$schema"].get<std::string>();
    CHECK(std::filesystem::weakly_canonical(linked) ==
          std::filesystem::canonical(source_file("config")) / "scene.schema.json");
  }
}

TEST_CASE("Schema and parser agree on every bad scene") {
  SchemaValidator schema;
  for (const auto& file : json_files(bad_scenes)) {
    INFO(file.filename().string());
    const std::string text = text_of(file);
    if (PlainJson::accept(text)) CHECK(agree(schema, text, PlainJson::parse(text)));
  }
}

TEST_CASE("Schema and parser agree on what becomes of a good scene when one value changes") {
  check_changes_of_one_value(5);
}

TEST_CASE("Schema and parser agree whichever value of a good scene changes", "[slow]") {
  check_changes_of_one_value(1);
}

TEST_CASE("Every example of the schema is what it is an example of") {
  SchemaValidator schema;
  const PlainJson root = PlainJson::parse(scene_schema());
  const PlainJson least = PlainJson::parse(text_of(good_scenes / "least.json"));
  std::size_t n_examples = 0;
  for (const auto& [key, property] : root["properties"].items()) {
    const PlainJson& described =
        property.contains("$ref")
            ? root.at(PlainJson::json_pointer(property["$ref"].get<std::string>().substr(1)))
            : property;
    std::vector<PlainJson> values = described.value("examples", std::vector<PlainJson>{});
    if (described.contains("default")) values.push_back(described["default"]);
    for (const PlainJson& value : values) {
      PlainJson scene = least;
      scene["protocol"] = PlainJson::parse(R"([{"tap": {"dilate": 0.02}, "count": 1}])");
      scene["container"]["sides"] = "walls";
      scene["snapshots"] = {{"taps", {0}}};
      scene[key] = value;
      INFO(scene.dump());
      CHECK(schema.accepts(scene));
      CHECK(lines(parse_scene(scene.dump()).faults).empty());
      ++n_examples;
    }
  }
  CHECK(n_examples > 10);
}

}  // namespace jostle
