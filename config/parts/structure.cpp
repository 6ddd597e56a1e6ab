#include <fmt/format.h>

#include <algorithm>

#include "config/grids.hpp"
#include "config/parts/parts.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "structure/voids/pores.hpp"

namespace jostle::inline config {

namespace {

/// A region as scenes write it.
constexpr auto region_heights = height_bounds;
constexpr auto from_sides = field("from_sides", &Region::from_sides,
                                  Number{closed_range(0, 1e6), "diameters"}, "Distance from walls");
constexpr std::tuple region_fields{irregular(
                                       "heights",
                                       [](const Reader& object, Region& region) {
                                         const auto heights = object.find("heights");
                                         HeightWindow window;
                                         if (!heights)
                                           object.missing("heights", "two numbers, low and high");
                                         if (heights) read_value(region_heights, *heights, window);
                                         region.low = window.low;
                                         region.high = window.high;
                                       },
                                       [](const Region& region, Json& json) {
                                         json["heights"] = written_bounds(region.low, region.high);
                                       },
                                       [](ObjectSchema& schema, Definitions& definitions) {
                                         schema.properties["heights"] = described_as(
                                             value_schema(region_heights, definitions), "",
                                             "Low and high, diameters.", std::nullopt, "");
                                         schema.required.emplace_back("heights");
                                       }),
                                   from_sides};

/// Calls act(name, part) for every part of the settings but the region.
template <class Settings, class Act>
void for_each_part(Settings& settings, const Act& act) {
  const auto visit = [&]<class Form>(const auto& field, const Form&) {
    if constexpr (!std::is_same_v<Form, Object<Region>>) act(field.key, settings.*field.member);
  };
  std::apply([&](const auto&... field) { (visit(field, field.form), ...); },
             StructureSettings::fields());
}

}  // namespace

bool read_part(const Reader& reader, Region& region) {
  region = pore_region;
  return read_object(region_fields, reader, region);
}
Json written_part(const Region& region) {
  return written_object(region_fields, region);
}
Json part_schema(std::type_identity<Region>, Definitions& definitions) {
  ObjectSchema schema = object_schema(region_fields, definitions);
  schema.properties["from_sides"]["default"] = plain_number(pore_region.from_sides);
  return schema.json();
}

std::optional<std::string> part_fault(const HolesSettings& holes) {
  const BondLengths& bonds = holes.bonds;
  if (bonds.last >= bonds.first) return std::nullopt;
  return finite_text("bond lengths from {} to {} are none: first must not be above last",
                     bonds.first, bonds.last);
}

bool read_part(const Reader& reader, StructureSettings& settings) {
  return read_object(StructureSettings::fields(), reader, settings);
}
Json written_part(const StructureSettings& settings) {
  return written_object(StructureSettings::fields(), settings);
}
Json part_schema(std::type_identity<StructureSettings>, Definitions& definitions) {
  return object_schema(StructureSettings::fields(), definitions).json();
}

Json resolved(const StructureSettings& settings) {
  return written_part(settings);
}

std::vector<std::string> parts_of(const StructureSettings& settings) {
  std::vector<std::string> names;
  for_each_part(settings, [&](std::string_view name, const auto& part) {
    if (part) names.emplace_back(name);
  });
  return names;
}

StructureSettings with_parts(StructureSettings settings, std::span<const std::string> names) {
  for_each_part(settings, [&](std::string_view name, auto& part) {
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
  StructureSettings settings;
  read_part(Reader{*json, "", parsed.faults}, settings);
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
  const bool has_snapshots = scene.snapshots.every || !chosen_taps(scene.snapshots.taps).empty();
  if (!scene.snapshots.positions || !has_snapshots) {
    faults.push_back({"/structure",
                      "structure is measured in kept packings: give /snapshots taps, and "
                      "\"positions\" among what they keep"});
  }
}

}  // namespace jostle::inline config
