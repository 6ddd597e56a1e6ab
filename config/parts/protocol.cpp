#include <fmt/format.h>

#include <cmath>

#include "config/grids.hpp"
#include "config/parts/parts.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline config {

namespace {

constexpr std::uint64_t most_strengths = 1000;
constexpr Range root_range = closed_range(0, 3);

/// {"from", "to", "step"} or, for what is best stepped in its square root, {"sqrt_from", ...}.
constexpr auto ramp_fields(Range range, RampScale scale) {
  const bool rooted = scale == RampScale::square_root;
  constexpr std::string_view plain = "a ramp has the keys from, to, step",
                             roots = "a ramp has the keys sqrt_from, sqrt_to, sqrt_step";
  const Notes notes{.required = rooted ? roots : plain};
  return std::tuple{
      field(rooted ? "sqrt_from" : "from", &Ramp::start, Number{range},
            rooted ? "Square root of the first strength" : "First strength", notes),
      field(rooted ? "sqrt_to" : "to", &Ramp::end, Number{range},
            rooted ? "Square root of the last strength" : "Last strength", notes),
      field(rooted ? "sqrt_step" : "step", &Ramp::step, Number{left_open_range(0, range.high)},
            rooted ? "Step of the square root" : "Step of the strength", notes)};
}

bool read_ramp(const Strength& form, const Reader& reader, Ramp& ramp) {
  const auto plain = ramp_fields(form.range, RampScale::linear),
             rooted = ramp_fields(root_range, RampScale::square_root);
  bool in_roots = false;
  std::vector<std::string> allowed = keys_of(plain);
  for (const std::string& key : keys_of(rooted)) {
    in_roots = in_roots || (form.in_roots && reader.find(key));
    if (form.in_roots) allowed.push_back(key);
  }
  if (in_roots) allowed = keys_of(rooted);
  if (!reader.is_object_of(allowed)) return false;
  ramp.scale = in_roots ? RampScale::square_root : RampScale::linear;
  std::apply([&](const auto&... field) { (read_field(field, reader, ramp), ...); },
             in_roots ? rooted : plain);
  if (!reader.sound()) return false;
  const auto steps = whole_steps(ramp);
  if (!steps) {
    const double step = ramp.start > ramp.end ? -ramp.step : ramp.step;
    const double last_strength = ramp.start + std::floor((ramp.end - ramp.start) / step) * step;
    reader.fault(
        finite_text("steps of {} from {} do not reach {} but {:.6g} and {:.6g}: both ends are "
                    "included, so the step must divide the distance",
                    ramp.step, ramp.start, ramp.end, last_strength, last_strength + step));
  } else if (*steps >= most_strengths) {
    reader.fault(fmt::format("{} strengths: a ramp has at most {}", *steps + 1, most_strengths));
  }
  return true;
}

Json written_ramp(const Ramp& ramp) {
  return written_object(ramp_fields(root_range, ramp.scale), ramp);
}

Json ramp_schema(const Strength& form, Definitions& definitions) {
  const std::string name = fmt::format("ramp{}_to_{}", form.in_roots ? "_in_roots" : "",
                                       canonical_text(plain_number(form.range.high)));
  return definitions.refer(name, [&] {
    const auto schema_of = [&](Range range, RampScale scale) {
      return object_schema(ramp_fields(range, scale), definitions).json();
    };
    const Json plain = schema_of(form.range, RampScale::linear);
    if (!form.in_roots)
      return described_as(plain, "", "", std::nullopt,
                          R"([{"from": 0.1, "to": 0.5, "step": 0.05}])");
    return described_as(either(plain, schema_of(root_range, RampScale::square_root)), "", "",
                        std::nullopt,
                        R"([{"sqrt_from": 0.025, "sqrt_to": 0.4, "sqrt_step": 0.025}])");
  });
}

// A tap in a ramp: as the tap alone, with a ramp in the place of its strength.

constexpr std::string_view ramp_required =
    "the strength of a tap in a ramp is an object with the keys from, to, step";

template <class Field, class Part>
void read_ramped(const Field& field, const Reader& reader, Part& part, Ramp&) {
  read_field(field, reader, part);
}
template <class Part>
void read_ramped(const Field<Part, double, Strength>& field, const Reader& reader, Part& part,
                 Ramp& ramp) {
  part.*field.member = 0;
  const auto member = reader.find(std::string(field.key));
  if (!member) return reader.missing(field.key, ramp_required);
  read_ramp(field.form, *member, ramp);
}
template <class Part, class Kind, std::size_t n>
void read_ramped(const KeyedNumber<Part, Kind, n>& field, const Reader& reader, Part& part,
                 Ramp& ramp) {
  part.*field.value = 0;
  const auto member = read_kind(field, reader, part);
  if (!member) return reader.missing(field.keys[0].first, ramp_required);
  read_ramp({field.forms[0].range}, *member, ramp);
}

template <class Field, class Part>
void write_ramped(const Field& field, const Part& part, const Ramp&, Json& json) {
  write_field(field, part, json);
}
template <class Part>
void write_ramped(const Field<Part, double, Strength>& field, const Part&, const Ramp& ramp,
                  Json& json) {
  json[field.key] = written_ramp(ramp);
}
template <class Part, class Kind, std::size_t n>
void write_ramped(const KeyedNumber<Part, Kind, n>& field, const Part& part, const Ramp& ramp,
                  Json& json) {
  json[name_in(field.keys, part.*field.kind)] = written_ramp(ramp);
}

template <class Field>
void describe_ramped(const Field& field, ObjectSchema& schema, Definitions& definitions) {
  describe_field(field, schema, definitions);
}
template <class Part>
void describe_ramped(const Field<Part, double, Strength>& field, ObjectSchema& schema,
                     Definitions& definitions) {
  schema.properties[field.key] = ramp_schema(field.form, definitions);
  schema.required.emplace_back(field.key);
}
template <class Part, class Kind, std::size_t n>
void describe_ramped(const KeyedNumber<Part, Kind, n>& field, ObjectSchema& schema,
                     Definitions& definitions) {
  describe_kinds(field, true, schema, [&](const Number& form, std::string_view text, const auto&) {
    return described_as(ramp_schema({form.range}, definitions), "", sentence_of(text, form.unit),
                        std::nullopt, "");
  });
}

/// {"dilate": ramp} or {"shake": {"lambda": ramp, ...}}
void read_ramped_tap(const Reader& reader, ProtocolLine& line) {
  const auto choice = reader.choice(names_of<Tap>());
  Ramp& ramp = line.ramp.emplace();
  if (!choice) return;
  for_each_alternative<Tap>([&]<class Part>(std::type_identity<Part>) {
    if (choice->name != Part::description.name) return;
    Part part{};
    if constexpr (Bare<Part>) {
      constexpr auto only = std::get<0>(Part::fields());
      part.*only.member = 0;
      read_ramp(only.form, choice->settings, ramp);
    } else if (choice->settings.is_object_of(keys_of(Part::fields()))) {
      std::apply(
          [&](const auto&... field) { (read_ramped(field, choice->settings, part, ramp), ...); },
          Part::fields());
    }
    line.tap = part;
  });
}

Json written_ramped_tap(const Tap& tap, const Ramp& ramp) {
  Json settings = std::visit(
      [&]<class Part>(const Part& part) {
        if constexpr (Bare<Part>) {
          return written_ramp(ramp);
        } else {
          Json json = Json::object();
          std::apply([&](const auto&... field) { (write_ramped(field, part, ramp, json), ...); },
                     Part::fields());
          return json;
        }
      },
      tap);
  return {{name_of(tap), std::move(settings)}};
}

Json ramped_taps_schema(Definitions& definitions) {
  ObjectSchema taps;
  taps.rules = {{"minProperties", 1}, {"maxProperties", 1}};
  for_each_alternative<Tap>([&]<class Part>(std::type_identity<Part>) {
    if constexpr (Bare<Part>) {
      taps.properties[Part::description.name] =
          described_as(ramp_schema(std::get<0>(Part::fields()).form, definitions), "",
                       sentence_of(Part::description.text, ""), std::nullopt, "");
    } else {
      ObjectSchema settings;
      std::apply(
          [&](const auto&... field) { (describe_ramped(field, settings, definitions), ...); },
          Part::fields());
      taps.properties[Part::description.name] = described_as(
          settings.json(), "", sentence_of(Part::description.text, ""), std::nullopt, "");
    }
  });
  return taps.json();
}

constexpr std::tuple count_field{field(
    "count", &ProtocolLine::count, Whole{0, most_taps},
    "Number of taps; of a ramp: at each strength",
    {.required = "how many taps (of a ramp: at each strength), a whole number", .title = "Count"})};

}  // namespace

