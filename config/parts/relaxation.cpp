#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

/// "mean_height": relative with eta, absolute with change.
constexpr std::string_view by_mean_height = MeanHeightStop::about.name;
static_assert(by_mean_height == HeightChangeStop::about.name);
constexpr std::tuple mean_height_fields{std::get<0>(MeanHeightStop::fields()),
                                        std::get<0>(HeightChangeStop::fields()),
                                        std::get<1>(MeanHeightStop::fields())};

void read_mean_height(const Reader& in, StopRule& into) {
  if (!in.is_object_of(keys_of(mean_height_fields))) return;
  const bool relative = in.find("eta").has_value(), absolute = in.find("change").has_value();
  if (relative && absolute)
    in.fault("expected only one of the keys eta (relative), change (in diameters)");
  const auto read = [&]<class Rule>(Rule rule) {
    std::apply([&](const auto&... field) { (read_field(field, in, rule), ...); }, Rule::fields());
    into = rule;
  };
  if (absolute) return read(HeightChangeStop{});
  read(MeanHeightStop{});
}

}  // namespace

bool read_value(const OneOf<StopRule>&, const Reader& in, StopRule& into) {
  const auto rule = in.choice(names_of<StopRule>());
  if (!rule) return false;
  if (rule->name == by_mean_height) {
    read_mean_height(rule->settings, into);
  } else {
    read_alternative(rule->name, rule->settings, into);
  }
  return true;
}

Json value_schema(const OneOf<StopRule>&, Definitions& definitions) {
  ObjectSchema rules = alternatives_schema<StopRule>(definitions);
  ObjectSchema both = object_schema(mean_height_fields, definitions);
  both.required.clear();
  both.rules.update(at_most_one_of({"eta", "change"}));
  rules.properties[by_mean_height] =
      described_as(both.json(), "", sentence_of(MeanHeightStop::about.text, ""), std::nullopt, "");
  return rules.json();
}

bool read_part(const Reader& in, Relaxation& relaxation) {
  return read_object(Relaxation::fields(), in, relaxation);
}
Json written_part(const Relaxation& relaxation) {
  return written_object(Relaxation::fields(), relaxation);
}
Json part_schema(std::type_identity<Relaxation>, Definitions& definitions) {
  return object_schema(Relaxation::fields(), definitions).json();
}

}  // namespace jostle::inline config
