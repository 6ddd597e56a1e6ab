#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "config/fields/values.hpp"

// The forms that hold parts: alternatives of a variant, a word in the place of a value, lists.
// Parts themselves are read, written and described in fields.hpp.
namespace jostle::inline config {

template <class Part>
concept HasForm = requires {
  Part::form;
};
/// A part that is a single value: its one field has no key.
template <class Part>
concept Bare = (std::tuple_size_v<decltype(Part::fields())> == 1) &&
               (std::get<0>(Part::fields()).key.empty());

template <class Type>
inline constexpr bool is_optional = false;
template <class Value>
inline constexpr bool is_optional<std::optional<Value>> = true;
/// Forms that read and write an optional as a whole.
template <class Form>
inline constexpr bool has_absence = false;
template <class Form>
inline constexpr bool has_absence<OrWord<Form>> = true;

template <class Part>
bool read_part(const Reader& reader, Part& part);
template <class Part>
Json written_part(const Part& part);
template <class Part>
Json part_schema(std::type_identity<Part> type, Definitions& definitions);

// Alternatives of a variant.

/// Calls act(std::type_identity<Alternative>) for each, in their order.
template <class Variant, class Act>
void for_each_alternative(const Act& act) {
  [&]<class... Parts>(std::type_identity<std::variant<Parts...>>) {
    (act(std::type_identity<Parts>{}), ...);
  }(std::type_identity<Variant>{});
}

/// The names of the alternatives, each once.
template <class Variant>
std::vector<std::string> names_of() {
  std::vector<std::string> names;
  for_each_alternative<Variant>([&]<class Part>(std::type_identity<Part>) {
    const std::string name(Part::description.name);
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  });
  return names;
}

template <class Variant>
std::string name_of(const Variant& value) {
  return std::visit([](const auto& part) { return std::string(part.description.name); }, value);
}

/// Reads the first alternative that has the name.
template <class Variant>
void read_alternative(std::string_view name, const Reader& settings, Variant& target) {
  bool found = false;
  for_each_alternative<Variant>([&]<class Part>(std::type_identity<Part>) {
    if (found || name != Part::description.name) return;
    found = true;
    Part part{};
    read_part(settings, part);
    target = std::move(part);
  });
}

template <class Variant>
Json written_settings(const Variant& value) {
  return std::visit([](const auto& part) { return written_part(part); }, value);
}

/// The schema of {"name": settings}; of alternatives that share a name, the first is described.
template <class Variant>
ObjectSchema alternatives_schema(Definitions& definitions) {
  ObjectSchema schema;
  for_each_alternative<Variant>([&]<class Part>(std::type_identity<Part> part) {
    if (schema.properties.contains(Part::description.name)) return;
    schema.properties[Part::description.name] =
        described_as(part_schema(part, definitions), Part::description.title,
                     sentence_of(Part::description.text, ""), std::nullopt, "");
  });
  schema.rules["minProperties"] = 1;
  schema.rules["maxProperties"] = 1;
  return schema;
}

// Forms that hold parts and other forms.

template <class Part>
bool read_value(const Object<Part>&, const Reader& reader, Part& target) {
  return read_part(reader, target);
}
template <class Part>
Json written_value(const Object<Part>&, const Part& part) {
  return written_part(part);
}
template <class Part>
Json value_schema(const Object<Part>& form, Definitions& definitions) {
  return definitions.refer(form.definition,
                           [&] { return part_schema(std::type_identity<Part>{}, definitions); });
}
template <class Part>
std::string expected(const Object<Part>&) {
  return "an object";
}
template <class Part>
bool is_of_kind(const Object<Part>&, const Json& value) {
  return value.is_object();
}

template <class Variant>
bool read_value(const OneOf<Variant>& form, const Reader& reader, Variant& target) {
  const auto names = names_of<Variant>();
  const auto choice = form.by_name ? reader.named_choice(names) : reader.choice(names);
  if (choice) read_alternative(choice->name, choice->settings, target);
  return choice.has_value();
}
/// An alternative without settings is its name alone, where that may stand for it.
template <class Variant>
Json written_value(const OneOf<Variant>& form, const Variant& value) {
  Json settings = written_settings(value);
  if (form.by_name && settings.is_object() && settings.empty()) return name_of(value);
  return {{name_of(value), std::move(settings)}};
}
template <class Variant>
Json value_schema(const OneOf<Variant>& form, Definitions& definitions) {
  return definitions.refer(form.definition, [&] {
    Json choice = alternatives_schema<Variant>(definitions).json();
    return form.by_name ? either(words_schema(names_of<Variant>()), std::move(choice)) : choice;
  });
}

/// Notes a value that is neither of the form nor the word in its place.
template <class Form>
bool is_of_kind(const OrWord<Form>& form, const Reader& reader) {
  if (is_of_kind(form.form, reader.value())) return true;
  reader.wrong_type(expected(form.form) + ", or \"" + std::string(form.word) + '"');
  return false;
}
template <class Form, class Value>
bool read_value(const OrWord<Form>& form, const Reader& reader, std::optional<Value>& target) {
  const bool is_word = reader.value() == Json(form.word);
  target.reset();
  return is_word || (is_of_kind(form, reader) && read_value(form.form, reader, target.emplace()));
}
template <class Form, class Value>
Json written_value(const OrWord<Form>& form, const std::optional<Value>& value) {
  return value ? written_value(form.form, *value) : Json(form.word);
}
template <class Form>
bool read_value(const OrWord<Form>& form, const Reader& reader, double& target) {
  const bool is_word = reader.value() == Json(form.word);
  if (is_word) target = std::numeric_limits<double>::infinity();
  return is_word || (is_of_kind(form, reader) && read_value(form.form, reader, target));
}
template <class Form>
Json written_value(const OrWord<Form>& form, double value) {
  return value == std::numeric_limits<double>::infinity() ? Json(form.word)
                                                          : written_value(form.form, value);
}
template <class Form>
Json value_schema(const OrWord<Form>& form, Definitions& definitions) {
  return either(value_schema(form.form, definitions), {{"const", form.word}});
}

template <class Form, class Value>
bool read_value(const ListOf<Form>& form, const Reader& reader, std::vector<Value>& target) {
  if (!reader.is_list(form.least, form.most, form.of_what)) return false;
  target.clear();
  for (std::size_t i = 0; i < reader.value().size(); ++i) {
    const Reader element = reader.element(i);
    Value value{};
    const bool read = read_value(form.form, element, value);
    if constexpr (std::is_arithmetic_v<Value>) {
      if (form.ascending && !read) continue;
      if (form.ascending && std::ranges::find(target, value) != target.end())
        element.fault(written_value(form.form, value).dump() + " is listed twice");
    }
    target.push_back(std::move(value));
  }
  if constexpr (std::is_arithmetic_v<Value>) {
    if (form.ascending) std::ranges::sort(target);
  }
  return true;
}
template <class Form, class Value>
Json written_value(const ListOf<Form>& form, const std::vector<Value>& values) {
  Json list = Json::array();
  for (const Value& value : values) list.push_back(written_value(form.form, value));
  return list;
}
template <class Form>
Json value_schema(const ListOf<Form>& form, Definitions& definitions) {
  Json schema{{"type", "array"}};
  if (form.least > 0) schema["minItems"] = form.least;
  schema["maxItems"] = form.most;
  if (form.ascending) schema["uniqueItems"] = true;
  schema["items"] = value_schema(form.form, definitions);
  return schema;
}

/// A default in its shortest form: {} for a part whose keys all have defaults, and the name alone
/// for an alternative whose settings have.
template <class Form, class Value>
Json written_default(const Form& form, const Value& value) {
  return written_value(form, value);
}
template <class Part>
Json written_default(const Object<Part>&, const Part&) {
  return Json::object();
}
template <class Variant>
Json written_default(const OneOf<Variant>& form, const Variant& value) {
  const bool has_defaults =
      std::visit([]<class Part>(const Part& part) { return part == Part{}; }, value);
  return form.by_name && has_defaults ? Json(name_of(value)) : written_value(form, value);
}
template <class Form, class Value>
Json written_default(const ListOf<Form>& form, const std::vector<Value>& values) {
  Json list = Json::array();
  for (const Value& value : values) list.push_back(written_default(form.form, value));
  return list;
}

}  // namespace jostle::inline config
