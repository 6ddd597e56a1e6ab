#include <algorithm>

#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

/// Any positive width is accepted here: the engine reports widths that are too narrow.
Number positive(Number form) {
  form.range = left_open_range(0, form.range.high);
  return form;
}

/// Notes what the engine finds wrong with a box that has the width under the key, and else
/// defaults.
template <class Box>
void note_width(const Box& box, std::string_view key, const Reader& reader) {
  const auto member = reader.find(std::string(key));
  if (!member || !member->sound()) return;
  if (const auto fault = width_fault(box)) member->fault(*fault);
}

template <class Box>
void read_width(const Field<Box, double, Number>& field, const Reader& reader, Box& box) {
  Field<Box, double, Number> wide = field;
  wide.form = positive(field.form);
  read_field(wide, reader, box);
  Box alone{};
  alone.*field.member = box.*field.member;
  note_width(alone, field.key, reader);
}

template <class Box>
void read_width(const NumberPair<Box>& field, const Reader& reader, Box& box) {
  const auto width = reader.find(std::string(field.key));
  if (!width) return reader.missing(field.key, field.required);
  const Number form = positive(field.form);
  if (!width->value().is_array()) {
    read_value(form, *width, box.*field.first);
    box.*field.second = box.*field.first;
  } else if (width->is_list(2, 2, "numbers")) {
    read_value(form, width->element(0), box.*field.first);
    read_value(form, width->element(1), box.*field.second);
  }
  Box alone{};
  alone.*field.first = box.*field.first;
  alone.*field.second = box.*field.second;
  note_width(alone, field.key, reader);
}

/// "periodic; walls: four vertical planes; ...".
std::string texts_of_kinds() {
  std::string texts;
  for_each_alternative<Container>([&]<class Box>(std::type_identity<Box>) {
    texts.append(texts.empty() ? "" : "; ").append(Box::description.name);
    if (!Box::description.text.empty()) texts.append(": ").append(Box::description.text);
  });
  return texts + ".";
}

}  // namespace

template <class Box>
void add_keys(const NumberPair<Box>& field, std::vector<std::string>& keys) {
  keys.emplace_back(field.key);
}
template <class Box>
void write_field(const NumberPair<Box>& field, const Box& box, Json& json) {
  const double first = box.*field.first, second = box.*field.second;
  json[field.key] = first == second ? plain_number(first) : written_bounds(first, second);
}
template <class Box>
void describe_field(const NumberPair<Box>& field, ObjectSchema& schema, Definitions& definitions) {
  const Json number = value_schema(field.form, definitions);
  const Json pair{{"type", "array"}, {"minItems", 2}, {"maxItems", 2}, {"items", number}};
  schema.properties[field.key] = described_as(either(number, pair), "", sentence_of(field.text, ""),
                                              std::nullopt, "[16, [12, 12.124355652982141]]");
  schema.required.emplace_back(field.key);
}

bool read_value(const OneOf<Container>&, const Reader& reader, Container& target) {
  const auto sides = reader.find("sides");
  const std::vector<std::string> names = names_of<Container>();
  const auto kind = sides ? sides->one_of(names) : std::nullopt;
  std::vector<std::string> keys{"sides"};
  for_each_alternative<Container>([&]<class Box>(std::type_identity<Box>) {
    if (kind && *kind != Box::description.name) return;
    for (std::string& key : keys_of(Box::fields()))
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(std::move(key));
  });
  if (!reader.is_object_of(keys)) return false;
  if (!sides) reader.missing("sides", "one of the strings " + listed(names));
  if (!kind) return false;
  for_each_alternative<Container>([&]<class Box>(std::type_identity<Box>) {
    if (*kind != Box::description.name) return;
    Box box{};
    std::apply([&](const auto&... field) { (read_width(field, reader, box), ...); }, Box::fields());
    target = box;
  });
  return true;
}

Json written_value(const OneOf<Container>&, const Container& container) {
  Json json{{"sides", name_of(container)}};
  json.update(written_settings(container));
  return json;
}

Json value_schema(const OneOf<Container>&, Definitions& definitions) {
  Json boxes = Json::array();
  for_each_alternative<Container>([&]<class Box>(std::type_identity<Box>) {
    ObjectSchema box = object_schema(Box::fields(), definitions);
    box.required.insert(box.required.begin(), "sides");
    box.properties["sides"] = {{"const", Box::description.name}};
    boxes.push_back(described_as(box.json(), Box::description.title, "", std::nullopt, ""));
  });
  const Json sides = described_as(words_schema(names_of<Container>()), "Sides", texts_of_kinds(),
                                  std::nullopt, "");
  return {{"type", "object"},
          {"required", Json::array({"sides"})},
          {"properties", {{"sides", sides}}},
          {"oneOf", boxes}};
}

}  // namespace jostle::inline config
