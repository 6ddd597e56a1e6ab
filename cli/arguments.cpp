#include "cli/arguments.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <vector>

#include "config/json_text.hpp"
#include "config/suggestion.hpp"

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

void refuse_negative_counts(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_type_name().starts_with("UINT")) option->check(whole_from(0));
  }
  for (CLI::App* command : app.get_subcommands({})) refuse_negative_counts(*command);
}

std::string unknown_command(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining();
  if (!app.get_subcommands().empty() || words.empty() || words.front().starts_with('-')) return {};
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return fmt::format("{}: there is no such command; there are {}.{}", words.front(),
                     joined(names, ", "), did_you_mean(words.front(), names));
}

}  // namespace jostle
