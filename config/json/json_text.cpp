#include "config/json/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

namespace jostle {

namespace {

// More than any object of a scene has. A tree of values takes the square of it in time.
constexpr std::size_t most_keys = 1000;

/// Line and column, both from 1, of a byte of the text.
std::string place(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t newline = before.rfind('\n');
  const std::size_t column =
      newline == std::string_view::npos ? before.size() : before.size() - newline - 1;
  return fmt::format("line {}, column {}", line, std::max<std::size_t>(column, 1));
}

/// nlohmann's message without its number and without its own idea of the place.
std::string reason(std::string_view what) {
  if (const auto bracket = what.find("] "); bracket != what.npos) what.remove_prefix(bracket + 2);
  if (what.starts_with("parse error at line")) {
    if (const auto colon = what.find(": "); colon != what.npos) what.remove_prefix(colon + 2);
  }
  return std::string(what);
}

/// What other dialects allow and JSON does not, at the byte where reading ended; else empty.
std::string_view foreign_dialect(std::string_view text, std::size_t end) {
  if (end == 0 || end > text.size()) return {};
  const char last = text[end - 1];
  if (last == '/' || last == '#') return "a comment: JSON has neither comments nor trailing commas";
  if (last != ']' && last != '}') return {};
  const std::size_t before = text.substr(0, end - 1).find_last_not_of(" \t\r\n");
  if (before == text.npos || text[before] != ',') return {};
  return "a comma before the end of a list or an object: JSON has neither comments nor trailing "
         "commas";
}

/// Walks through the text and notes what a tree of values can no longer show.
class TextChecker : public nlohmann::json_sax<Json> {
 public:
  TextChecker(std::string_view text, std::vector<Fault>& faults) : text_(text), faults_(faults) {}

  bool null() override { return next_value(); }
  bool boolean(bool) override { return next_value(); }
  bool number_integer(number_integer_t) override { return next_value(); }
  bool number_unsigned(number_unsigned_t) override { return next_value(); }
  bool number_float(number_float_t, const string_t&) override { return next_value(); }
  bool string(string_t&) override { return next_value(); }
  bool binary(binary_t&) override { return next_value(); }

  bool start_object(std::size_t) override { return enter(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_object() override { return leave(); }
  bool end_array() override { return leave(); }

  bool key(string_t& key) override {
    Level& level = levels_.back();
    level.token = key;
    if (!level.keys.insert(key).second) {
      faults_.push_back({pointer(), "this key is written twice in one object: keep one of them"});
    }
    if (level.keys.size() <= most_keys) return true;
    faults_.push_back({"", fmt::format("more than {} keys in one object", most_keys)});
    return false;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    const std::string_view dialect = foreign_dialect(text_, position);
    const std::string why = dialect.empty() ? reason(error.what()) : std::string(dialect);
    faults_.push_back({"", fmt::format("not JSON: {}: {}", place(text_, position), why)});
    return false;
  }

 private:
  struct Level {
    std::set<std::string> keys;
    std::string token;      // the last key, in an object
    std::size_t index = 0;  // of the next element, in a list
  };

  bool next_value() {
    if (!levels_.empty()) ++levels_.back().index;
    return true;
  }
  bool enter() {
    levels_.emplace_back();
    if (levels_.size() <= deepest_nesting) return true;
    faults_.push_back({"", fmt::format("nested deeper than {} levels", deepest_nesting)});
    return false;
  }
  bool leave() {
    levels_.pop_back();
    return next_value();
  }
  std::string pointer() const {
    std::string path;
    for (const Level& level : levels_) {
      path = level.keys.empty() ? pointer_to(path, level.index) : pointer_to(path, level.token);
    }
    return path;
  }

  std::string_view text_;
  std::vector<Fault>& faults_;
  std::vector<Level> levels_;
};

std::string number_text(const Json& number) {
  if (number.is_number_integer()) return number.dump();
  const auto value = number.get<double>();
  if (value == std::trunc(value) && std::abs(value) < 0x1p53) {
    return std::to_string(static_cast<std::int64_t>(value));
  }
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

}  // namespace

std::optional<Json> read_json(std::string_view text, std::vector<Fault>& faults) {
  TextChecker checker(text, faults);
  if (!Json::sax_parse(text, &checker)) return std::nullopt;
  return Json::parse(text);
}

std::string pointer_to(std::string_view pointer, std::string_view key) {
  std::string escaped;
  for (const char c : key) {
    if (c == '~') {
      escaped += "~0";
    } else if (c == '/') {
      escaped += "~1";
    } else {
      escaped += c;
    }
  }
  return fmt::format("{}/{}", pointer, escaped);
}

std::string pointer_to(std::string_view pointer, std::size_t index) {
  return fmt::format("{}/{}", pointer, index);
}

std::string joined(const std::vector<std::string>& parts, std::string_view separator) {
  std::string text;
  for (const std::string& part : parts) {
    if (&part != &parts.front()) text += separator;
    text += part;
  }
  return text;
}

bool is_within(std::string_view pointer, std::string_view ancestor) {
  return pointer.starts_with(ancestor) &&
         (pointer.size() == ancestor.size() || pointer[ancestor.size()] == '/');
}

std::string canonical_text(const Json& value) {
  if (value.is_number()) return number_text(value);
  if (!value.is_structured()) return value.dump();
  std::vector<std::string> parts;
  if (value.is_array()) {
    for (const Json& element : value) parts.push_back(canonical_text(element));
    return fmt::format("[{}]", joined(parts, ","));
  }
  for (const auto& [key, member] : value.items()) {
    parts.push_back(fmt::format("{}:{}", Json(key).dump(), canonical_text(member)));
  }
  std::sort(parts.begin(), parts.end());
  return fmt::format("{{{}}}", joined(parts, ","));
}

}  // namespace jostle
