#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <set>

#include "config/json/json_text.hpp"
#include "tests/config/scene_files.hpp"
#include "tests/config/schema_validator.hpp"

// Cases made of the schema, which is made of the lists of fields: for every field the values just
// below and above its range, a wrong type, an unknown key, a missing one. Reader and schema must
// both refuse each, the reader at the very value.
namespace jostle {

namespace {

/// A place in a scene: its pointer, and the scene that has a value there.
struct Place {
  std::string pointer;
  std::function<PlainJson(const PlainJson&)> put;
};

class FieldCases {
 public:
  using Visit = std::function<void(const Place&, const PlainJson& value, bool good)>;
  /// Two scenes that are the same one, a default written out and left out.
  using VisitDefault =
      std::function<void(const std::string& pointer, const PlainJson&, const PlainJson&)>;

  FieldCases(PlainJson root, Visit visit, VisitDefault visit_default)
      : root_(std::move(root)),
        visit_(std::move(visit)),
        visit_default_(std::move(visit_default)) {}

  void operator()() {
    const PlainJson least = PlainJson::parse(text_of(good_scenes / "least.json"));
    for (const auto& [key, schema] : root_["properties"].items()) {
      if (const PlainJson whole = resolved_schema(schema); whole.contains("default")) {
        PlainJson written = least;
        written[key] = whole["default"];
        visit_default_("/" + key, written, least);
      }
      visit(schema, {"/" + key, [least, key = key](const PlainJson& value) {
                       PlainJson scene = least;
                       scene[key] = value;
                       return scene;
                     }});
    }
    PlainJson unknown = least;
    unknown["no_such_key"] = 1;
    visit_({"/no_such_key", [](const PlainJson& scene) { return scene; }}, unknown, false);
  }

 private:
  /// Without references, and with what it refers to in the schema itself.
  PlainJson resolved_schema(PlainJson schema) const {
    while (schema.contains("$ref") || schema.contains("allOf")) {
      const PlainJson reference = schema.contains("$ref") ? schema : schema["allOf"][0];
      const std::string name = reference["$ref"].get<std::string>().substr(1);
      PlainJson whole = root_.at(PlainJson::json_pointer(name));
      schema.erase("$ref");
      schema.erase("allOf");
      whole.update(schema);
      schema = std::move(whole);
    }
    return schema;
  }

  static std::vector<PlainJson> forms(const PlainJson& schema) {
    for (const char* key : {"anyOf", "oneOf"}) {
      if (schema.contains(key) && !schema[key][0].contains("required")) return schema[key];
      if (schema.contains(key) && schema[key][0].contains("properties")) return schema[key];
    }
    return {};
  }

  /// A value that the schema accepts.
  PlainJson good_value(const PlainJson& given) const {
    const PlainJson schema = resolved_schema(given);
    if (schema.contains("const")) return schema["const"];
    if (schema.contains("default")) return schema["default"];
    if (schema.contains("examples")) return schema["examples"][0];
    if (const auto several = forms(schema); !several.empty()) return good_value(several[0]);
    if (schema.contains("enum")) return schema["enum"][0];
    const std::string type = schema["type"];
    if (type == "boolean") return true;
    if (type == "string") return good_text(schema);
    if (type == "array") return good_list(schema);
    if (type == "object") return good_object(schema, "", nullptr);
    if (schema.contains("minimum")) return schema["minimum"];
    const double low = schema["exclusiveMinimum"];
    const double high = schema.contains("maximum") ? schema["maximum"].get<double>()
                                                   : schema["exclusiveMaximum"].get<double>();
    return low + 0.5 * std::min(1.0, high - low);
  }

  static PlainJson good_text(const PlainJson& schema) {
    const std::string pattern = schema.value("pattern", "");
    if (pattern.find("h5") != pattern.npos) return "a.h5";
    return pattern.find("xyz") != pattern.npos ? "a.xyz" : "a";
  }

  PlainJson good_list(const PlainJson& schema) const {
    PlainJson list = PlainJson::array();
    if (!schema.contains("items")) return PlainJson::array({1});
    const PlainJson& items = schema["items"];
    const std::size_t n = schema.value("minItems", std::size_t{0});
    for (std::size_t i = 0; i < n; ++i) {
      PlainJson element = good_value(items.is_array() ? items[i] : items);
      if (n == 2 && i == 1 && element.is_number()) element = element.get<double>() + 0.1;
      list.push_back(std::move(element));
    }
    return list;
  }

  /// An object with the keys it requires, and with `key`.
  PlainJson good_object(const PlainJson& schema, const std::string& key,
                        const PlainJson* value) const {
    PlainJson object = PlainJson::object();
    if (value != nullptr) object[key] = *value;
    const auto add = [&](const std::string& name) {
      if (!object.contains(name)) object[name] = good_value(schema["properties"][name]);
    };
    for (const std::string& name : schema.value("required", std::vector<std::string>{})) add(name);
    if (schema.contains("oneOf")) {
      bool has_one = false;
      for (const PlainJson& alternative : schema["oneOf"])
        has_one = has_one || object.contains(alternative["required"][0].get<std::string>());
      if (!has_one) add(schema["oneOf"][0]["required"][0]);
    }
    const PlainJson properties = schema.value("properties", PlainJson::object());
    for (const auto& [name, unused] : properties.items()) {
      if (object.size() < schema.value("minProperties", std::size_t{0})) add(name);
    }
    const bool lacks_some = object.size() < schema.value("minProperties", std::size_t{0});
    if (lacks_some && schema.contains("patternProperties")) object["/spheres"] = {100};
    return object;
  }

