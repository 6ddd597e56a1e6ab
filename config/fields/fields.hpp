#pragma once

#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "config/fields/forms.hpp"

// Reads, writes and describes parts by their lists of fields (engine/fields.hpp). A part that
// scenes write in a form of its own has three functions of its own, which are taken in place of the
// templates here: read_part(), written_part(), part_schema(). part_fault() of a part describes
// contradictions of fields that are valid one by one.
namespace jostle::inline config {

/// A field that no form describes: its value is read from the part's object,
/// written to it and described by functions of its own.
template <class Read, class Write, class Describe>
struct IrregularField {
  std::string_view key;
  Read read;          // (const Reader& object, Part&)
  Write write;        // (const Part&, Json& object)
  Describe describe;  // (ObjectSchema&, Definitions&)
};
template <class Read, class Write, class Describe>
constexpr IrregularField<Read, Write, Describe> irregular(std::string_view key, Read read,
                                                          Write write, Describe describe) {
  return {key, read, write, describe};
}

// Fields.

template <class Form>
std::string_view unit_of(const Form&) {
  return "";
}
inline std::string_view unit_of(const Number& form) {
  return form.unit;
}
inline std::string_view unit_of(const Strength& form) {
  return form.unit;
}

template <class Part, class Value, class Form>
void add_keys(const Field<Part, Value, Form>& field, std::vector<std::string>& keys) {
  keys.emplace_back(field.key);
}
template <class Part, class Value, class Form>
void read_field(const Field<Part, Value, Form>& field, const Reader& reader, Part& part) {
  const auto member = reader.member(field.key, field.notes.required);
  if (!member) return;
  if constexpr (is_optional<Value> && !has_absence<Form>) {
    typename Value::value_type value{};
    const bool read = read_value(field.form, *member, value);
    part.*field.member = read ? Value(std::move(value)) : Value();
  } else {
    read_value(field.form, *member, part.*field.member);
  }
}
template <class Part, class Value, class Form>
void write_field(const Field<Part, Value, Form>& field, const Part& part, Json& json) {
  const Value& value = part.*field.member;
  if constexpr (is_optional<Value> && !has_absence<Form>) {
    if (value) json[field.key] = written_value(field.form, *value);
  } else {
    if (field.notes.unless_default && value == Part{}.*field.member) return;
    json[field.key] = written_value(field.form, value);
  }
}
template <class Part, class Value, class Form>
void describe_field(const Field<Part, Value, Form>& field, ObjectSchema& schema,
                    Definitions& definitions) {
  std::optional<Json> otherwise;
  if constexpr (!is_optional<Value> || has_absence<Form>) {
    if (field.notes.required.empty()) otherwise = written_default(field.form, Part{}.*field.member);
  }
  schema.add(field.key, field.notes, sentence_of(field.text, unit_of(field.form)),
             value_schema(field.form, definitions), std::move(otherwise));
}

template <class Part, class Inner>
void add_keys(const Inlined<Part, Inner>&, std::vector<std::string>& keys) {
  std::apply([&](const auto&... field) { (add_keys(field, keys), ...); }, Inner::fields());
}
template <class Part, class Inner>
void read_field(const Inlined<Part, Inner>& inner, const Reader& reader, Part& part) {
  std::apply([&](const auto&... field) { (read_field(field, reader, part.*inner.member), ...); },
             Inner::fields());
}
template <class Part, class Inner>
void write_field(const Inlined<Part, Inner>& inner, const Part& part, Json& json) {
  std::apply([&](const auto&... field) { (write_field(field, part.*inner.member, json), ...); },
             Inner::fields());
}
template <class Part, class Inner>
void describe_field(const Inlined<Part, Inner>&, ObjectSchema& schema, Definitions& definitions) {
  std::apply([&](const auto&... field) { (describe_field(field, schema, definitions), ...); },
             Inner::fields());
}

template <class Part, class Variant>
void add_keys(const Alternative<Part, Variant>&, std::vector<std::string>& keys) {
  for (std::string& name : names_of<Variant>()) keys.push_back(std::move(name));
}
template <class Part, class Variant>
void read_field(const Alternative<Part, Variant>& field, const Reader& reader, Part& part) {
  const auto names = names_of<Variant>();
  std::size_t given = 0;
  for (const std::string& name : names) {
    if (const auto settings = reader.find(name)) {
      read_alternative(name, *settings, part.*field.member);
      ++given;
    }
  }
  if (given > 1) reader.fault("expected only one of the keys " + listed(names));
}
template <class Part, class Variant>
void write_field(const Alternative<Part, Variant>& field, const Part& part, Json& json) {
  json[name_of(part.*field.member)] = written_settings(part.*field.member);
}
template <class Part, class Variant>
void describe_field(const Alternative<Part, Variant>& field, ObjectSchema& schema,
                    Definitions& definitions) {
  const ObjectSchema alternatives = alternatives_schema<Variant>(definitions);
  schema.properties.update(alternatives.properties);
  schema.rules.update(at_most_one_of(names_of<Variant>()));
  const Variant otherwise = Part{}.*field.member;
  if (const Json value = written_settings(otherwise); !value.is_object())
    schema.properties[name_of(otherwise)]["default"] = value;
}

template <class Part, class Kind, std::size_t n>
void add_keys(const KeyedNumber<Part, Kind, n>& field, std::vector<std::string>& keys) {
  for (const auto& [key, kind] : field.keys) keys.emplace_back(key);
}
/// The one of a number's keys that is given, after noting what is wrong with them.
template <class Part, class Kind, std::size_t n>
std::optional<Reader> read_kind(const KeyedNumber<Part, Kind, n>& field, const Reader& reader,
                                Part& part) {
  std::vector<std::string> keys;
  add_keys(field, keys);
  std::size_t given = 0;
  std::optional<Reader> number;
  for (const auto& [key, kind] : field.keys) {
    if (const auto member = reader.find(std::string(key))) {
      number = member;
      part.*field.kind = kind;
      ++given;
    }
  }
  if (given > 1) reader.fault("expected only one of the keys " + listed(keys));
  if (given == 0 && field.required) reader.fault("expected one of the keys " + listed(keys));
  return number;
}
template <class Part, class Kind, std::size_t n>
void read_field(const KeyedNumber<Part, Kind, n>& field, const Reader& reader, Part& part) {
  const auto number = read_kind(field, reader, part);
  if (!number) return;
  for (std::size_t i = 0; i < n; ++i) {
    if (field.keys[i].second == part.*field.kind)
      read_value(field.forms[i], *number, part.*field.value);
  }
}
template <class Part, class Kind, std::size_t n>
void write_field(const KeyedNumber<Part, Kind, n>& field, const Part& part, Json& json) {
  json[name_in(field.keys, part.*field.kind)] = plain_number(part.*field.value);
}
/// Describes every key by describe(form, text, default).
template <class Part, class Kind, std::size_t n, class Describe>
void describe_kinds(const KeyedNumber<Part, Kind, n>& field, bool required, ObjectSchema& schema,
                    const Describe& describe) {
  std::vector<std::string> keys;
  Json one_each = Json::array();
  for (std::size_t i = 0; i < n; ++i) {
    const auto& [key, kind] = field.keys[i];
    std::optional<Json> otherwise;
    if (!required && kind == Part{}.*field.kind) otherwise = plain_number(Part{}.*field.value);
    schema.properties[key] = describe(field.forms[i], field.texts[i], otherwise);
    one_each.push_back({{"required", Json::array({key})}});
    keys.emplace_back(key);
  }
  if (required) {
    schema.rules["oneOf"] = one_each;
  } else {
    schema.rules.update(at_most_one_of(keys));
  }
}
template <class Part, class Kind, std::size_t n>
void describe_field(const KeyedNumber<Part, Kind, n>& field, ObjectSchema& schema,
                    Definitions& definitions) {
  describe_kinds(field, field.required, schema,
                 [&](const Number& form, std::string_view text, const auto& otherwise) {
                   return described_as(value_schema(form, definitions), "",
                                       sentence_of(text, form.unit), otherwise, "");
                 });
}

template <class Read, class Write, class Describe>
void add_keys(const IrregularField<Read, Write, Describe>& field, std::vector<std::string>& keys) {
  keys.emplace_back(field.key);
}
template <class Read, class Write, class Describe, class Part>
void read_field(const IrregularField<Read, Write, Describe>& field, const Reader& reader,
                Part& part) {
  field.read(reader, part);
}
template <class Read, class Write, class Describe, class Part>
void write_field(const IrregularField<Read, Write, Describe>& field, const Part& part, Json& json) {
  field.write(part, json);
}
template <class Read, class Write, class Describe>
void describe_field(const IrregularField<Read, Write, Describe>& field, ObjectSchema& schema,
                    Definitions& definitions) {
  field.describe(schema, definitions);
}

// Parts.

template <class Fields>
std::vector<std::string> keys_of(const Fields& fields) {
  std::vector<std::string> keys;
  std::apply([&](const auto&... field) { (add_keys(field, keys), ...); }, fields);
  return keys;
}
/// Reads the fields of an object; false where it is none.
template <class Fields, class Part>
bool read_object(const Fields& fields, const Reader& reader, Part& part) {
  if (!reader.is_object_of(keys_of(fields))) return false;
  std::apply([&](const auto&... field) { (read_field(field, reader, part), ...); }, fields);
  return true;
}
template <class Fields, class Part>
Json written_object(const Fields& fields, const Part& part) {
  Json json = Json::object();
  std::apply([&](const auto&... field) { (write_field(field, part, json), ...); }, fields);
  return json;
}
template <class Fields>
ObjectSchema object_schema(const Fields& fields, Definitions& definitions) {
  ObjectSchema schema;
  std::apply([&](const auto&... field) { (describe_field(field, schema, definitions), ...); },
             fields);
  return schema;
}

template <class Part>
bool read_part(const Reader& reader, Part& part) {
  if constexpr (HasForm<Part>) {
    return read_value(Part::form, reader, part);
  } else if constexpr (Bare<Part>) {
    constexpr auto only = std::get<0>(Part::fields());
    return read_value(only.form, reader, part.*only.member);
  } else {
    if (!read_object(Part::fields(), reader, part)) return false;
    if constexpr (requires { part_fault(part); }) {
      const std::optional<std::string> fault = reader.sound() ? part_fault(part) : std::nullopt;
      if (fault) reader.fault(*fault);
    }
    return true;
  }
}
template <class Part>
Json written_part(const Part& part) {
  if constexpr (HasForm<Part>) {
    return written_value(Part::form, part);
  } else if constexpr (Bare<Part>) {
    constexpr auto only = std::get<0>(Part::fields());
    return written_value(only.form, part.*only.member);
  } else {
    return written_object(Part::fields(), part);
  }
}
template <class Part>
Json part_schema(std::type_identity<Part>, Definitions& definitions) {
  if constexpr (HasForm<Part>) {
    return value_schema(Part::form, definitions);
  } else if constexpr (Bare<Part>) {
    constexpr auto only = std::get<0>(Part::fields());
    return described_as(value_schema(only.form, definitions), "", "", std::nullopt,
                        only.notes.examples);
  } else {
    return object_schema(Part::fields(), definitions).json();
  }
}

}  // namespace jostle::inline config
