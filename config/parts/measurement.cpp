#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "config/grids.hpp"
#include "config/parts/parts.hpp"
#include "ensemble/statistics/finite_text.hpp"

namespace jostle::inline config {

namespace {

constexpr auto tap_list = list_of(Whole{0, most_taps}, 0, 100'000, "tap numbers");

bool read_tap_list(const Reader& value, std::vector<std::uint64_t>& target) {
  std::set<std::uint64_t> taps;
  if (!value.is_list(tap_list.least, tap_list.most, tap_list.of_what)) return false;
  for (std::size_t i = 0; i < value.value().size(); ++i) {
    std::uint64_t tap = 0;
    if (read_value(tap_list.form, value.element(i), tap) && !taps.insert(tap).second)
      value.element(i).fault(fmt::format("tap {} is listed twice", tap));
  }
  target.assign(taps.begin(), taps.end());
  return true;
}

Json tap_list_schema(Definitions& definitions) {
  Json schema = value_schema(tap_list, definitions);
  schema["uniqueItems"] = true;
  return schema;
}

constexpr std::tuple grid_fields{
    field("from", &LogarithmicTaps::first, Whole{1, most_taps}, "First tap of the grid"),
    field("to", &LogarithmicTaps::last, Whole{1, most_taps}, "Last tap that the grid may have",
          {.required = "the tap at which the grid ends"}),
    field("per_decade", &LogarithmicTaps::per_decade, Whole{1, 100}, "Taps per decade")};

bool read_grid(const Reader& value, LogarithmicTaps& grid) {
  if (!value.is_object_of({"log", "also"})) return false;
  if (const auto log = value.find("log")) {
    read_object(grid_fields, *log, grid);
    if (log->sound() && grid.first > grid.last) {
      log->fault(fmt::format("the grid from {} to {} is empty: from must not be above to",
                             grid.first, grid.last));
    }
  } else {
    value.missing("log", "an object with the keys from, to, per_decade");
  }
  if (const auto also = value.find("also")) read_tap_list(*also, grid.also);
  return true;
}

Json grid_schema(Definitions& definitions) {
  ObjectSchema schema;
  schema.required = {"log"};
  schema.properties = {
      {"log",
       described_as(object_schema(grid_fields, definitions).json(), "",
                    "Taps from x 10^(k / per_decade), rounded, up to to.", std::nullopt, "")},
      {"also", described_as(tap_list_schema(definitions), "", "Further taps.", Json::array(), "")}};
  return schema.json();
}

struct KeptPart {
  const char* name;
  bool SnapshotChoice::*kept;
  bool of_grains = false, beside_positions = false, on_request = false;
};
constexpr KeptPart kept_parts[] = {
    {"positions", &SnapshotChoice::positions},
    {"coordination", &SnapshotChoice::coordination},
    {"height_histogram", &SnapshotChoice::height_histogram},
    {"velocities", &SnapshotChoice::velocities, true, true},
    {"contacts", &SnapshotChoice::contacts, true, true},
    {"granular_temperature", &SnapshotChoice::granular_temperature, true},
    {"forces", &SnapshotChoice::forces, true},
    {"driven_temperature", &SnapshotChoice::driven_temperature, true, false, true}};

std::vector<std::string> kept_names() {
  std::vector<std::string> names;
  for (const KeptPart& part : kept_parts) names.emplace_back(part.name);
  return names;
}

void read_keep(const Reader& object, SnapshotChoice& snapshots) {
  const auto value = object.find("keep");
  const std::vector<std::string> names = kept_names();
  if (!value || !value->is_list(0, names.size(), "of the strings " + listed(names))) return;
  std::set<std::string> kept;
  for (std::size_t i = 0; i < value->value().size(); ++i) {
    const Reader element = value->element(i);
    const auto choice = element.one_of(names);
    if (choice && !kept.insert(*choice).second) element.fault(*choice + " is listed twice");
  }
  for (const KeptPart& part : kept_parts) snapshots.*part.kept = kept.contains(part.name);
}

void write_keep(const SnapshotChoice& snapshots, Json& json) {
  Json& keep = json["keep"] = Json::array();
  for (const KeptPart& part : kept_parts)
    if (snapshots.*part.kept) keep.push_back(part.name);
}

void describe_keep(ObjectSchema& schema, Definitions&) {
  Json by_default = Json::object();
  write_keep(default_snapshots(false), by_default);
  const Json names{{"type", "array"},
                   {"maxItems", std::size(kept_parts)},
                   {"uniqueItems", true},
                   {"items", words_schema(kept_names())}};
  schema.properties["keep"] = described_as(
      names, "Kept data of a snapshot",
      "Default of Monte Carlo: positions, coordination and height_histogram. Discrete elements "
      "also keep velocities (and spins, with friction), contacts with their forces, "
      "granular_temperature by height, and forces (of floor and sides, and the force-moment tensor "
      "of the bed). Velocities and contacts require positions. driven_temperature, on request, is "
      "the granular temperature while a half_sine or a vibration moves the floor.",
      by_default.at("keep"), "");
}

/// A number of taps, or "all": every tap.
void read_every(const Reader& object, SnapshotChoice& snapshots) {
  const auto value = object.find("every");
  if (!value) return;
  if (value->value().is_string()) {
    if (value->one_of({"all"})) snapshots.every = 1;
  } else {
    read_value(Whole{1, most_taps}, *value, snapshots.every.emplace(1));
  }
}

void write_every(const SnapshotChoice& snapshots, Json& json) {
  if (snapshots.every) json["every"] = *snapshots.every;
}

void describe_every(ObjectSchema& schema, Definitions& definitions) {
  schema.properties["every"] = described_as(
      either(value_schema(Whole{1, most_taps}, definitions), words_schema({"all"})),
      "Step of regular snapshots",
      "Packings are kept after taps 0, every, 2 every, ..., beside those of taps; all: after every "
      "tap. At most 100000 per realization.",
      std::nullopt, R"([10, "all"])");
}

constexpr std::tuple snapshot_fields{
    field("taps", &SnapshotChoice::taps, TapNumbers{}, "A list, or a logarithmic grid and others",
          {.title = "Taps of the snapshots",
           .examples = R"([[0, 100, 4000], {"log": {"to": 4000, "per_decade": 3}, "also": [0]}])"}),
    irregular("every", read_every, write_every, describe_every),
    irregular("keep", read_keep, write_keep, describe_keep),
    field("contact_cut", &SnapshotChoice::contact_cut, Number{closed_range(1, 3), "diameters"},
          "Centres within this distance count as neighbours"),
    field("bin_width", &SnapshotChoice::bin_width, Number{closed_range(0.001, 10), "diameters"},
          "Width of bins of height: height histogram and granular temperatures")};

}  // namespace

std::optional<std::string> part_fault(const BulkFraction& bulk) {
  const auto* window = std::get_if<HeightWindow>(&bulk.window);
  constexpr double lowest = 0.5;  // no centre, and no quantile, is lower
  if (window == nullptr) {
    if (lowest >= 0.5 * bulk.taper) return std::nullopt;
    return finite_text(
        "quantiles tapered over {} can reach below the floor, where nothing counts "
        "as empty space: taper over 1 or less, or give heights",
        bulk.taper);
  }
  if (window->low >= 0.5 * bulk.taper) return std::nullopt;
  return finite_text("a window from {} tapered over {} begins below the floor: begin at {} or more",
                     window->low, bulk.taper, 0.5 * bulk.taper);
}

bool read_value(const TapNumbers&, const Reader& value, TapChoice& target) {
  if (value.value().is_object()) return read_grid(value, target.emplace<LogarithmicTaps>());
  return read_tap_list(value, target.emplace<std::vector<std::uint64_t>>());
}
bool read_value(const TapNumbers& form, const Reader& value, std::vector<std::uint64_t>& target) {
  TapChoice choice;
  const bool read = read_value(form, value, choice);
  target = chosen_taps(choice);
  return read;
}
Json written_value(const TapNumbers&, const TapChoice& choice) {
  if (const auto* grid = std::get_if<LogarithmicTaps>(&choice))
    return {{"log", written_object(grid_fields, *grid)}, {"also", grid->also}};
  return std::get<std::vector<std::uint64_t>>(choice);
}
Json written_value(const TapNumbers&, const std::vector<std::uint64_t>& taps) {
  return taps;
}
Json value_schema(const TapNumbers&, Definitions& definitions) {
  return definitions.refer(
      "taps", [&] { return either(tap_list_schema(definitions), grid_schema(definitions)); });
}

SnapshotChoice default_snapshots(bool grains) {
  SnapshotChoice snapshots;
  for (const KeptPart& part : kept_parts)
    snapshots.*part.kept = (grains || !part.of_grains) && !part.on_request;
  return snapshots;
}

std::optional<std::string> keep_fault(const SnapshotChoice& snapshots, bool grains) {
  for (const KeptPart& part : kept_parts) {
    if (!(snapshots.*part.kept)) continue;
    if (part.of_grains && !grains)
      return fmt::format(
          "\"{}\" requires discrete elements: Monte Carlo has no times and no forces; remove it",
          part.name);
    if (part.beside_positions && !snapshots.positions)
      return fmt::format("\"{}\" requires positions: keep positions, too", part.name);
  }
  return std::nullopt;
}

bool read_part(const Reader& value, SnapshotChoice& snapshots) {
  return read_object(snapshot_fields, value, snapshots);
}
Json written_part(const SnapshotChoice& snapshots) {
  return written_object(snapshot_fields, snapshots);
}
Json part_schema(std::type_identity<SnapshotChoice>, Definitions& definitions) {
  return object_schema(snapshot_fields, definitions).json();
}

}  // namespace jostle::inline config