bool read_part(const Reader& reader, ProtocolLine& line) {
  if (!reader.is_object_of({"tap", "ramp", "count"})) return false;
  const auto tap = reader.find("tap");
  const auto ramp = reader.find("ramp");
  if (tap) read_value(OneOf<Tap>{}, *tap, line.tap);
  if (ramp) read_ramped_tap(*ramp, line);
  if (tap && ramp) reader.fault("expected only one of the keys tap, ramp");
  if (!tap && !ramp) reader.fault("expected one of the keys tap, ramp");
  read_field(std::get<0>(count_field), reader, line);
  return true;
}

Json written_part(const ProtocolLine& line) {
  Json json = Json::object();
  if (line.ramp) {
    json["ramp"] = written_ramped_tap(line.tap, *line.ramp);
  } else {
    json["tap"] = written_value(OneOf<Tap>{}, line.tap);
  }
  json.update(written_object(count_field, line));
  return json;
}

Json part_schema(std::type_identity<ProtocolLine>, Definitions& definitions) {
  ObjectSchema schema;
  schema.rules = {{"minProperties", 2}, {"maxProperties", 2}};
  schema.properties["tap"] = described_as(value_schema(OneOf<Tap>{}, definitions), "Tap",
                                          "The excitation of one tap.", std::nullopt, "");
  schema.properties["ramp"] = described_as(
      ramped_taps_schema(definitions), "Ramp",
      "A tap whose strength goes from one value to another in equal steps, both ends included; "
      "downwards if from exceeds to. sqrt_*: steps of the square root of the strength.",
      std::nullopt, "");
  describe_field(std::get<0>(count_field), schema, definitions);
  return described_as(schema.json(), "Stage",
                      "count taps, or count taps at every strength of a ramp.", std::nullopt,
                      R"([{"tap": {"dilate": 0.02}, "count": 4000}])");
}

}  // namespace jostle::inline config
