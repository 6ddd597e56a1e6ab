#pragma once

#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "config/json/json_text.hpp"

namespace jostle::inline config {

/// A choice as scenes write it: {"name": settings}, or "name" alone where every setting has a
/// default (settings are then an empty object).
struct Choice;

/// A value of a scene with its place in the file. An invalid value is recorded as a fault and keeps
/// its default, so that reading continues and finds all faults.
class Reader {
 public:
  Reader(const Json& value, std::string pointer, std::vector<Fault>& faults)
      : value_(&value), pointer_(std::move(pointer)), faults_(&faults) {}

  const Json& value() const { return *value_; }
  const std::string& pointer() const { return pointer_; }
  void fault(std::string message) const { faults_->push_back({pointer_, std::move(message)}); }
  /// Notes that the value is something else than what is expected.
  void wrong_type(std::string_view expected) const;
  /// Notes that a key is missing; `content` describes its content.
  void missing(std::string_view key, std::string_view content) const;
  /// Tests if no fault was noted at this value or below it.
  bool sound() const;

  /// Tests if this is an object; keys other than `allowed` are faults.
  bool is_object_of(const std::vector<std::string>& allowed) const;
  /// Tests if this is a list of `least` to `most` values.
  bool is_list(std::size_t least, std::size_t most, std::string_view of_what) const;
  Reader element(std::size_t index) const;
  std::optional<Reader> find(const std::string& key) const;
  /// Returns find(key); calls missing(key, content) where there is none and `content` is not empty.
  std::optional<Reader> member(std::string_view key, std::string_view content) const;

  /// The value itself; nothing, and a fault, where it has another type or is out of range. Numbers
  /// are read by their form (config/fields/values.hpp).
  std::optional<std::uint64_t> whole_number(std::uint64_t least, std::uint64_t most) const;
  std::optional<bool> boolean() const;
  std::optional<std::string> text() const;
  /// One of `names`.
  std::optional<std::string> one_of(const std::vector<std::string>& names) const;
  /// The enumerator that this names; `names` is a table of (name, enumerator).
  template <class Names>
  auto named(const Names& names) const {
    std::vector<std::string> allowed;
    for (const auto& [name, value] : names) allowed.emplace_back(name);
    const auto written = one_of(allowed);
    std::optional<std::decay_t<decltype(names.begin()->second)>> found;
    for (const auto& [name, value] : names) {
      if (written && *written == name) found = value;
    }
    return found;
  }
  /// {"name": settings} with one of `names`.
  std::optional<Choice> choice(const std::vector<std::string>& names) const;
  /// "name" or {"name": settings}.
  std::optional<Choice> named_choice(const std::vector<std::string>& names) const;

 private:
  const Json* value_;
  std::string pointer_;
  std::vector<Fault>* faults_;
};

struct Choice {
  std::string name;
  Reader settings;
};

/// "the string \"abc\"", "the number 3", "an object": a value as messages name it.
std::string described(const Json& value);

/// "a, b, c".
std::string listed(const std::vector<std::string>& names);

/// Tests if no fault was noted at `pointer` or below.
bool sound(const std::vector<Fault>& faults, std::string_view pointer);

}  // namespace jostle::inline config
