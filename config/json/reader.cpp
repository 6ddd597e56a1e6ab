#include "config/json/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/json/suggestion.hpp"

namespace jostle::inline config {

namespace {

// The settings of a choice when only its name is written.
const Json no_settings = Json::object();

constexpr std::size_t longest_quote = 60;

}  // namespace

std::string described(const Json& value) {
  if (value.is_object()) return value.empty() ? "an empty object" : "an object";
  if (value.is_array()) return value.empty() ? "an empty list" : "a list";
  if (value.is_null()) return "null";
  if (value.is_boolean()) return value.boolean() ? "true" : "false";
  std::string text = value.dump();
  if (value.is_number()) return "the number " + text;
  return text.size() > longest_quote ? "a long string" : "the string " + text;
}

std::string listed(const std::vector<std::string>& names) {
  return joined(names, ", ");
}

bool sound(const std::vector<Fault>& faults, std::string_view pointer) {
  return std::none_of(faults.begin(), faults.end(),
                      [&](const Fault& fault) { return is_within(fault.pointer, pointer); });
}

std::optional<Reader> Reader::member(std::string_view key, std::string_view content) const {
  std::optional<Reader> found = find(std::string(key));
  if (!found && !content.empty()) missing(key, content);
  return found;
}

void Reader::missing(std::string_view key, std::string_view content) const {
  faults_->push_back({pointer_to(pointer_, key), fmt::format("this key is required: {}", content)});
}

bool Reader::sound() const {
  return jostle::sound(*faults_, pointer_);
}

void Reader::wrong_type(std::string_view expected) const {
  fault(fmt::format("expected {}, found {}", expected, described(value())));
}

bool Reader::is_object_of(const std::vector<std::string>& keys) const {
  if (!value().is_object()) {
    wrong_type(fmt::format("an object with the keys {}", listed(keys)));
    return false;
  }
  for (const auto& [key, member] : value().members()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    faults_->push_back(
        {pointer_to(pointer_, key), keys.empty() ? "unknown key: there is nothing to set here"
                                                 : fmt::format("unknown key (allowed: {}).{}",
                                                               listed(keys), key_hint(key, keys))});
  }
  return true;
}

bool Reader::is_list(std::size_t least, std::size_t most, std::string_view of_what) const {
  if (value().is_array() && value().size() >= least && value().size() <= most) return true;
  const std::string found =
      value().is_array() ? fmt::format("{} of them", value().size()) : described(value());
  const std::string length = least == most               ? fmt::format("{}", least)
                             : most == std::string::npos ? fmt::format("{} or more", least)
                                                         : fmt::format("{} to {}", least, most);
  fault(fmt::format("expected a list of {} {}, found {}", length, of_what, found));
  return false;
}

Reader Reader::element(std::size_t index) const {
  return {value().at(index), pointer_to(pointer_, index), *faults_};
}

std::optional<Reader> Reader::find(const std::string& key) const {
  const Json* member = value().find(key);
  if (member == nullptr) return std::nullopt;
  return Reader{*member, pointer_to(pointer_, key), *faults_};
}

std::optional<std::uint64_t> Reader::whole_number(std::uint64_t least, std::uint64_t most) const {
  const std::string expected = fmt::format("a whole number from {} to {}", least, most);
  if (!value().is_number()) {
    wrong_type(expected);
    return std::nullopt;
  }
  const auto number = value().number();
  if (number != std::trunc(number)) {
    fault(fmt::format("{} is not whole: expected {}", value().dump(), expected));
    return std::nullopt;
  }
  const bool is_exact = value().is_number_integer() || number < exact_doubles;
  // 2^64 is the first double that no longer fits.
  if (!is_exact && number < 0x1p64 && number <= static_cast<double>(most)) {
    fault(inexact_whole_text(number));
    return std::nullopt;
  }
  const bool fits = number >= 0 && is_exact;
  const std::uint64_t whole = fits ? value().whole_number() : 0;
  if (fits && whole >= least && whole <= most) return whole;
  fault(fmt::format("{} is out of range: expected {}", canonical_text(value()), expected));
  return std::nullopt;
}

std::optional<bool> Reader::boolean() const {
  if (value().is_boolean()) return value().boolean();
  wrong_type("true or false");
  return std::nullopt;
}

std::optional<std::string> Reader::text() const {
  if (value().is_string()) return value().text();
  wrong_type("a string");
  return std::nullopt;
}

std::optional<std::string> Reader::one_of(const std::vector<std::string>& names) const {
  if (!value().is_string()) {
    wrong_type(fmt::format("one of the strings {}", listed(names)));
    return std::nullopt;
  }
  auto written = value().text();
  if (std::find(names.begin(), names.end(), written) != names.end()) return written;
  fault(fmt::format("{} is unknown (allowed: {}).{}", described(value()), listed(names),
                    did_you_mean(written, names)));
  return std::nullopt;
}

std::optional<Choice> Reader::choice(const std::vector<std::string>& names) const {
  if (!is_object_of(names)) return std::nullopt;
  std::optional<Choice> chosen;
  std::size_t known = 0;
  for (const std::string& name : names) {
    const auto settings = find(name);
    if (!settings) continue;
    ++known;
    chosen = Choice{name, *settings};
  }
  if (known > 1) fault(fmt::format("expected only one of the keys {}", listed(names)));
  if (value().empty()) fault(fmt::format("expected one of the keys {}", listed(names)));
  return known == 1 ? chosen : std::nullopt;
}

std::optional<Choice> Reader::named_choice(const std::vector<std::string>& names) const {
  if (value().is_object()) return choice(names);
  const auto name = one_of(names);
  if (!name) return std::nullopt;
  return Choice{*name, Reader{no_settings, pointer_, *faults_}};
}

}  // namespace jostle::inline config
