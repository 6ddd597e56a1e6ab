#include "config/fields/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline config {

namespace {

std::string allowed(Range range) {
  if (range.low_included && range.high_included) {
    return finite_text("from {} to {}", range.low, range.high);
  }
  return finite_text("{} {} and {} {}", range.low_included ? "at least" : "above", range.low,
                     range.high_included ? "at most" : "below", range.high);
}

/// Tests if the character is in a class: "a-z0-9_".
bool is_in(std::string_view characters, char c) {
  for (std::size_t i = 0; i < characters.size(); ++i) {
    const bool is_range = i + 2 < characters.size() && characters[i + 1] == '-';
    if (is_range ? c >= characters[i] && c <= characters[i + 2] : c == characters[i]) return true;
    if (is_range) i += 2;
  }
  return false;
}

bool is_right(const Text& form, std::string_view text) {
  return !text.empty() && text.size() <= form.longest && is_in(form.first, text.front()) &&
         std::ranges::all_of(text, [&](char c) { return is_in(form.rest, c); });
}

}  // namespace

Json Definitions::refer(std::string_view name, const std::function<Json()>& describe) {
  if (name.empty()) return describe();
  if (!all_.contains(name)) {
    all_[name] = Json();  // keeps its place before those that it refers to
    all_[name] = describe();
  }
  return {{"$ref", fmt::format("#/definitions/{}", name)}};
}

Json plain_number(double value) {
  if (value == std::trunc(value) && std::abs(value) < 0x1p53) {
    return static_cast<std::int64_t>(value);
  }
  return value;
}

Json written_bounds(double low, double high) {
  return Json::array({plain_number(low), plain_number(high)});
}

std::string expected(const Number& form) {
  return "a number " + allowed(form.range);
}

bool read_value(const Number& form, const Reader& reader, double& target) {
  if (!reader.value().is_number()) {
    reader.wrong_type(expected(form));
    return false;
  }
  const double number = reader.value().number();
  if (form.range.contains(number)) {
    target = number;
    return true;
  }
  reader.fault(fmt::format("{} is out of range: expected {}", canonical_text(reader.value()),
                           expected(form)));
  return false;
}

Json written_value(const Number&, double value) {
  return plain_number(value);
}

Json value_schema(const Number& form, Definitions&) {
  const Range& range = form.range;
  return {{"type", "number"},
          {range.low_included ? "minimum" : "exclusiveMinimum", plain_number(range.low)},
          {range.high_included ? "maximum" : "exclusiveMaximum", plain_number(range.high)}};
}

std::string expected(const Whole& form) {
  return fmt::format("a whole number from {} to {}", form.least, form.most);
}

Json value_schema(const Whole& form, Definitions&) {
  Json schema{{"type", "integer"}, {"minimum", form.least}};
  if (form.most < std::numeric_limits<std::uint64_t>::max()) {
    schema["maximum"] = form.most;
  } else {  // beyond what most validators hold in an integer
    schema["exclusiveMaximum"] = 0x1p64;
  }
  return schema;
}

bool read_value(const Flag&, const Reader& reader, bool& target) {
  const auto value = reader.boolean();
  target = value.value_or(target);
  return value.has_value();
}

Json value_schema(const Flag&, Definitions&) {
  return {{"type", "boolean"}};
}

bool read_value(const Text& form, const Reader& reader, std::string& target) {
  const auto text = reader.text();
  if (!text) return false;
  target = *text;
  if (form.first.empty() || is_right(form, target)) return true;
  reader.fault(std::string(form.rule));
  return false;
}

Json value_schema(const Text& form, Definitions&) {
  Json schema{{"type", "string"}};
  if (form.first.empty()) return schema;
  schema["maxLength"] = form.longest;
  schema["pattern"] = fmt::format("^[{}][{}]*$", form.first, form.rest);
  return schema;
}

std::optional<std::pair<double, double>> read_bounds(const Bounds& form, const Reader& reader) {
  if (!reader.is_list(2, 2, form.numbers)) return std::nullopt;
  double low = 0, high = 0;
  const bool low_read = read_value(Number{form.low}, reader.element(0), low);
  const bool high_read = read_value(Number{form.high}, reader.element(1), high);
  if (!low_read || !high_read) return std::nullopt;
  if (low < high) return std::pair{low, high};
  reader.fault(finite_text("the {} from {} to {} is empty: {}", form.slice, low, high, form.rule));
  return std::nullopt;
}

Json value_schema(const Bounds& form, Definitions& definitions) {
  const Json low = value_schema(Number{form.low}, definitions),
             high = value_schema(Number{form.high}, definitions);
  return {{"type", "array"},
          {"minItems", 2},
          {"maxItems", 2},
          {"items", low == high ? low : Json::array({low, high})}};
}

Json words_schema(const std::vector<std::string>& words) {
  return {{"enum", words}};
}

Json described_as(Json schema, std::string_view title, std::string_view text,
                  const std::optional<Json>& otherwise, std::string_view examples) {
  Json json = Json::object();
  if (!title.empty()) json["title"] = title;
  if (!text.empty()) json["description"] = text;
  if (otherwise || !json.empty() || !examples.empty()) {
    // Draft-07 ignores keys beside a reference.
    if (schema.contains("$ref")) schema = Json{{"allOf", Json::array({schema})}};
  }
  for (const auto& [key, value] : schema.members()) {
    if (!json.contains(key)) json[key] = value;
  }
  if (otherwise) json["default"] = *otherwise;
  if (!examples.empty()) json["examples"] = Json::parse(examples);
  return json;
}

std::string sentence_of(std::string_view text, std::string_view unit) {
  if (text.empty() && unit.empty()) return "";
  std::string sentence(text);
  if (!text.empty() && !unit.empty()) sentence += ", ";
  sentence += unit;
  return sentence.ends_with('.') ? sentence : sentence + '.';
}

void ObjectSchema::add(std::string_view key, const Notes& notes, std::string_view text, Json value,
                       std::optional<Json> otherwise) {
  // A value that is written only where it is not the default needs no default in the schema if
  // that is empty.
  if (notes.unless_default && otherwise && (*otherwise == Json("") || *otherwise == Json::object()))
    otherwise.reset();
  properties[key] = described_as(std::move(value), notes.title, text, otherwise, notes.examples);
  if (!notes.required.empty()) required.emplace_back(key);
}

Json ObjectSchema::json() const {
  Json schema{{"type", "object"}};
  if (!required.empty()) schema["required"] = required;
  schema["additionalProperties"] = false;
  schema.update(rules);
  if (!properties.empty()) schema["properties"] = properties;
  return schema;
}

Json either(Json first, Json second) {
  return {{"anyOf", Json::array({std::move(first), std::move(second)})}};
}

Json at_most_one_of(const std::vector<std::string>& keys) {
  Json pairs = Json::array();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      pairs.push_back({{"required", Json::array({keys[j], keys[i]})}});
    }
  }
  if (pairs.size() == 1) return {{"not", pairs.at(0)}};
  const Json any = {{"anyOf", pairs}};
  return {{"not", any}};
}

}  // namespace jostle::inline config
