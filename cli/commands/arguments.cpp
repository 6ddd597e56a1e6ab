#include "cli/commands/arguments.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

#include "config/json/json_text.hpp"
#include "config/json/suggestion.hpp"
#include "study/bad_input.hpp"

namespace jostle {

CLI::Validator whole_from(std::uint64_t least) {
  return CLI::Validator(
      [least](const std::string& text) -> std::string {
        std::uint64_t value = 0;
        const char* const end = text.data() + text.size();
        const auto read = std::from_chars(text.data(), end, value);
        if (read.ec == std::errc() && read.ptr == end && value >= least) return {};
        return fmt::format("{} is not a whole number from {} on", text, least);
      },
      "");
}

CLI::Validator positive_number() {
  return CLI::Validator(
      [](const std::string& text) -> std::string {
        double value = 0;
        const char* const end = text.data() + text.size();
        const auto read = std::from_chars(text.data(), end, value);
        if (read.ec == std::errc() && read.ptr == end && std::isfinite(value) && value > 0) {
          return {};
        }
        return fmt::format("{} is not a number above 0", text);
      },
      "");
}

CLI::Validator file_to_write() {
  return CLI::Validator(
      [](const std::string& text) -> std::string {
        if (!text.empty() && text != "-") return {};
        return fmt::format("\"{}\" is no file's name", text);
      },
      "");
}

namespace {

double read_end(const std::string& text, double otherwise, const std::string& option,
                const std::string& range) {
  if (text.empty()) return otherwise;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || std::isnan(value)) {
    throw BadInput(
        fmt::format("{} {}: not FIRST:LAST, two numbers of which one may be left "
                    "out",
                    option, range));
  }
  return value;
}

}  // namespace

FitRange read_range(const std::string& option, const std::string& text) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const auto colon = text.find(':');
  const std::string first = text.substr(0, colon);
  const std::string last = colon == std::string::npos ? "?" : text.substr(colon + 1);
  const FitRange range{read_end(first, -infinite, option, text),
                       read_end(last, infinite, option, text)};
  if (range.first <= range.last) return range;
  throw BadInput(fmt::format("{} {}: FIRST:LAST, and no number is so", option, text));
}

void refuse_negative_counts(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_type_name().starts_with("UINT")) option->check(whole_from(0));
  }
  for (CLI::App* command : app.get_subcommands({})) refuse_negative_counts(*command);
}

namespace {

std::string unknown_command(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining();
  if (!app.get_subcommands().empty() || words.empty() || words.front().starts_with('-')) return {};
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return fmt::format("{}: there is no such command; there are {}.{}", words.front(),
                     joined(names, ", "), did_you_mean(words.front(), names));
}

/// "jostle analyse steady", as far as the command line was understood; and its options.
struct Understood {
  std::string command;
  std::vector<std::string> options;
};
Understood understood(const CLI::App& app) {
  Understood all{app.get_name(), {}};
  const CLI::App* here = &app;
  while (!here->get_subcommands().empty()) {
    here = here->get_subcommands().front();
    all.command += " " + here->get_name();
    for (const CLI::Option* option : here->get_options()) {
      for (const std::string& name : option->get_lnames()) all.options.push_back("--" + name);
    }
  }
  return all;
}

}  // namespace

std::string unknown_word(const CLI::App& app) {
  const std::string command = unknown_command(app);
  if (!command.empty()) return command;
  for (const std::string& word : app.remaining(true)) {
    if (!word.starts_with("--") || word.size() < 3) continue;
    const std::string option = word.substr(0, word.find('='));
    const Understood known = understood(app);
    return fmt::format("{}: {} has no such option; its --help lists them.{}", option, known.command,
                       did_you_mean(option, known.options));
  }
  return {};
}

}  // namespace jostle
