#include "config/json/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

namespace jostle::inline config {

namespace {

const char* kind_of(const Json& value) {
  if (value.is_null()) return "null";
  if (value.is_boolean()) return "a boolean";
  if (value.is_number()) return "a number";
  if (value.is_string()) return "a string";
  return value.is_array() ? "a list" : "an object";
}

[[noreturn]] void wrong_kind(const char* expected, const Json& found) {
  throw JsonError(fmt::format("expected {}, found {}", expected, kind_of(found)));
}

/// "~1" is "/" and "~0" is "~"; nothing for any other use of "~".
std::optional<std::string> unescaped(std::string_view token) {
  std::string key;
  for (std::size_t i = 0; i < token.size(); ++i) {
    if (token[i] != '~') {
      key += token[i];
      continue;
    }
    if (++i == token.size() || (token[i] != '0' && token[i] != '1')) return std::nullopt;
    key += token[i] == '0' ? '~' : '/';
  }
  return key;
}

/// The index that a token writes, without leading zeros; nothing where it is none.
std::optional<std::size_t> index_of(std::string_view token) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), index);
  const bool whole = error == std::errc() && end == token.data() + token.size();
  if (!whole || (token.size() > 1 && token.front() == '0')) return std::nullopt;
  return index;
}

}  // namespace

Json::Json() = default;
Json::Json(bool value) : value_(value) {}
Json::Json(double value) : value_(value) {}
Json::Json(const char* text) : value_(std::string(text)) {}
Json::Json(std::string text) : value_(std::move(text)) {}
Json::Json(std::string_view text) : value_(std::string(text)) {}
Json::Json(std::initializer_list<Member> members) : value_(Members(members)) {}
Json::Json(const Json&) = default;
Json::Json(Json&&) noexcept = default;
Json& Json::operator=(const Json&) = default;
Json& Json::operator=(Json&&) noexcept = default;
Json::~Json() = default;

void Json::set_negative(std::int64_t value) {
  value_ = value;
}

void Json::set_whole(std::uint64_t value) {
  value_ = value;
}

Json Json::array(std::initializer_list<Json> elements) {
  Json list;
  list.value_ = List(elements);
  return list;
}

Json Json::object() {
  Json object;
  object.value_ = Members();
  return object;
}

bool Json::is_null() const {
  return std::holds_alternative<std::monostate>(value_);
}

bool Json::is_boolean() const {
  return std::holds_alternative<bool>(value_);
}

bool Json::is_number() const {
  return is_number_integer() || std::holds_alternative<double>(value_);
}

bool Json::is_number_integer() const {
  return std::holds_alternative<std::int64_t>(value_) ||
         std::holds_alternative<std::uint64_t>(value_);
}

bool Json::is_string() const {
  return std::holds_alternative<std::string>(value_);
}

bool Json::is_array() const {
  return std::holds_alternative<List>(value_);
}

bool Json::is_object() const {
  return std::holds_alternative<Members>(value_);
}

bool Json::boolean() const {
  if (const auto* value = std::get_if<bool>(&value_)) return *value;
  wrong_kind("a boolean", *this);
}

double Json::number() const {
  if (const auto* negative = std::get_if<std::int64_t>(&value_)) {
    return static_cast<double>(*negative);
  }
  if (const auto* whole = std::get_if<std::uint64_t>(&value_)) return static_cast<double>(*whole);
  if (const auto* value = std::get_if<double>(&value_)) return *value;
  wrong_kind("a number", *this);
}

std::string inexact_whole_text(double number) {
  return fmt::format(
      "a whole number with a point or an exponent is exact only below 2^53, and this one was read "
      "as {}: write it without point and exponent",
      static_cast<std::uint64_t>(number));
}

std::uint64_t Json::whole_number() const {
  if (const auto* whole = std::get_if<std::uint64_t>(&value_)) return *whole;
  const double value = number();
  if (value >= 0 && value < exact_doubles) return static_cast<std::uint64_t>(value);
  if (value >= exact_doubles && value < 0x1p64) throw JsonError(inexact_whole_text(value));
  throw JsonError(fmt::format("{} is no whole number from 0 to 2^64 - 1", dump()));
}

std::int64_t Json::signed_number() const {
  if (const auto* negative = std::get_if<std::int64_t>(&value_)) return *negative;
  return static_cast<std::int64_t>(whole_number());
}

const std::string& Json::text() const {
  if (const auto* text = std::get_if<std::string>(&value_)) return *text;
  wrong_kind("a string", *this);
}

const std::vector<Json>& Json::elements() const {
  if (const auto* list = std::get_if<List>(&value_)) return *list;
  wrong_kind("a list", *this);
}

const std::vector<Json::Member>& Json::members() const {
  if (const auto* members = std::get_if<Members>(&value_)) return *members;
  wrong_kind("an object", *this);
}

std::size_t Json::size() const {
  if (is_null()) return 0;
  if (is_array()) return elements().size();
  return is_object() ? members().size() : 1;
}

const Json* Json::find(std::string_view key) const {
  const auto* members = std::get_if<Members>(&value_);
  if (members == nullptr) return nullptr;
  const auto found = std::ranges::find(*members, key, &Member::key);
  return found == members->end() ? nullptr : &found->value;
}

const Json& Json::at(std::string_view key) const {
  if (const Json* member = find(key)) return *member;
  if (!is_object()) wrong_kind("an object", *this);
  throw JsonError(fmt::format("the key \"{}\" is missing", key));
}

const Json& Json::at(std::size_t index) const {
  if (index < elements().size()) return elements()[index];
  throw JsonError(fmt::format("a list of {} has no element {}", elements().size(), index));
}

const Json* Json::find_pointer(std::string_view pointer) const {
  const Json* node = this;
  while (node != nullptr && !pointer.empty()) {
    if (pointer.front() != '/') return nullptr;
    const std::string_view token = pointer.substr(1, pointer.find('/', 1) - 1);
    pointer.remove_prefix(1 + token.size());
    const auto key = unescaped(token);
    if (!key) return nullptr;
    if (node->is_array()) {
      const auto index = index_of(*key);
      node = index && *index < node->size() ? &node->elements()[*index] : nullptr;
    } else {
      node = node->find(*key);
    }
  }
  return node;
}

Json* Json::find_pointer(std::string_view pointer) {
  return const_cast<Json*>(std::as_const(*this).find_pointer(pointer));
}

Json& Json::operator[](std::string_view key) {
  if (is_null()) value_ = Members();
  auto* members = std::get_if<Members>(&value_);
  if (members == nullptr) wrong_kind("an object", *this);
  const auto found = std::ranges::find(*members, key, &Member::key);
  if (found != members->end()) return found->value;
  return members->emplace_back(Member{std::string(key), {}}).value;
}

void Json::erase(std::string_view key) {
  if (auto* members = std::get_if<Members>(&value_)) {
    std::erase_if(*members, [&](const Member& member) { return member.key == key; });
  }
}

void Json::update(const Json& object) {
  for (const auto& [key, value] : object.members()) (*this)[key] = value;
}

void Json::push_back(Json element) {
  if (is_null()) value_ = List();
  auto* list = std::get_if<List>(&value_);
  if (list == nullptr) wrong_kind("a list", *this);
  list->push_back(std::move(element));
}

bool Json::operator==(const Json& rhs) const {
  if (is_number() && rhs.is_number() && value_.index() != rhs.value_.index()) {
    return number() == rhs.number();
  }
  return value_ == rhs.value_;
}

}  // namespace jostle::inline config
