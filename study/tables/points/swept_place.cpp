#include "study/tables/points/swept_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

#include "config/json/json_text.hpp"
#include "config/sweep.hpp"
#include "ensemble/protocol_steps.hpp"
#include "study/bad_input.hpp"
#include "study/tables/points/point_scenes.hpp"

namespace jostle::inline study {

namespace {

/// True for a kind of tap and for the field that holds its strength: "dilate", "shake/lambda".
bool is_strength(std::string_view of_tap) {
  const std::size_t slash = of_tap.find('/');
  if (slash == std::string_view::npos) return true;
  const std::string_view field = of_tap.substr(slash + 1);
  return field == "lambda" || field == "amplitude" || field == "acceleration";
}

/// The stage whose strength this is: "/protocol/0/tap/dilate" -> 0.
std::optional<std::size_t> tap_line(std::string_view pointer) {
  constexpr std::string_view prefix = "/protocol/";
  if (!pointer.starts_with(prefix)) return std::nullopt;
  pointer.remove_prefix(prefix.size());
  std::size_t line = 0;
  const char* const last = pointer.data() + pointer.size();
  const auto [end, error] = std::from_chars(pointer.data(), last, line);
  const std::string_view rest(end, last);
  const bool of_tap = rest == "/tap" || (rest.starts_with("/tap/") && is_strength(rest.substr(5)));
  return error == std::errc{} && of_tap ? std::optional(line) : std::nullopt;
}

/// The name of an axis: "dilate", "width_1".
std::string axis_name(const std::string& pointer) {
  std::string name = short_name(pointer);
  std::ranges::replace(name, '/', '_');
  return name;
}

/// The pointer of the sweep that ends with a name, as labels of points and axes have it.
std::string pointer_named(const std::string& name, const StudyPoint& swept) {
  std::string found;
  for (const auto& [pointer, value] : swept.sweep_values) {
    if (!pointer.ends_with("/" + name) && axis_name(pointer) != name) continue;
    if (!found.empty()) {
      throw BadInput(
          fmt::format("{} and {} are swept: name one of them by its JSON pointer", found, pointer));
    }
    found = pointer;
  }
  if (found.empty()) {
    throw BadInput(fmt::format(
        "{} is neither a name of what is swept nor a JSON pointer, which begins with /", name));
  }
  return found;
}

}  // namespace

SweptPlace swept_place(const StudyPoint& swept, const PointScenes& scenes, std::uint32_t point,
                       std::string against) {
  SweptPlace place;
  const auto& protocol = scenes.point_scene(point).protocol;
  if (against.empty()) {
    const std::size_t last_stage = protocol.empty() ? 0 : protocol.size() - 1;
    against = swept.sweep_values.empty() ? fmt::format("/protocol/{}/tap", last_stage)
                                         : swept.sweep_values.front().first;
  } else if (against.front() != '/') {
    against = pointer_named(against, swept);
  }
  for (const auto& [pointer, value] : swept.sweep_values) {
    if (pointer == against || scenes.vary_together(pointer, against)) continue;
    place.fixed_values.append(place.fixed_values.empty() ? "" : ", ")
        .append(pointer)
        .append(" = ")
        .append(value);
  }
  const auto line = tap_line(against);
  if (line && *line < protocol.size() && !protocol[*line].ramp) {
    const Control strength = control(protocol[*line].tap);
    place.x = strength.value;
    place.swept = {strength.name, strength.units,
                   protocol.size() == 1
                       ? "strength of the taps"
                       : fmt::format("strength of the taps of stage {}", *line + 1)};
    return place;
  }
  const std::optional<Json> value = scenes.value_at(point, against);
  if (!value) throw BadInput(fmt::format("the scene has no value at {}", against));
  if (!value->is_number()) {
    throw BadInput(fmt::format("{} is not a number: {}", against, value->dump()));
  }
  place.x = value->number();
  place.swept = {axis_name(against), "1", against};
  return place;
}

}  // namespace jostle::inline study
