#include <fmt/format.h>

#include <algorithm>

#include "config/grids.hpp"
#include "config/parts.hpp"
#include "structure/pores.hpp"

namespace jostle {

namespace {

template <class Settings>
struct NumberKey {
  const char* key;
  double Settings::*member;
  Range range;
};

constexpr Range widths = between(0.001, 10);
constexpr double highest = 1e6;

const std::vector<NumberKey<ProfileSettings>> profile_keys = {
    {"bin_width", &ProfileSettings::bin_width, widths},
    {"smoothing", &ProfileSettings::smoothing, between(0, 10)}};
const std::vector<NumberKey<SidesSettings>> sides_keys = {
    {"bin_width", &SidesSettings::bin_width, widths},
    {"reach", &SidesSettings::reach, above(0, highest)}};
const std::vector<NumberKey<LayersSettings>> layers_keys = {
    {"bin_width", &LayersSettings::bin_width, widths}};
const std::vector<NumberKey<LayerRule>> layer_rule_keys = {
    {"tolerance", &LayerRule::tolerance, above(0, 0.4)},
    {"least_share", &LayerRule::least_share, between(0, 1)},
    {"least_filling", &LayerRule::least_filling, between(0, 1)}};
const std::vector<NumberKey<CoordinationSettings>> coordination_keys = {
    {"cut", &CoordinationSettings::cut, between(1, 3)},
    {"largest_cut", &CoordinationSettings::largest_cut, between(1, 3)},
    {"step", &CoordinationSettings::step, between(0.001, 1)}};
const std::vector<NumberKey<PairsSettings>> pairs_keys = {
    {"r_max", &PairsSettings::r_max, between(1, 20)},
    {"bin_width", &PairsSettings::bin_width, between(0.001, 1)}};
const std::vector<NumberKey<OrderSettings>> order_keys = {
    {"bin_width", &OrderSettings::bin_width, between(0.1, 1000)}};
const std::vector<NumberKey<VoronoiSettings>> voronoi_keys = {
    {"least_area", &VoronoiSettings::least_area, between(0, 0.1)},
    {"bin_width", &VoronoiSettings::bin_width, between(0.001, 1)}};
const std::vector<NumberKey<PoresSettings>> pores_keys = {
    {"bin_width", &PoresSettings::bin_width, between(0.001, 0.5)},
    {"largest", &PoresSettings::largest, between(0.5, 10)},
    {"merge", &PoresSettings::merge, between(0, 0.1)},
    {"tolerance", &PoresSettings::tolerance, between(0, 0.1)},
    {"tail_from", &PoresSettings::tail_from, between(0, 100)}};
const std::vector<NumberKey<VoidSettings>> void_keys = {
    {"largest", &VoidSettings::largest, between(0.1, 5)},
    {"step", &VoidSettings::step, between(0.001, 1)}};
const std::vector<NumberKey<BondLengths>> bond_keys = {
    {"first", &BondLengths::first, above(1, 2)},
    {"last", &BondLengths::last, above(1, 2)},
    {"step", &BondLengths::step, between(0.001, 1)}};

template <class Settings>
void read_numbers(const Reader& in, const std::vector<NumberKey<Settings>>& keys,
                  Settings& settings) {
  for (const auto& [key, member, range] : keys) in.read(key, settings.*member, range);
}

template <class Settings>
void write_numbers(const std::vector<NumberKey<Settings>>& keys, const Settings& settings,
                   Json& out) {
  for (const auto& [key, member, range] : keys) out[key] = plain_number(settings.*member);
}

/// Whether this is an object of the keys of the table and others.
template <class Settings>
bool has_keys(const Reader& in, const std::vector<NumberKey<Settings>>& table,
              std::vector<std::string> others = {}) {
  for (const auto& entry : table) others.emplace_back(entry.key);
  return in.is_object_of(others);
}

void read_window(const Reader& in, const char* key, std::optional<HeightWindow>& into) {
  if (const auto heights = in.find(key)) into = read_heights(*heights);
}

void read_settings(const Reader& in, ProfileSettings& settings) {
  if (!has_keys(in, profile_keys, {"gradient"})) return;
  read_numbers(in, profile_keys, settings);
  read_window(in, "gradient", settings.gradient);
}
void read_settings(const Reader& in, SidesSettings& settings) {
  if (!has_keys(in, sides_keys, {"heights"})) return;
  read_numbers(in, sides_keys, settings);
  read_window(in, "heights", settings.heights);
}
void read_settings(const Reader& in, LayersSettings& settings) {
  if (!has_keys(in, layers_keys, {"tolerance", "least_share", "least_filling"})) return;
  read_numbers(in, layers_keys, settings);
  read_numbers(in, layer_rule_keys, settings.rule);
}
void read_settings(const Reader& in, CoordinationSettings& settings) {
  if (has_keys(in, coordination_keys)) read_numbers(in, coordination_keys, settings);
}
void read_settings(const Reader& in, PairsSettings& settings) {
  if (has_keys(in, pairs_keys)) read_numbers(in, pairs_keys, settings);
}
void read_settings(const Reader& in, OrderSettings& settings) {
  if (has_keys(in, order_keys)) read_numbers(in, order_keys, settings);
}
void read_settings(const Reader& in, VoronoiSettings& settings) {
  if (!has_keys(in, voronoi_keys, {"cut_cells"})) return;
  read_numbers(in, voronoi_keys, settings);
  in.read_flag("cut_cells", settings.cut_cells);
}
void read_settings(const Reader& in, PoresSettings& settings) {
  if (has_keys(in, pores_keys)) read_numbers(in, pores_keys, settings);
}
void read_settings(const Reader& in, VoidSettings& settings) {
  if (!has_keys(in, void_keys, {"points"})) return;
  read_numbers(in, void_keys, settings);
  in.read_whole("points", settings.points, 100, 1'000'000'000);
}
void read_settings(const Reader& in, HolesSettings& settings) {
  if (!has_keys(in, bond_keys)) return;
  read_numbers(in, bond_keys, settings.bonds);
  if (in.sound() && settings.bonds.last < settings.bonds.first) {
    in.fault(fmt::format("bond lengths from {} to {} are none: first must not be above last",
                         settings.bonds.first, settings.bonds.last));
  }
}

Json written(const ProfileSettings& settings) {
  Json out;
  write_numbers(profile_keys, settings, out);
  if (settings.gradient) {
    out["gradient"] = written_bounds(settings.gradient->low, settings.gradient->high);
  }
  return out;
}
Json written(const SidesSettings& settings) {
  Json out;
  write_numbers(sides_keys, settings, out);
  if (settings.heights) {
    out["heights"] = written_bounds(settings.heights->low, settings.heights->high);
  }
  return out;
}
Json written(const LayersSettings& settings) {
  Json out;
  write_numbers(layers_keys, settings, out);
  write_numbers(layer_rule_keys, settings.rule, out);
  return out;
}
Json written(const CoordinationSettings& settings) {
  Json out;
  write_numbers(coordination_keys, settings, out);
  return out;
}
Json written(const PairsSettings& settings) {
  Json out;
  write_numbers(pairs_keys, settings, out);
  return out;
}
Json written(const OrderSettings& settings) {
  Json out;
  write_numbers(order_keys, settings, out);
  return out;
}
Json written(const VoronoiSettings& settings) {
  Json out;
  write_numbers(voronoi_keys, settings, out);
  out["cut_cells"] = settings.cut_cells;
  return out;
}
Json written(const PoresSettings& settings) {
  Json out;
  write_numbers(pores_keys, settings, out);
  return out;
}
Json written(const VoidSettings& settings) {
  Json out;
  write_numbers(void_keys, settings, out);
  out["points"] = settings.points;
  return out;
}
Json written(const HolesSettings& settings) {
  Json out;
  write_numbers(bond_keys, settings.bonds, out);
  return out;
}

Region read_region(const Reader& in) {
  Region region = pore_region;
  if (!in.is_object_of({"heights", "from_sides"})) return region;
  if (const auto heights = in.find("heights")) {
    const HeightWindow window = read_heights(*heights);
    region.low = window.low;
    region.high = window.high;
  } else {
    in.missing("heights", "two numbers, low and high");
  }
  in.read("from_sides", region.from_sides, between(0, highest));
  return region;
}

/// Calls act(name, part) for every part of the settings.
template <class Settings, class Act>
void for_each_part(Settings& settings, Act&& act) {
  act("profile", settings.profile);
  act("sides", settings.sides);
  act("layers", settings.layers);
  act("coordination", settings.coordination);
  act("pair_correlation", settings.pair_correlation);
  act("order", settings.order);
  act("voronoi", settings.voronoi);
  act("pores", settings.pores);
  act("void_probability", settings.void_probability);
  act("holes", settings.holes);
}

}  // namespace

StructureSettings read_structure(const Reader& in) {
  StructureSettings settings;
  std::vector<std::string> keys = {"region"};
  for_each_part(settings, [&](const char* name, const auto&) { keys.emplace_back(name); });
  if (!in.is_object_of(keys)) return settings;
  if (const auto region = in.find("region")) settings.region = read_region(*region);
  for_each_part(settings, [&](const char* name, auto& part) {
    if (const auto member = in.find(name)) read_settings(*member, part.emplace());
  });
  return settings;
}

Json resolved(const StructureSettings& settings) {
  return written(settings);
}

Json written(const StructureSettings& settings) {
  Json out = Json::object();
  if (settings.region) {
    const Region& region = *settings.region;
    out["region"] = {{"heights", written_bounds(region.low, region.high)},
                     {"from_sides", plain_number(region.from_sides)}};
  }
  for_each_part(settings, [&](const char* name, const auto& part) {
    if (part) out[name] = written(*part);
  });
  return out;
}

std::vector<std::string> parts_of(const StructureSettings& settings) {
  std::vector<std::string> names;
  for_each_part(settings, [&](const char* name, const auto& part) {
    if (part) names.emplace_back(name);
  });
  return names;
}

StructureSettings with_parts(StructureSettings settings, std::span<const std::string> names) {
  for_each_part(settings, [&](const char* name, auto& part) {
    if (std::ranges::find(names, name) == names.end()) {
      part.reset();
    } else if (!part) {
      part.emplace();
    }
  });
  return settings;
}

ParsedStructure parse_structure(std::string_view json_text) {
  ParsedStructure parsed;
  const auto json = read_json(json_text, parsed.faults);
  if (!json) return parsed;
  StructureSettings settings = read_structure(Reader{*json, "", parsed.faults});
  if (parsed.faults.empty()) parsed.settings = std::move(settings);
  return parsed;
}

void check_structure(const Scene& scene, std::vector<Fault>& faults) {
  for (const char* part : {"/structure", "/snapshots"}) {
    if (!sound(faults, part)) return;
  }
  if (scene.structure.empty()) return;
  if (parts_of(scene.structure).empty()) {
    faults.push_back({"/structure", fmt::format("a region and no part to measure in it: add {}",
                                                listed(parts_of(all_structure())))});
  }
  if (!scene.snapshots.positions || chosen_taps(scene.snapshots.taps).empty()) {
    faults.push_back({"/structure",
                      "structure is measured in kept packings: give /snapshots taps, and "
                      "\"positions\" among what they keep"});
  }
}

}  // namespace jostle
