#include <fmt/format.h>

#include <algorithm>

#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

constexpr Whole count_form{1, most_spheres};
constexpr auto kinds_form = list_of(Object<MixtureKind>{}, 1, most_kinds, "kinds of spheres");

/// A number, or a law under its name.
struct DiameterForm {};
using SpreadDiameter =
    std::variant<LognormalDiameter, NormalDiameter, UniformDiameter, ListedDiameters>;

bool read_value(const DiameterForm&, const Reader& reader, DiameterLaw& target) {
  if (reader.value().is_number()) {
    FixedDiameter fixed;
    const bool read = read_value(diameter_form, reader, fixed.value);
    target = fixed;
    return read;
  }
  if (!reader.value().is_object()) {
    reader.wrong_type(fmt::format("{}, or an object with one of the keys {}",
                                  expected(diameter_form), listed(names_of<SpreadDiameter>())));
    return false;
  }
  SpreadDiameter spread;
  if (!read_value(OneOf<SpreadDiameter>{}, reader, spread)) return false;
  std::visit([&](auto& law) { target = std::move(law); }, spread);
  return reader.sound();
}
Json written_value(const DiameterForm&, const DiameterLaw& diameter) {
  return std::visit(
      []<class Law>(const Law& law) -> Json {
        if constexpr (std::is_same_v<Law, FixedDiameter>) {
          return plain_number(law.value);
        } else {
          return written_value(OneOf<SpreadDiameter>{}, SpreadDiameter(law));
        }
      },
      diameter);
}
Json value_schema(const DiameterForm&, Definitions& definitions) {
  return either(value_schema(diameter_form, definitions),
                value_schema(OneOf<SpreadDiameter>{}, definitions));
}

/// [x, y]
struct PlaceForm {};
constexpr Number coordinate_form{closed_range(0, widest_container), "diameters"};

bool read_value(const PlaceForm&, const Reader& reader, std::array<double, 2>& place) {
  if (!reader.is_list(2, 2, "numbers, x and y")) return false;
  const bool x = read_value(coordinate_form, reader.element(0), place[0]);
  const bool y = read_value(coordinate_form, reader.element(1), place[1]);
  return x && y;
}
Json written_value(const PlaceForm&, const std::array<double, 2>& place) {
  return Json::array({plain_number(place[0]), plain_number(place[1])});
}
Json value_schema(const PlaceForm&, Definitions& definitions) {
  return {{"type", "array"},
          {"minItems", 2},
          {"maxItems", 2},
          {"items", value_schema(coordinate_form, definitions)}};
}

constexpr std::tuple kind_fields{
    field("name", &MixtureKind::name, kind_name_form,
          "Name of the kind, by which observables and files know it",
          {.required = "the name of the kind"}),
    field("count", &MixtureKind::count, count_form, "Number of spheres of the kind",
          {.required = "the number of spheres of the kind"}),
    field("diameter", &MixtureKind::diameter, DiameterForm{},
          "One diameter for all spheres of the kind, or a law from which every realization draws "
          "them"),
    field("density", &MixtureKind::density, Number{closed_range(least_density, greatest_density)},
          "Density relative to that of a sphere of mass 1 and diameter 1"),
    field("place", &MixtureKind::place, PlaceForm{},
          "x and y of the place above which a single sphere is poured, diameters; it is poured "
          "before "
          "all spheres without a place")};

}  // namespace

bool read_part(const Reader& reader, MixtureKind& kind) {
  if (!read_object(kind_fields, reader, kind)) return false;
  const auto diameter = reader.find("diameter");
  if (diameter && reader.sound()) {
    if (const auto fault = diameter_fault(kind.diameter, kind.count)) diameter->fault(*fault);
  }
  const auto place = reader.find("place");
  if (place && reader.sound() && kind.count != 1)
    place->fault(
        fmt::format("a place is that of one sphere, and the kind has {}: set \"count\" to "
                    "1, or leave the place out",
                    kind.count));
  return true;
}
Json written_part(const MixtureKind& kind) {
  return written_object(kind_fields, kind);
}
Json part_schema(std::type_identity<MixtureKind>, Definitions& definitions) {
  return object_schema(kind_fields, definitions).json();
}

void read_spheres(const Reader& reader, Scene& scene) {
  if (!reader.value().is_array()) {
    if (reader.value().is_number()) {
      read_value(count_form, reader, scene.n_spheres);
    } else {
      reader.wrong_type(expected(count_form) + ", or a list of kinds of spheres");
    }
    return;
  }
  read_value(kinds_form, reader, scene.kinds);
  if (!reader.sound()) return;
  for (std::string& fault : mixture_faults(scene.kinds)) reader.fault(std::move(fault));
  if (reader.sound()) scene.n_spheres = static_cast<std::uint32_t>(n_spheres_of(scene.kinds));
}

Json written_spheres(const Scene& scene) {
  if (scene.kinds.empty()) return std::uint64_t{scene.n_spheres};
  return written_value(kinds_form, scene.kinds);
}

Json spheres_schema(Definitions& definitions) {
  return either(value_schema(count_form, definitions), value_schema(kinds_form, definitions));
}

std::vector<Observable> default_observables(const std::vector<MixtureKind>& kinds) {
  constexpr std::size_t most = 10;  // heights of kinds, each a column of every series
  std::vector<Observable> observables{MeanHeight{}, BottomFraction{}, BulkFraction{}};
  for (const MixtureKind& kind : kinds) {
    const Observable height = KindHeight{kind.name};
    const bool is_new = std::ranges::find(observables, height) == observables.end();
    if (is_new && kinds.size() <= most) observables.push_back(height);
  }
  return observables;
}

}  // namespace jostle::inline config
