#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>

// How a part of a scene describes itself: the list of its fields, each with name, member, range,
// unit and one line of documentation. From the list come the reader, the writer, the JSON schema
// and the reference of scenes (config/fields). Defaults are those of the part itself. Plain data:
// nothing here knows JSON. fields() is a template over the part itself, so that it is compiled only
// where it is called: config/scene.hpp, which most sources include, takes half the time to compile.
namespace jostle::inline engine {

/// The numbers that a value may take.
struct Range {
  double low = 0, high = 0;
  bool low_included = true, high_included = true;

  constexpr bool contains(double value) const {
    return (low_included ? value >= low : value > low) &&
           (high_included ? value <= high : value < high);
  }
};
constexpr Range closed_range(double low, double high) {
  return {low, high};
}
constexpr Range left_open_range(double low, double high) {
  return {low, high, false, true};
}
constexpr Range open_range(double low, double high) {
  return {low, high, false, false};
}

/// The names of the enumerators in scenes.
template <class Enum, std::size_t n>
using NameTable = std::array<std::pair<std::string_view, Enum>, n>;

/// A part that is one of several: what scenes call it, and what it is.
struct Description {
  std::string_view name;
  std::string_view text = {};
  std::string_view title = {};
  std::string_view symbol = {};  // on axes
};

// The forms of values.

struct Number {
  Range range;
  std::string_view unit = {};
};

/// The strength of a tap: a number, or a ramp of numbers in its place.
struct Strength {
  Range range;
  std::string_view unit = {};
  bool in_roots = false;  // ramps may step its square root
};

struct Whole {
  std::uint64_t least = 0, most = std::numeric_limits<std::uint64_t>::max();
};

struct Flag {};

/// One of the names of a table.
template <std::size_t n, class Enum>
struct Word {
  NameTable<Enum, n> names;
};
template <std::size_t n, class Enum>
constexpr Word<n, Enum> word(const std::array<std::pair<std::string_view, Enum>, n>& names) {
  return {names};
}

/// Any text, or text of certain characters.
struct Text {
  std::string_view first = {};  // character that it begins with: "a-z"; empty: any text
  std::string_view rest = {};   // those that follow: "a-z0-9_"
  std::size_t longest = 0;
  std::string_view rule = {};  // this in words
};

/// A value, or a word in its place: "last", "never", "infinity". The word stands for a value that
/// is absent; for a number it is infinity.
template <class Form>
struct OrWord {
  Form form;
  std::string_view word;
};
template <class Form>
constexpr OrWord<Form> or_word(Form form, std::string_view word) {
  return {form, word};
}

/// Two numbers, [low, high], the first the lower.
struct Bounds {
  Range low, high;
  std::string_view numbers = "numbers, low and high";
  std::string_view slice = "window";
  std::string_view rule = "the first number must be the lower";
};
constexpr Bounds bounds(Range range) {
  return {range, range};
}
/// Heights above a floor, diameters.
inline constexpr Bounds height_bounds = bounds(closed_range(0, 1e6));

/// A list of taps, or a logarithmic grid.
struct TapNumbers {};

/// A part with fields of its own. A part that several others have is described once in the schema,
/// under the name of its definition.
template <class Part>
struct Object {
  std::string_view definition = {};
};

/// {"name": settings} with the name of an alternative; with `by_name` also "name", where every
/// setting has a default.
template <class Variant>
struct OneOf {
  bool by_name = false;
  std::string_view definition = {};
};

template <class Form>
struct ListOf {
  Form form;
  std::size_t least = 0, most = 0;
  std::string_view of_what = {};
  bool ascending = false;  // each once, put in order
};
template <class Form>
constexpr ListOf<Form> list_of(Form form, std::size_t least, std::size_t most,
                               std::string_view of_what, bool ascending = false) {
  return {form, least, most, of_what, ascending};
}

// The fields of a part.

/// Rare properties of a field.
struct Notes {
  std::string_view required = {};  // content of a required key; empty: it may be absent
  bool unless_default = false;     // written only where the value is not the default
  std::string_view title = {};
  std::string_view examples = {};       // a JSON list
  std::string_view ladder_symbol = {};  // symbol of a number that `jostle cost` varies
};

/// One key of a part. A part that is a single value has one field with an empty key. An optional
/// member has no default: it may be absent.
template <class Part, class Value, class Form>
struct Field {
  std::string_view key;
  Value Part::*member;
  Form form;
  std::string_view text;  // without the unit and the full stop
  Notes notes;
};
template <class Part, class Value, class Form>
constexpr Field<Part, Value, Form> field(std::string_view key, Value Part::*member, Form form,
                                         std::string_view text = {}, Notes notes = {}) {
  return {key, member, form, text, notes};
}

/// The fields of a member, among those of the part that has it.
template <class Part, class Inner>
struct Inlined {
  Inner Part::*member;
};
template <class Part, class Inner>
constexpr Inlined<Part, Inner> inlined(Inner Part::*member) {
  return {member};
}

/// The alternative of a member, under its name among the keys of the part.
template <class Part, class Variant>
struct Alternative {
  Variant Part::*member;
};
template <class Part, class Variant>
constexpr Alternative<Part, Variant> alternative(Variant Part::*member) {
  return {member};
}

/// A number under one of several keys; the key gives its kind.
template <class Part, class Kind, std::size_t n>
struct KeyedNumber {
  double Part::*value;
  Kind Part::*kind;
  NameTable<Kind, n> keys;
  std::array<Number, n> forms;
  std::array<std::string_view, n> texts;
  bool required = false;
};

template <class Part, class Kind, std::size_t n>
constexpr KeyedNumber<Part, Kind, n> keyed_number(
    double Part::*value, Kind Part::*kind,
    const std::array<std::pair<std::string_view, Kind>, n>& keys,
    const std::array<Number, n>& forms, const std::array<std::string_view, n>& texts,
    bool required = false) {
  return {value, kind, keys, forms, texts, required};
}

/// A number for two members, or a list of two.
template <class Part>
struct NumberPair {
  std::string_view key;
  double Part::*first;
  double Part::*second;
  Number form;
  std::string_view text;
  std::string_view required;
};

}  // namespace jostle::inline engine
