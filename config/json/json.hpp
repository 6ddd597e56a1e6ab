#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace jostle::inline config {

/// A JSON value that is not of the kind it was read as, or has not the member that was asked for.
class JsonError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A JSON value; keys keep the order in which they are written. parse_and_print.cpp alone sees the
/// library that parses and prints: it takes longer to compile than the rest of this folder.
class Json {
 public:
  struct Member;

  Json();  // null
  Json(std::nullptr_t) : Json() {}
  Json(bool value);
  Json(double value);
  Json(const char* text);
  Json(std::string text);
  Json(std::string_view text);
  template <std::integral Whole>
  Json(Whole value) : Json() {
    if (value < 0) {
      set_negative(static_cast<std::int64_t>(value));
    } else {
      set_whole(static_cast<std::uint64_t>(value));
    }
  }
  /// A list of its elements.
  template <class Element>
  Json(const std::vector<Element>& elements) : Json(array()) {
    for (const Element& element : elements) push_back(element);
  }
  /// An object: Json{{"name", "x"}, {"count", 3}}.
  Json(std::initializer_list<Member> members);

  Json(const Json&);
  Json(Json&&) noexcept;
  Json& operator=(const Json&);
  Json& operator=(Json&&) noexcept;
  ~Json();

  static Json array(std::initializer_list<Json> elements = {});
  static Json object();
  /// Throws JsonError where the text is no JSON. Reader reads what users write (json_text.hpp).
  static Json parse(std::string_view text);

  bool is_null() const;
  bool is_boolean() const;
  bool is_number() const;
  /// Written without a point or an exponent.
  bool is_number_integer() const;
  bool is_string() const;
  bool is_array() const;
  bool is_object() const;
  bool is_structured() const { return is_array() || is_object(); }

  /// The value as what it is; JsonError where it is something else.
  bool boolean() const;
  double number() const;
  /// Also of a number with a point or an exponent, below exact_doubles.
  std::uint64_t whole_number() const;
  std::int64_t signed_number() const;  // An integer below 2^63
  const std::string& text() const;
  const std::vector<Json>& elements() const;
  const std::vector<Member>& members() const;

  /// Elements or members; of any other value 1, of null 0.
  std::size_t size() const;
  bool empty() const { return size() == 0; }

  /// A member of an object; nothing where there is none, also of what is no object.
  const Json* find(std::string_view key) const;
  bool contains(std::string_view key) const { return find(key) != nullptr; }
  /// Throws JsonError where there is none.
  const Json& at(std::string_view key) const;
  const Json& at(std::size_t index) const;
  /// Returns the value at a JSON pointer (RFC 6901), or nothing.
  const Json* find_pointer(std::string_view pointer) const;
  Json* find_pointer(std::string_view pointer);

  /// The member, added where there is none; null becomes an object.
  Json& operator[](std::string_view key);
  void erase(std::string_view key);
  /// Every member of another object, in the place of one that has its key.
  void update(const Json& object);
  /// null becomes a list.
  void push_back(Json element);

  /// On one line, or over several with `indent` blanks a level. Text that is not UTF-8 shows U+FFFD
  /// for the bytes that are none.
  std::string dump(int indent = -1) const;

  /// Numbers are equal by value: 1 is 1.0. Objects have the same members in the same order.
  bool operator==(const Json& rhs) const;

 private:
  using List = std::vector<Json>;
  using Members = std::vector<Member>;

  void set_negative(std::int64_t value);
  void set_whole(std::uint64_t value);

  std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, List,
               Members>
      value_;  // an std::int64_t is below zero
};

struct Json::Member {
  std::string key;
  Json value;
  bool operator==(const Member& rhs) const = default;
};

/// 2^53. Every whole number below it is a double, and no other whole number rounds to that double.
inline constexpr double exact_doubles = 0x1p53;

/// The fault of a whole number from exact_doubles to 2^64 that has a point or an exponent.
std::string inexact_whole_text(double number);

/// The version of the library that parses and prints: "3.11.2".
std::string json_library_version();

}  // namespace jostle::inline config
