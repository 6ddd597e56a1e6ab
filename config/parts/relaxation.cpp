#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

/// "mean_height": relative with eta, absolute with change.
constexpr std::string_view by_mean_height = MeanHeightStop::description.name;
static_assert(by_mean_height == HeightChangeStop::description.name);
constexpr std::tuple mean_height_fields{std::get<0>(MeanHeightStop::fields()),
                                        std::get<0>(HeightChangeStop::fields()),
                                        std::get<1>(MeanHeightStop::fields())};

void read_mean_height(const Reader& reader, StopRule& target) {
  if (!reader.is_object_of(keys_of(mean_height_fields))) return;
  const bool relative = reader.find("eta").has_value(),
             absolute = reader.find("change").has_value();
  if (relative && absolute)
    reader.fault("expected only one of the keys eta (relative), change (in diameters)");
  const auto read = [&]<class Rule>(Rule rule) {
    std::apply([&](const auto&... field) { (read_field(field, reader, rule), ...); },
               Rule::fields());
    target = rule;
  };
  if (absolute) return read(HeightChangeStop{});
  read(MeanHeightStop{});
}

}  // namespace

bool read_value(const OneOf<StopRule>&, const Reader& reader, StopRule& target) {
  const auto rule = reader.choice(names_of<StopRule>());
  if (!rule) return false;
  if (rule->name == by_mean_height) {
    read_mean_height(rule->settings, target);
  } else {
    read_alternative(rule->name, rule->settings, target);
  }
  return true;
}

Json value_schema(const OneOf<StopRule>&, Definitions& definitions) {
  ObjectSchema rules = alternatives_schema<StopRule>(definitions);
  ObjectSchema schema = object_schema(mean_height_fields, definitions);
  schema.required.clear();
  schema.rules.update(at_most_one_of({"eta", "change"}));
  rules.properties[by_mean_height] = described_as(
      schema.json(), "", sentence_of(MeanHeightStop::description.text, ""), std::nullopt, "");
  return rules.json();
}

bool read_part(const Reader& reader, Relaxation& relaxation) {
  return read_object(Relaxation::fields(), reader, relaxation);
}
Json written_part(const Relaxation& relaxation) {
  return written_object(Relaxation::fields(), relaxation);
}
Json part_schema(std::type_identity<Relaxation>, Definitions& definitions) {
  return object_schema(Relaxation::fields(), definitions).json();
}

}  // namespace jostle::inline config
