#include "cli/options/values.hpp"

#include <fmt/format.h>

#include <limits>

#include "engine/numbers.hpp"
#include "study/bad_input.hpp"
#include "study/number_text.hpp"

namespace jostle::inline cli {

namespace {

double read_end(const std::string& text, double otherwise, const std::string& option,
                const std::string& range) {
  if (text.empty()) return otherwise;
  if (const auto number = read_number(text)) return *number;
  throw BadInput(fmt::format("{} {}: not FIRST:LAST, two numbers of which one may be left out",
                             option, range));
}

}  // namespace

FitRange read_range(const std::string& option, const std::string& text, const std::string& prefix) {
  const auto colon = text.find(':');
  const std::string first = text.substr(0, colon);
  const std::string last = colon == std::string::npos ? "?" : text.substr(colon + 1);
  const FitRange range{read_end(first, -infinite, option, prefix + text),
                       read_end(last, infinite, option, prefix + text)};
  if (range.first <= range.last) return range;
  throw BadInput(
      fmt::format("{} {}{}: {} is larger than {}, and the first number of a range may not "
                  "exceed the last; write {}{}:{}",
                  option, prefix, text, first, last, prefix, last, first));
}

std::vector<NamedNumber> named_numbers(const std::string& option,
                                       const std::vector<std::string>& texts) {
  std::vector<NamedNumber> all;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
    const auto number = read_number(value);
    if (!number) throw BadInput(fmt::format("{} {}: not NAME=NUMBER", option, text));
    all.emplace_back(text.substr(0, equals), *number);
  }
  return all;
}

KeptTaps kept_taps(const std::string& option, const std::vector<std::string>& words) {
  KeptTaps choice;
  for (const std::string& word : words) {
    const auto tap = read_whole_number(word);
    if (word == "all") {
      choice.all = true;
    } else if (tap) {
      choice.taps.push_back(*tap);
    } else {
      throw BadInput(fmt::format(
          "{0} {1}: neither a whole number from 0 on nor \"all\"; several: {0} 0,10,100", option,
          word));
    }
  }
  if (choice.all && !choice.taps.empty())
    throw BadInput(
        fmt::format("{}: \"all\" and numbers exclude each other: give one of them", option));
  return choice;
}

}  // namespace jostle::inline cli