  void visit(const PlainJson& given, const Place& place) {
    const PlainJson schema = resolved_schema(given);
    visit_(place, good_value(schema), true);
    visit_(place, nullptr, false);
    if (const auto several = forms(schema); !several.empty()) {
      for (const PlainJson& form : several) visit(form, place);
      return;
    }
    if (schema.contains("const")) return;
    if (schema.contains("enum")) return visit_(place, "no such word", false);
    const std::string type = schema["type"];
    if (type == "number" || type == "integer") visit_number(schema, place);
    if (type == "boolean") visit_(place, 1, false);
    if (type == "string" && schema.contains("pattern")) visit_(place, "?", false);
    if (type == "array") visit_list(schema, place);
    if (type == "object") visit_object(schema, place);
  }

  void visit_number(const PlainJson& schema, const Place& place) {
    if (schema["type"] == "integer") visit_(place, 1.5, false);
    if (schema.contains("minimum")) visit_(place, schema["minimum"].get<double>() - 1, false);
    if (schema.contains("exclusiveMinimum")) visit_(place, schema["exclusiveMinimum"], false);
    if (schema.contains("maximum")) visit_(place, 2.1 * schema["maximum"].get<double>(), false);
    if (schema.contains("exclusiveMaximum")) visit_(place, schema["exclusiveMaximum"], false);
  }

  void visit_list(const PlainJson& schema, const Place& place) {
    const std::size_t least = schema.value("minItems", std::size_t{0}),
                      most = schema.value("maxItems", std::size_t{2000});
    PlainJson list = good_list(schema);
    if (least > 0) visit_(place, PlainJson(list.begin(), list.begin() + (least - 1)), false);
    if (!schema.contains("items")) return;
    const PlainJson& items = schema["items"];
    if (most < 2000) {
      PlainJson longer = list;
      while (longer.size() <= most)
        longer.push_back(good_value(items.is_array() ? items[0] : items));
      visit_(place, longer, false);
    }
    const std::size_t n = items.is_array() ? items.size() : 1;
    for (std::size_t i = 0; i < n; ++i) {
      visit(items.is_array() ? items[i] : items,
            {place.pointer + "/" + std::to_string(i), [list, i, place](const PlainJson& value) {
               PlainJson changed = list;
               while (changed.size() <= i) changed.push_back(value);
               changed[i] = value;
               return place.put(changed);
             }});
    }
  }

  void visit_object(const PlainJson& schema, const Place& place) {
    PlainJson unknown = good_object(schema, "", nullptr);
    for (const std::string& name : schema.value("required", std::vector<std::string>{})) {
      PlainJson default_scene = unknown;
      default_scene.erase(name);
      visit_({place.pointer, place.put}, default_scene, false);
    }
    unknown["no_such_key"] = 1;
    visit_(place, unknown, false);
    if (!schema.contains("properties")) return;
    for (const auto& [key, member] : schema["properties"].items()) {
      if (const PlainJson whole = resolved_schema(member); whole.contains("default"))
        visit_default_(pointer_to(place.pointer, key),
                       place.put(good_object(schema, key, &whole["default"])),
                       place.put(good_object(schema, "", nullptr)));
      visit(member, {pointer_to(place.pointer, key),
                     [this, schema, key = key, place](const PlainJson& value) {
                       return place.put(good_object(schema, key, &value));
                     }});
    }
  }

  const PlainJson root_;
  const Visit visit_;
  const VisitDefault visit_default_;
};

}  // namespace

TEST_CASE("Reader and schema refuse what is out of range, of a wrong type, unknown or missing") {
  SchemaValidator schema;
  std::set<std::string> pointers;
  std::size_t n_refused = 0, n_accepted = 0;
  const auto visit = [&](const Place& place, const PlainJson& value, bool good) {
    const PlainJson scene = place.put(value);
    const ParsedScene parsed = parse_scene(scene.dump());
    INFO(place.pointer << " = " << value << "\nreader: " << lines(parsed.faults));
    pointers.insert(place.pointer);
    if (good) {
      CHECK(schema.accepts(scene));
      ++n_accepted;
      return;
    }
    CHECK_FALSE(schema.accepts(scene));
    // A width of a list of two is judged with the other: the fault is that of the list.
    const std::string parent = place.pointer.substr(0, place.pointer.rfind('/'));
    CHECK(std::ranges::any_of(parsed.faults, [&](const Fault& fault) {
      return is_within(fault.pointer, place.pointer) ||
             (parent.ends_with("/width") && fault.pointer == parent);
    }));
    ++n_refused;
  };
  FieldCases(PlainJson::parse(scene_schema()), visit,
             [](const std::string&, const PlainJson&, const PlainJson&) {})();
  CHECK(pointers.size() > 250);
  CHECK(n_refused > 700);
  CHECK(n_accepted > 250);
}

TEST_CASE("A key that is absent has the default of the schema") {
  std::size_t n_compared = 0;
  const auto compare = [&](const std::string& pointer, const PlainJson& written,
                           const PlainJson& absent) {
    const ParsedScene explicit_scene = parse_scene(written.dump()),
                      default_scene = parse_scene(absent.dump());
    INFO(pointer << "\n" << lines(explicit_scene.faults) << lines(default_scene.faults));
    CHECK(lines(explicit_scene.faults) == lines(default_scene.faults));
    CHECK(explicit_scene.scene == default_scene.scene);
    n_compared += explicit_scene.scene.has_value();
  };
  FieldCases(
      PlainJson::parse(scene_schema()), [](const Place&, const PlainJson&, bool) {}, compare)();
  CHECK(n_compared > 80);
}

}  // namespace jostle
