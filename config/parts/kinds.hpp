#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "config/json/reader.hpp"

// A variant of a scene - taps, starts, observables, stops, containers - as one table: an entry an
// alternative, in their order. The table's type is made of the variant's, so that an alternative
// without an entry does not compile.
namespace jostle::inline config {

/// A tuple of Entry<Alternative>, one for every alternative of the variant.
template <template <class> class Entry, class Variant>
struct TableOf;
template <template <class> class Entry, class... Alternatives>
struct TableOf<Entry, std::variant<Alternatives...>> {
  using Type = std::tuple<Entry<Alternatives>...>;
};

/// How scenes write an alternative. Those that share a name are read by the first that has it.
template <class Variant>
struct KindOf {
  template <class Alternative>
  struct Entry {
    using Part = Alternative;
    std::string_view name;
    Variant (*read)(const Reader&);
    Json (*write)(const Alternative&);
  };
};

template <class Variant>
using Kinds = typename TableOf<KindOf<Variant>::template Entry, Variant>::Type;

/// The names of a table, each once.
template <class Table>
std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  const auto add = [&](std::string_view name) {
    if (std::ranges::find(names, name) == names.end()) names.emplace_back(name);
  };
  std::apply([&](const auto&... kinds) { (add(kinds.name), ...); }, table);
  return names;
}

/// What read(entry) gives for the first entry of that name, which is one of the table's.
template <class Table, class Read>
auto read_kind(const Table& table, std::string_view name, const Read& read) {
  std::optional<decltype(read(std::get<0>(table)))> value;
  const auto read_if_named = [&](const auto& kind) {
    if (!value && kind.name == name) value = read(kind);
  };
  std::apply([&](const auto&... kinds) { (read_if_named(kinds), ...); }, table);
  return std::move(value).value();
}

/// The alternative that `choice` names.
template <class Table>
auto read_kind(const Table& table, const Choice& choice) {
  return read_kind(table, choice.name,
                   [&](const auto& kind) { return kind.read(choice.settings); });
}

/// What make(entry, alternative) gives for the alternative that the value holds.
template <class Table, class Variant, class Make>
auto with_kind(const Table& table, const Variant& value, const Make& make) {
  std::optional<decltype(make(std::get<0>(table), std::get<0>(value)))> made;
  const auto make_if_held = [&](const auto& kind) {
    using Part = typename std::decay_t<decltype(kind)>::Part;
    if (const auto* part = std::get_if<Part>(&value)) made = make(kind, *part);
  };
  std::apply([&](const auto&... kinds) { (make_if_held(kinds), ...); }, table);
  return std::move(made).value();
}

template <class Table, class Variant>
std::string name_of(const Table& table, const Variant& value) {
  return with_kind(table, value,
                   [](const auto& kind, const auto&) { return std::string(kind.name); });
}

/// The settings of the alternative.
template <class Table, class Variant>
Json written_settings(const Table& table, const Variant& value) {
  return with_kind(table, value,
                   [](const auto& kind, const auto& part) { return kind.write(part); });
}

/// {"name": settings}
template <class Table, class Variant>
Json written_kind(const Table& table, const Variant& value) {
  return {{name_of(table, value), written_settings(table, value)}};
}

}  // namespace jostle::inline config
