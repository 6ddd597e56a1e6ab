#include "cli/options/command_text.hpp"

#include <CLI/CLI.hpp>
#include <optional>
#include <sstream>

namespace jostle::inline cli {

namespace {

// The last of the checks with an offer of this kind.
std::optional<std::vector<std::string>> offered(CLI::Option& option, const std::string& kind) {
  std::optional<std::vector<std::string>> found;
  try {
    for (int number = 0;; ++number) {
      std::istringstream name(option.get_validator(number)->get_name());
      std::string word;
      if (!(name >> word) || word != kind) continue;
      found.emplace();
      while (name >> word) found->push_back(word);
    }
  } catch (const CLI::OptionNotFound&) {
    return found;
  }
}

OptionText text_of(CLI::Option& option) {
  OptionText text;
  for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
  if (text.names.empty()) text.names.push_back(option.get_name(true));
  const bool flag = option.get_type_size() == 0;
  if (!flag) text.value = option.get_type_name();
  text.description = option.get_description();
  text.environment = option.get_envname();
  text.required = option.get_required();
  text.repeated = !flag && option.get_items_expected_max() > 1;
  if (const auto words = offered(option, words_offered)) text.offer.words = *words;
  if (const auto suffixes = offered(option, files_offered)) {
    text.offer.files = true;
    text.offer.suffixes = *suffixes;
  }
  return text;
}

}  // namespace

CommandText text_of(CLI::App& app) {
  CommandText text{app.get_name(), app.get_description(), app.get_footer(), {}, {}, {}};
  for (CLI::Option* option : app.get_options()) {
    if (option->get_group() == hidden_group) continue;
    (option->nonpositional() ? text.options : text.positionals).push_back(text_of(*option));
  }
  for (CLI::App* command : app.get_subcommands({})) text.commands.push_back(text_of(*command));
  return text;
}

}  // namespace jostle::inline cli
