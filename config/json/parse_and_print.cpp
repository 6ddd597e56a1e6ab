#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "config/json/json_text.hpp"

namespace jostle::inline config {

namespace {

using LibraryJson = nlohmann::ordered_json;

// More than any object of a scene has. A tree of values takes the square of it in time.
constexpr std::size_t most_keys = 1000;

/// Line and column, both from 1, of a byte of the text.
std::string place(std::string_view text, std::size_t byte) {
  const std::string_view preceding = text.substr(0, std::min(byte, text.size()));
  const auto line = 1 + std::count(preceding.begin(), preceding.end(), '\n');
  const std::size_t newline = preceding.rfind('\n');
  const std::size_t column =
      newline == std::string_view::npos ? preceding.size() : preceding.size() - newline - 1;
  return fmt::format("line {}, column {}", line, std::max<std::size_t>(column, 1));
}

/// nlohmann's message without its number and without its own idea of the place.
std::string reason(std::string_view message) {
  if (const auto bracket = message.find("] "); bracket != message.npos)
    message.remove_prefix(bracket + 2);
  if (message.starts_with("parse error at line")) {
    if (const auto colon = message.find(": "); colon != message.npos)
      message.remove_prefix(colon + 2);
  }
  return std::string(message);
}

/// Describes syntax of other dialects at the byte where reading ended; otherwise empty.
std::string_view foreign_dialect(std::string_view text, std::size_t end) {
  if (end == 0 || end > text.size()) return {};
  const char last = text[end - 1];
  if (last == '/' || last == '#') return "a comment: JSON has neither comments nor trailing commas";
  if (last != ']' && last != '}') return {};
  const std::size_t place = text.substr(0, end - 1).find_last_not_of(" \t\r\n");
  if (place == text.npos || text[place] != ',') return {};
  return "a comma before the end of a list or an object: JSON has neither comments nor trailing "
         "commas";
}

/// Makes the value of a text, and notes what the value can no longer show.
class ValueBuilder : public nlohmann::json_sax<LibraryJson> {
 public:
  ValueBuilder(std::string_view text, std::vector<Fault>& faults) : text_(text), faults_(faults) {}

  Json& value() { return value_; }

  bool null() override { return add({}); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& text) override { return add(std::move(text)); }
  bool binary(binary_t&) override { return false; }  // never in text

  bool start_object(std::size_t) override { return enter(Json::object()); }
  bool start_array(std::size_t) override { return enter(Json::array()); }
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
    const std::string explanation = dialect.empty() ? reason(error.what()) : std::string(dialect);
    faults_.push_back({"", fmt::format("not JSON: {}: {}", place(text_, position), explanation)});
    return false;
  }

 private:
  /// A list or an object whose end is not read yet.
  struct Level {
    Json value;
    std::set<std::string> keys;
    std::string token;  // the last key, in an object
  };

  bool add(Json value) {
    if (levels_.empty()) {
      value_ = std::move(value);
    } else if (Level& level = levels_.back(); level.value.is_array()) {
      level.value.push_back(std::move(value));
    } else {
      level.value[level.token] = std::move(value);
    }
    return true;
  }
  bool enter(Json structure) {
    levels_.push_back({std::move(structure), {}, {}});
    if (levels_.size() <= deepest_nesting) return true;
    faults_.push_back({"", fmt::format("nested deeper than {} levels", deepest_nesting)});
    return false;
  }
  bool leave() {
    Json structure = std::move(levels_.back().value);
    levels_.pop_back();
    return add(std::move(structure));
  }
  std::string pointer() const {
    std::string path;
    for (const Level& level : levels_) {
      path = level.value.is_array() ? pointer_to(path, level.value.size())
                                    : pointer_to(path, level.token);
    }
    return path;
  }

  std::string_view text_;
  std::vector<Fault>& faults_;
  std::vector<Level> levels_;
  Json value_;
};

LibraryJson library_value(const Json& value) {
  if (value.is_null()) return nullptr;
  if (value.is_boolean()) return value.boolean();
  if (value.is_string()) return value.text();
  if (value.is_number_integer()) {
    if (value.number() < 0) return value.signed_number();
    return value.whole_number();
  }
  if (value.is_number()) return value.number();
  LibraryJson json = value.is_array() ? LibraryJson::array() : LibraryJson::object();
  if (value.is_array()) {
    for (const Json& element : value.elements()) json.push_back(library_value(element));
  } else {
    for (const auto& [key, member] : value.members()) json[key] = library_value(member);
  }
  return json;
}

}  // namespace

std::optional<Json> read_json(std::string_view text, std::vector<Fault>& faults) {
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {  // read as the end
    faults.push_back({"", fmt::format("byte {} is NUL: JSON is text without it", nul + 1)});
    return std::nullopt;
  }
  ValueBuilder builder(text, faults);
  if (!LibraryJson::sax_parse(text, &builder)) return std::nullopt;
  return std::move(builder.value());
}

Json Json::parse(std::string_view text) {
  std::vector<Fault> faults;
  auto value = read_json(text, faults);
  if (!value) throw JsonError(faults.front().message);
  return std::move(*value);
}

std::string Json::dump(int indent) const {
  return library_value(*this).dump(indent, ' ', false, LibraryJson::error_handler_t::replace);
}

std::string json_library_version() {
  return fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                     NLOHMANN_JSON_VERSION_PATCH);
}

}  // namespace jostle::inline config
