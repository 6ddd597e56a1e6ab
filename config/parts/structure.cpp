#include <fmt/format.h>

#include <algorithm>

#include "config/grids.hpp"
#include "config/parts/parts.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "structure/voids/pores.hpp"

namespace jostle::inline config {

namespace {

template <class Settings>
struct NumberKey {
  const char* key;
  double Settings::*member;
  Range range;
};

/// The numbers of a part's settings.
template <class Settings>
const std::vector<NumberKey<Settings>> number_keys{};

constexpr Range widths = between(0.001, 10);
constexpr double longest_distance = 1e6;

template <>
const std::vector<NumberKey<ProfileSettings>> number_keys<ProfileSettings> = {
    {"bin_width", &ProfileSettings::bin_width, widths},
    {"smoothing", &ProfileSettings::smoothing, between(0, 10)}};
template <>
const std::vector<NumberKey<SidesSettings>> number_keys<SidesSettings> = {
    {"bin_width", &SidesSettings::bin_width, widths},
    {"reach", &SidesSettings::reach, above(0, longest_distance)}};
template <>
const std::vector<NumberKey<LayersSettings>> number_keys<LayersSettings> = {
    {"bin_width", &LayersSettings::bin_width, widths}};
template <>
const std::vector<NumberKey<LayerRule>> number_keys<LayerRule> = {
    {"tolerance", &LayerRule::tolerance, above(0, 0.4)},
    {"least_share", &LayerRule::least_share, between(0, 1)},
    {"least_filling", &LayerRule::least_filling, between(0, 1)}};
template <>
const std::vector<NumberKey<CoordinationSettings>> number_keys<CoordinationSettings> = {
    {"cut", &CoordinationSettings::cut, between(1, 3)},
    {"largest_cut", &CoordinationSettings::largest_cut, between(1, 3)},
    {"step", &CoordinationSettings::step, between(0.001, 1)}};
template <>
const std::vector<NumberKey<PairsSettings>> number_keys<PairsSettings> = {
    {"bin_width", &PairsSettings::bin_width, between(0.001, 1)}};
template <>
const std::vector<NumberKey<OrderSettings>> number_keys<OrderSettings> = {
    {"bin_width", &OrderSettings::bin_width, between(0.1, 1000)}};
template <>
const std::vector<NumberKey<GapsSettings>> number_keys<GapsSettings> = {
    {"largest", &GapsSettings::largest, between(0.01, 2)},
    {"tolerance", &GapsSettings::tolerance, between(0, 0.2)}};
template <>
const std::vector<NumberKey<StructureFactorSettings>> number_keys<StructureFactorSettings> = {
    {"k_max", &StructureFactorSettings::k_max, between(0.5, 50)},
    {"bin_width", &StructureFactorSettings::bin_width, between(0.01, 10)},
    {"fit_to", &StructureFactorSettings::fit_to, between(0.1, 50)}};
template <>
const std::vector<NumberKey<VoronoiSettings>> number_keys<VoronoiSettings> = {
    {"least_area", &VoronoiSettings::least_area, between(0, 0.1)},
    {"bin_width", &VoronoiSettings::bin_width, between(0.001, 1)}};
template <>
const std::vector<NumberKey<PoresSettings>> number_keys<PoresSettings> = {
    {"bin_width", &PoresSettings::bin_width, between(0.001, 0.5)},
    {"largest", &PoresSettings::largest, between(0.5, 10)},
    {"merge", &PoresSettings::merge, between(0, 0.1)},
    {"tolerance", &PoresSettings::tolerance, between(0, 0.1)},
    {"tail_from", &PoresSettings::tail_from, between(0, 100)}};
template <>
const std::vector<NumberKey<VoidSettings>> number_keys<VoidSettings> = {
    {"largest", &VoidSettings::largest, between(0.1, 5)},
    {"step", &VoidSettings::step, between(0.001, 1)}};
template <>
const std::vector<NumberKey<BondLengths>> number_keys<BondLengths> = {
    {"first", &BondLengths::first, above(1, 2)},
    {"last", &BondLengths::last, above(1, 2)},
    {"step", &BondLengths::step, between(0.001, 1)}};

template <class Settings>
void read_numbers(const Reader& in, Settings& settings) {
  for (const auto& [key, member, range] : number_keys<Settings>) {
    in.read(key, settings.*member, range);
  }
}

template <class Settings>
Json written_numbers(const Settings& settings) {
  Json out;
  for (const auto& [key, member, range] : number_keys<Settings>) {
    out[key] = plain_number(settings.*member);
  }
  return out;
}

/// Whether this is an object of the numbers of some settings and other keys.
template <class Settings>
bool has_keys(const Reader& in, std::vector<std::string> others = {}) {
  for (const auto& entry : number_keys<Settings>) others.emplace_back(entry.key);
  return in.is_object_of(others);
}

void read_window(const Reader& in, const char* key, std::optional<HeightWindow>& into) {
  if (const auto heights = in.find(key)) into = read_heights(*heights);
}

// Settings that are numbers alone; others have functions of their own.
template <class Settings>
void read_settings(const Reader& in, Settings& settings) {
  if (has_keys<Settings>(in)) read_numbers(in, settings);
}
template <class Settings>
Json written_settings(const Settings& settings) {
  return written_numbers(settings);
}

void read_settings(const Reader& in, ProfileSettings& settings) {
  if (!has_keys<ProfileSettings>(in, {"gradient"})) return;
  read_numbers(in, settings);
  read_window(in, "gradient", settings.gradient);
}
Json written_settings(const ProfileSettings& settings) {
  Json out = written_numbers(settings);
  if (const auto& heights = settings.gradient) {
    out["gradient"] = written_bounds(heights->low, heights->high);
  }
  return out;
}

void read_settings(const Reader& in, PairsSettings& settings) {
  if (!has_keys<PairsSettings>(in, {"r_max"})) return;
  read_numbers(in, settings);
  if (const auto r_max = in.find("r_max")) settings.r_max = r_max->number(between(1, 20));
}
Json written_settings(const PairsSettings& settings) {
  Json out = written_numbers(settings);
  if (settings.r_max) out["r_max"] = plain_number(*settings.r_max);
  return out;
}

void read_settings(const Reader& in, SidesSettings& settings) {
  if (!has_keys<SidesSettings>(in, {"heights"})) return;
  read_numbers(in, settings);
  read_window(in, "heights", settings.heights);
}
Json written_settings(const SidesSettings& settings) {
  Json out = written_numbers(settings);
  if (const auto& heights = settings.heights) {
    out["heights"] = written_bounds(heights->low, heights->high);
  }
  return out;
}

void read_settings(const Reader& in, LayersSettings& settings) {
  if (!has_keys<LayersSettings>(in, {"tolerance", "least_share", "least_filling"})) return;
  read_numbers(in, settings);
  read_numbers(in, settings.rule);
}
Json written_settings(const LayersSettings& settings) {
  Json out = written_numbers(settings);
  out.update(written_numbers(settings.rule));
  return out;
}

void read_settings(const Reader& in, VoronoiSettings& settings) {
  if (!has_keys<VoronoiSettings>(in, {"cut_cells"})) return;
  read_numbers(in, settings);
  in.read_flag("cut_cells", settings.cut_cells);
}
Json written_settings(const VoronoiSettings& settings) {
  Json out = written_numbers(settings);
  out["cut_cells"] = settings.cut_cells;
  return out;
}

void read_settings(const Reader& in, GapsSettings& settings) {
  if (!has_keys<GapsSettings>(in, {"least_contacts", "window"})) return;
  read_numbers(in, settings);
  std::uint64_t least = 0;
  in.read_whole("least_contacts", least, 1, 12);
  if (least > 0) settings.least_contacts = least;
  if (const auto window = in.find("window")) {
    settings.window = read_heights(*window);
    if (window->sound() && settings.window.low <= 0)
      window->fault("gaps of 0 have no logarithm: begin above 0");
  }
}
Json written_settings(const GapsSettings& settings) {
  Json out = written_numbers(settings);
  if (settings.least_contacts) out["least_contacts"] = *settings.least_contacts;
  out["window"] = written_bounds(settings.window.low, settings.window.high);
  return out;
}

void read_settings(const Reader& in, StructureFactorSettings& settings) {
  if (!has_keys<StructureFactorSettings>(in, {"modes"})) return;
  read_numbers(in, settings);
  in.read_whole("modes", settings.modes, 1, 1'000'000);
}
Json written_settings(const StructureFactorSettings& settings) {
  Json out = written_numbers(settings);
  out["modes"] = settings.modes;
  return out;
}

void read_settings(const Reader& in, VoidSettings& settings) {
  if (!has_keys<VoidSettings>(in, {"points"})) return;
  read_numbers(in, settings);
  in.read_whole("points", settings.points, 100, 1'000'000'000);
}
Json written_settings(const VoidSettings& settings) {
  Json out = written_numbers(settings);
  out["points"] = settings.points;
  return out;
}

void read_settings(const Reader& in, ClustersSettings& settings) {
  if (!in.is_object_of({"largest"})) return;
  in.read_whole("largest", settings.largest, 1, 10'000);
}
Json written_settings(const ClustersSettings& settings) {
  return {{"largest", settings.largest}};
}

void read_settings(const Reader& in, HolesSettings& settings) {
  BondLengths& bonds = settings.bonds;
  if (!has_keys<BondLengths>(in)) return;
  read_numbers(in, bonds);
  if (in.sound() && bonds.last < bonds.first) {
    in.fault(finite_text("bond lengths from {} to {} are none: first must not be above last",
                         bonds.first, bonds.last));
  }
}
Json written_settings(const HolesSettings& settings) {
  return written_numbers(settings.bonds);
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
  in.read("from_sides", region.from_sides, between(0, longest_distance));
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
  act("gaps", settings.gaps);
  act("structure_factor", settings.structure_factor);
  act("voronoi", settings.voronoi);
  act("clusters", settings.clusters);
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
    if (part) out[name] = written_settings(*part);
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

}  // namespace jostle::inline config
