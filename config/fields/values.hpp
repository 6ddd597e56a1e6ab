#pragma once

#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/json/reader.hpp"
#include "engine/fields.hpp"

// How each form of a value is read, written and described in the schema: three functions a form.
// read_value() notes what does not suit as a fault and then gives false; written_value() gives what
// it reads; value_schema() gives the JSON Schema (draft-07) of what it accepts.
namespace jostle::inline config {

/// Shared schemas at one place, to which others refer.
class Definitions {
 public:
  /// A reference to the definition, which `describe` makes where it is not known yet; without a
  /// name what it makes itself.
  Json refer(std::string_view name, const std::function<Json()>& describe);
  const Json& all() const { return all_; }

 private:
  Json all_ = Json::object();
};

/// A number as a person writes it: 16, not 16.0.
Json plain_number(double value);
/// [low, high]
Json written_bounds(double low, double high);

bool read_value(const Number& form, const Reader& reader, double& target);
Json written_value(const Number& form, double value);
Json value_schema(const Number& form, Definitions& definitions);
/// "a number from 0 to 1"
std::string expected(const Number& form);
inline bool is_of_kind(const Number&, const Json& value) {
  return value.is_number();
}

inline Number number_of(const Strength& form) {
  return {form.range, form.unit};
}
inline bool read_value(const Strength& form, const Reader& reader, double& target) {
  return read_value(number_of(form), reader, target);
}
inline Json written_value(const Strength&, double value) {
  return plain_number(value);
}
inline Json value_schema(const Strength& form, Definitions& definitions) {
  return value_schema(number_of(form), definitions);
}

template <std::unsigned_integral Integer>
bool read_value(const Whole& form, const Reader& reader, Integer& target) {
  static_assert(!std::same_as<Integer, bool>);
  const auto whole = reader.whole_number(form.least, form.most);
  if (whole) target = static_cast<Integer>(*whole);
  return whole.has_value();
}
inline Json written_value(const Whole&, std::uint64_t value) {
  return value;
}
Json value_schema(const Whole& form, Definitions& definitions);
std::string expected(const Whole& form);
inline bool is_of_kind(const Whole&, const Json& value) {
  return value.is_number();
}

bool read_value(const Flag& form, const Reader& reader, bool& target);
inline Json written_value(const Flag&, bool value) {
  return value;
}
Json value_schema(const Flag& form, Definitions& definitions);

bool read_value(const Text& form, const Reader& reader, std::string& target);
inline Json written_value(const Text&, const std::string& value) {
  return value;
}
Json value_schema(const Text& form, Definitions& definitions);

/// Reads [low, high], each in its range, the first the lower.
std::optional<std::pair<double, double>> read_bounds(const Bounds& form, const Reader& reader);
template <class Slice>
bool read_value(const Bounds& form, const Reader& reader, Slice& target) {
  const auto read = read_bounds(form, reader);
  if (read) target = Slice{read->first, read->second};
  return read.has_value();
}
template <class Slice>
Json written_value(const Bounds&, const Slice& slice) {
  const auto& [low, high] = slice;
  return written_bounds(low, high);
}
Json value_schema(const Bounds& form, Definitions& definitions);

template <std::size_t n, class Enum>
std::string name_in(const std::array<std::pair<std::string_view, Enum>, n>& names, Enum value) {
  for (const auto& [name, enumerator] : names) {
    if (enumerator == value) return std::string(name);
  }
  throw std::logic_error("an enumerator that scenes have no name for");
}
template <std::size_t n, class Enum>
bool read_value(const Word<n, Enum>& form, const Reader& reader, Enum& target) {
  const auto found = reader.named(form.names);
  if (found) target = *found;
  return found.has_value();
}
template <std::size_t n, class Enum>
Json written_value(const Word<n, Enum>& form, Enum value) {
  return name_in(form.names, value);
}
/// {"enum": names}
Json words_schema(const std::vector<std::string>& words);
template <std::size_t n, class Enum>
Json value_schema(const Word<n, Enum>& form, Definitions&) {
  std::vector<std::string> words;
  for (const auto& [name, value] : form.names) words.emplace_back(name);
  return words_schema(words);
}

/// A schema with title, description, default and examples (a JSON list), where there are any.
Json described_as(Json schema, std::string_view title, std::string_view text,
                  const std::optional<Json>& otherwise, std::string_view examples);
/// The text with its unit, as a sentence: "Radius of the disc, diameters."
std::string sentence_of(std::string_view text, std::string_view unit);

/// The schema of an object.
struct ObjectSchema {
  Json properties = Json::object();
  std::vector<std::string> required;
  Json rules = Json::object();  // further rules

  /// Adds the schema of a key's value, with its text and its default.
  void add(std::string_view key, const Notes& notes, std::string_view text, Json value,
           std::optional<Json> otherwise);
  Json json() const;
};

/// The schema {"anyOf": [one, other]}.
Json either(Json first, Json second);
/// A schema that admits at most one of the keys.
Json at_most_one_of(const std::vector<std::string>& keys);

}  // namespace jostle::inline config
