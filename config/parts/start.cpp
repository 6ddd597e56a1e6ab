#include <algorithm>

#include "config/names.hpp"
#include "config/parts/kinds.hpp"
#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

StartChoice read_pour(const Reader& in) {
  const auto pour = in.named_choice({"steepest_descent", "fitted"});
  if (!pour) return SteepestDescentPour{};
  if (pour->name == "steepest_descent") {
    pour->settings.is_object_of({});
    return SteepestDescentPour{};
  }
  // Of the rule before: random moves of every sphere.
  for (const std::string moves : {"max_step", "max_sweeps"}) {
    if (const auto key = pour->settings.find(moves)) {
      key->fault(
          "a fitted pour has no settings any more: it pours the spheres that overlap a wall again "
          "and moves no others, so there are no random moves to bound; write {\"pour\": "
          "\"fitted\"}");
      return FittedPour{};
    }
  }
  pour->settings.is_object_of({});
  return FittedPour{};
}

StartChoice read_random_settle(const Reader& in) {
  RandomSettle settle;
  if (in.is_object_of({"dilute_fraction", "drop_height"})) {
    in.read("dilute_fraction", settle.dilute_fraction, above(0, densest_dilution));
    in.read("drop_height", settle.drop_height, between(0, highest_drop));
  }
  return settle;
}

StartChoice read_crystal(const Reader& in) {
  Crystal crystal;
  if (in.value().is_string()) {
    if (const auto lattice = in.named(lattices)) crystal.lattice = *lattice;
  } else if (in.is_object_of({"lattice", "stretch"})) {
    if (!in.find("lattice"))
      in.missing("lattice", "one of the strings " + listed(names_in(lattices)));
    in.read_name("lattice", crystal.lattice, lattices);
    in.read_flag("stretch", crystal.stretch);
  }
  return crystal;
}

StartChoice read_grow(const Reader& in) {
  Grow grow;
  if (in.is_object_of({"max_sweeps"})) in.read_whole("max_sweeps", grow.max_sweeps, 1, most_sweeps);
  return grow;
}

bool ends_with_one_of(const std::string& path, std::initializer_list<std::string_view> endings) {
  return std::any_of(endings.begin(), endings.end(),
                     [&](std::string_view ending) { return path.ends_with(ending); });
}

/// "last" or a number.
void read_last_or(const Reader& in, const std::string& key, std::optional<std::uint64_t>& into) {
  const auto member = in.find(key);
  if (!member || member->value() == "last") return;
  if (member->value().is_number()) {
    into = member->whole_number(0, most_sweeps);
  } else {
    member->fault("expected a whole number or \"last\", found " + described(member->value()));
  }
}

void check_path(const Reader& in, const std::string& path) {
  if (ends_with_one_of(path, {".h5", ".hdf5", ".xyz", ".extxyz"})) return;
  in.fault(
      "a packing file must end in .h5 or .hdf5 (results of an earlier run), or in .xyz or "
      ".extxyz (extended XYZ)");
}

StartChoice read_file(const Reader& in) {
  PackingFile file;
  if (in.value().is_string()) {
    file.path = in.value().text();
    check_path(in, file.path);
    return file;
  }
  const std::vector<std::string> of_results{"path", "point", "realization", "tap", "overlap"};
  const std::vector<std::string> of_xyz{"path", "frame", "overlap"};
  const auto path = in.find("path");
  if (path) {
    file.path = path->text().value_or("");
    if (path->sound()) check_path(*path, file.path);
  }
  const bool known = path && path->sound();
  const bool xyz = known && ends_with_one_of(file.path, {".xyz", ".extxyz"});
  if (!in.is_object_of(xyz     ? of_xyz
                       : known ? of_results
                               : std::vector<std::string>{"path", "point", "realization", "tap",
                                                          "frame", "overlap"})) {
    return file;
  }
  if (!path) in.missing("path", "the file of a saved packing, from the folder of the scene");
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  in.read_whole("point", file.point, 0, most);
  in.read_whole("realization", file.realization, 0, most);
  read_last_or(in, "tap", file.tap);
  read_last_or(in, "frame", file.frame);
  in.read("overlap", file.overlap, between(0, deepest_given_overlap));
  return file;
}

Json number_or_last(const std::optional<std::uint64_t>& number) {
  return number ? Json(*number) : Json("last");
}

Json written_crystal(const Crystal& crystal) {
  return {{"lattice", name_in(lattices, crystal.lattice)}, {"stretch", crystal.stretch}};
}

Json written_file(const PackingFile& file) {
  Json out{{"path", file.path}};
  if (ends_with_one_of(file.path, {".xyz", ".extxyz"})) {
    out["frame"] = number_or_last(file.frame);
  } else {
    out["point"] = file.point;
    out["realization"] = file.realization;
    out["tap"] = number_or_last(file.tap);
  }
  if (file.overlap > 0) out["overlap"] = plain_number(file.overlap);
  return out;
}

constexpr Kinds<StartChoice> start_kinds{
    {"pour", read_pour, [](const SteepestDescentPour&) { return Json("steepest_descent"); }},
    {"pour", read_pour, [](const FittedPour&) { return Json("fitted"); }},
    {"random_settle", read_random_settle,
     [](const RandomSettle& settle) -> Json {
       Json out = {{"dilute_fraction", plain_number(settle.dilute_fraction)}};
       if (settle.drop_height > 0) out["drop_height"] = plain_number(settle.drop_height);
       return out;
     }},
    {"crystal", read_crystal, written_crystal},
    {"grow", read_grow,
     [](const Grow& grow) -> Json {
       return {{"max_sweeps", grow.max_sweeps}};
     }},
    {"file", read_file, written_file}};

}  // namespace

StartChoice read_start(const Reader& in) {
  const auto start = in.choice(names_of(start_kinds));
  if (!start) return SteepestDescentPour{};
  return read_kind(start_kinds, *start);
}

Start engine_start(const StartChoice& choice) {
  return std::visit(
      [](const auto& start) -> Start {
        if constexpr (std::is_same_v<std::decay_t<decltype(start)>, PackingFile>) {
          return GivenPacking{nullptr, start.overlap};
        } else {
          return start;
        }
      },
      choice);
}

std::string key_of(const StartChoice& start) {
  return name_of(start_kinds, start);
}

Json written(const StartChoice& start) {
  return written_kind(start_kinds, start);
}

}  // namespace jostle::inline config
