#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

/// {"pour": "steepest_descent"} or {"pour": "fitted"}: two starts under one name.
using Pour = std::variant<SteepestDescentPour, FittedPour>;
constexpr OneOf<Pour> pour_form{.by_name = true};
constexpr std::string_view pour_key = "pour";

template <class Part>
constexpr bool is_pour =
    std::is_same_v<Part, SteepestDescentPour> || std::is_same_v<Part, FittedPour>;

std::vector<std::string> start_names() {
  std::vector<std::string> names{std::string(pour_key)};
  for_each_alternative<StartChoice>([&]<class Part>(std::type_identity<Part>) {
    if (!is_pour<Part>) names.emplace_back(Part::description.name);
  });
  return names;
}

void read_pour(const Reader& reader, StartChoice& target) {
  // A setting of the former rule: random moves of every sphere.
  if (const auto fitted = reader.find("fitted")) {
    for (const std::string moves : {"max_step", "max_sweeps"}) {
      if (const auto key = fitted->find(moves))
        return key->fault(
            "a fitted pour has no settings any more: it pours the spheres that overlap a wall "
            "again and moves no others, so there are no random moves to bound; write {\"pour\": "
            "\"fitted\"}");
    }
  }
  Pour pour;
  read_value(pour_form, reader, pour);
  std::visit([&](const auto& kind) { target = kind; }, pour);
}

/// The name of a file with a packing, by its ending: "h5|hdf5".
struct PackingPath {
  std::string_view endings;
};
constexpr std::string_view results_endings = "h5|hdf5", xyz_endings = "xyz|extxyz",
                           all_endings = "h5|hdf5|xyz|extxyz";

bool ends_with_one_of(std::string_view path, std::string_view endings) {
  for (std::size_t begin = 0; begin < endings.size();) {
    const std::size_t end = std::min(endings.find('|', begin), endings.size());
    if (path.ends_with(fmt::format(".{}", endings.substr(begin, end - begin)))) return true;
    begin = end + 1;
  }
  return false;
}

bool read_value(const PackingPath& form, const Reader& reader, std::string& target) {
  const auto path = reader.text();
  if (!path) return false;
  target = *path;
  if (ends_with_one_of(target, form.endings)) return true;
  reader.fault(
      "a packing file must end in .h5 or .hdf5 (results of an earlier run), or in .xyz or "
      ".extxyz (extended XYZ)");
  return false;
}
Json written_value(const PackingPath&, const std::string& path) {
  return path;
}
Json value_schema(const PackingPath& form, Definitions&) {
  return {{"type", "string"}, {"pattern", fmt::format("\\.({})$", form.endings)}};
}

constexpr auto path_of(std::string_view endings) {
  return std::tuple{
      field("path", &PackingFile::path, PackingPath{endings}, "Path from the folder of the scene",
            {.required = "the file of a saved packing, from the folder of the scene"})};
}
constexpr std::uint64_t most_indices = std::numeric_limits<std::uint32_t>::max();
constexpr auto number_or_last = or_word(Whole{0, most_sweeps}, "last");
constexpr std::tuple of_results{
    field("point", &PackingFile::point, Whole{0, most_indices}, "Index of the sweep point"),
    field("realization", &PackingFile::realization, Whole{0, most_indices},
          "Index of the realization"),
    field("tap", &PackingFile::tap, number_or_last, "Tap of a snapshot")};
constexpr std::tuple of_xyz{
    field("frame", &PackingFile::frame, number_or_last, "Index of the frame")};
constexpr std::tuple of_both{
    field("overlap", &PackingFile::overlap, Number{closed_range(0, deepest_given_overlap)},
          "The deepest overlap that is accepted, diameters; above 0 with discrete elements only",
          {.unless_default = true})};

constexpr auto results_fields = std::tuple_cat(path_of(results_endings), of_results, of_both);
constexpr auto xyz_fields = std::tuple_cat(path_of(xyz_endings), of_xyz, of_both);
constexpr auto all_fields = std::tuple_cat(path_of(all_endings), of_results, of_xyz, of_both);

}  // namespace

bool read_part(const Reader& reader, Crystal& crystal) {
  if (reader.value().is_string()) return read_value(word(lattices), reader, crystal.lattice);
  return read_object(Crystal::fields(), reader, crystal);
}
Json part_schema(std::type_identity<Crystal>, Definitions& definitions) {
  return either(value_schema(word(lattices), definitions),
                object_schema(Crystal::fields(), definitions).json());
}

bool read_part(const Reader& reader, PackingFile& file) {
  if (reader.value().is_string()) return read_value(PackingPath{all_endings}, reader, file.path);
  const Json* path = reader.value().find("path");
  if (path != nullptr && path->is_string()) {
    if (ends_with_one_of(path->text(), results_endings))
      return read_object(results_fields, reader, file);
    if (ends_with_one_of(path->text(), xyz_endings)) return read_object(xyz_fields, reader, file);
  }
  return read_object(all_fields, reader, file);
}
Json written_part(const PackingFile& file) {
  return ends_with_one_of(file.path, xyz_endings) ? written_object(xyz_fields, file)
                                                  : written_object(results_fields, file);
}
Json part_schema(std::type_identity<PackingFile>, Definitions& definitions) {
  return {{"anyOf", Json::array({value_schema(PackingPath{all_endings}, definitions),
                                 object_schema(results_fields, definitions).json(),
                                 object_schema(xyz_fields, definitions).json()})}};
}

bool read_value(const OneOf<StartChoice>&, const Reader& reader, StartChoice& target) {
  const auto start = reader.choice(start_names());
  if (!start) return false;
  if (start->name == pour_key) {
    read_pour(start->settings, target);
  } else {
    read_alternative(start->name, start->settings, target);
  }
  return true;
}

Json written_value(const OneOf<StartChoice>&, const StartChoice& start) {
  return std::visit(
      [&]<class Part>(const Part& part) -> Json {
        Json settings;
        if constexpr (is_pour<Part>) {
          settings = written_value(pour_form, Pour(part));
        } else {
          settings = written_part(part);
        }
        return {{key_of(start), settings}};
      },
      start);
}

Json value_schema(const OneOf<StartChoice>&, Definitions& definitions) {
  ObjectSchema schema = alternatives_schema<StartChoice>(definitions);
  Json properties{
      {std::string(pour_key),
       described_as(value_schema(pour_form, definitions), "Pour by steepest descent",
                    "steepest_descent: into the container as it is. fitted: with periodic sides; "
                    "the spheres that overlap a wall are then taken out and poured again between "
                    "the walls, no other sphere moves.",
                    std::nullopt, "")}};
  for (const auto& [name, settings] : schema.properties.members()) {
    const std::vector<std::string> names = start_names();
    if (std::ranges::find(names, name) != names.end()) properties[name] = settings;
  }
  schema.properties = std::move(properties);
  return schema.json();
}

Start engine_start(const StartChoice& choice) {
  return std::visit(
      []<class Part>(const Part& start) -> Start {
        if constexpr (std::is_same_v<Part, PackingFile>) {
          return GivenPacking{nullptr, start.overlap};
        } else {
          return start;
        }
      },
      choice);
}

std::string key_of(const StartChoice& start) {
  return std::visit(
      []<class Part>(const Part& part) {
        return std::string(is_pour<Part> ? pour_key : part.description.name);
      },
      start);
}

}  // namespace jostle::inline config
