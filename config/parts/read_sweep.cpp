#include <fmt/format.h>

#include <algorithm>

#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

constexpr std::size_t most_values = 100'000;

/// Numbers as plain_number writes them, so that 8 and 8.0 are one value.
Json with_plain_numbers(const Json& value) {
  if (value.is_number() && !value.is_number_integer()) return plain_number(value.number());
  if (!value.is_structured()) return value;
  Json plain = value.is_array() ? Json::array() : Json::object();
  if (value.is_array()) {
    for (const Json& element : value.elements()) plain.push_back(with_plain_numbers(element));
  } else {
    for (const auto& [key, member] : value.members()) plain[key] = with_plain_numbers(member);
  }
  return plain;
}

/// One pointer with its values, put at the end of an axis.
void read_column(const Reader& reader, const std::string& pointer, SweepAxis& axis) {
  if (!pointer.starts_with('/')) {
    reader.fault("expected a JSON pointer, which begins with /");
    return;
  }
  if (!reader.is_list(1, most_values, "values")) return;
  auto& [name, values] = axis.columns.emplace_back();
  name = pointer;
  for (const Json& value : reader.value().elements()) values.push_back(with_plain_numbers(value));
}

/// {"/a": [...], "/b": [...]}: lists of one length that vary together.
void read_zipped(const Reader& reader, std::vector<SweepAxis>& sweep) {
  if (!reader.value().is_object() || reader.value().empty()) {
    reader.fault("expected an object of JSON pointers with lists of values, found " +
                 described(reader.value()));
    return;
  }
  SweepAxis axis;
  for (const auto& [pointer, values] : reader.value().members()) {
    read_column(*reader.find(pointer), pointer, axis);
  }
  const bool uneven =
      std::any_of(axis.columns.begin(), axis.columns.end(),
                  [&](const auto& column) { return column.second.size() != axis.size(); });
  if (uneven) {
    std::vector<std::string> lengths;
    for (const auto& [pointer, values] : axis.columns) {
      lengths.push_back(fmt::format("{} has {}", pointer, values.size()));
    }
    reader.fault("zipped lists must have the same length: " + listed(lengths));
    return;
  }
  if (axis.size() > 0) sweep.push_back(std::move(axis));
}

}  // namespace

bool read_value(const SweptPointers&, const Reader& reader, std::vector<SweepAxis>& sweep) {
  if (!reader.value().is_object()) {
    reader.fault("expected an object of JSON pointers with lists of values, found " +
                 described(reader.value()));
    return false;
  }
  for (const auto& [key, value] : reader.value().members()) {
    const Reader member = *reader.find(key);
    if (key == "zip" && value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i) read_zipped(member.element(i), sweep);
    } else if (key == "zip") {
      read_zipped(member, sweep);
    } else if (!key.starts_with('/')) {
      member.fault("expected a JSON pointer, which begins with /, or \"zip\"");
    } else {
      SweepAxis axis;
      read_column(member, key, axis);
      if (axis.size() > 0) sweep.push_back(std::move(axis));
    }
  }
  return true;
}

Json written_value(const SweptPointers&, const std::vector<SweepAxis>& sweep) {
  Json json = Json::object();
  // A later axis must not overtake an earlier one: from the first zipped axis on, all are zipped.
  bool zipped = false;
  for (const SweepAxis& axis : sweep) {
    zipped = zipped || axis.columns.size() > 1;
    Json columns = Json::object();
    for (const auto& [pointer, values] : axis.columns) columns[pointer] = values;
    if (zipped) {
      json["zip"].push_back(columns);
    } else {
      json.update(columns);
    }
  }
  return json;
}

Json value_schema(const SweptPointers&, Definitions&) {
  const Json values{{"type", "array"}, {"minItems", 1}, {"maxItems", most_values}};
  const Json pointers{{"^/", values}};
  const Json zipped{{"description", "Lists of one length whose values vary together."},
                    {"type", "object"},
                    {"minProperties", 1},
                    {"additionalProperties", false},
                    {"patternProperties", pointers}};
  return {{"type", "object"},
          {"additionalProperties", false},
          {"patternProperties", pointers},
          {"properties", {{"zip", either(zipped, {{"type", "array"}, {"items", zipped}})}}}};
}

}  // namespace jostle::inline config
