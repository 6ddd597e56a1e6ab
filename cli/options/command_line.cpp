#include "cli/options/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "cli/options/command_words.hpp"
#include "config/json/json_text.hpp"
#include "config/json/suggestion.hpp"
#include "study/bad_input.hpp"

namespace jostle::inline cli {

namespace {

/// Has every option that holds unsigned numbers, of all commands, refuse negative ones.
void refuse_negative_counts(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_type_name().starts_with("UINT")) Option(*option).whole_from(0);
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

/// "jostle analyse steady", as far as the command line was understood; and its options.
struct Understood {
  std::string command;
  std::vector<std::string> options;
};
Understood understood(const CLI::App& app) {
  Understood all{app.get_name(), {}};
  const CLI::App* level = &app;
  while (!level->get_subcommands().empty()) {
    level = level->get_subcommands().front();
    all.command += " " + level->get_name();
    for (const CLI::Option* option : level->get_options()) {
      for (const std::string& name : option->get_lnames()) all.options.push_back("--" + name);
    }
  }
  return all;
}

/// For a command line that could not be read: a word that should be a command, or an option that
/// its command does not have, with those there are or the nearest of them. Empty for others.
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

/// The command line as the parser takes it, the last word first and without the program: an option
/// has one value, "--" is written out where files come before a subcommand, and a file's name is no
/// list.
SeparateValues words_for_parser(CLI::App& app, int argc, char** argv) {
  SeparateValues line{{argv + 1, argv + argc}, ""};
  std::vector<std::string> kinds;
  for (CLI::App* command : app.get_subcommands({})) {
    if (line.words.empty() || command->get_name() != line.words.front()) continue;
    const CommandText text = text_of(*command);
    for (const CommandText& kind : text.commands) kinds.push_back(kind.name);
    line = with_separate_values(line.words, text);
  }
  line.words = without_operand_mark(std::move(line.words), kinds);
  std::error_code ignored;
  for (std::string& word : line.words)
    if (word.starts_with('[') && std::filesystem::exists(word, ignored)) word = operand(word);
  std::ranges::reverse(line.words);
  return line;
}

/// For a command line without a file, in which a list may have taken it; empty for others.
std::string file_in_list(const CLI::ParseError& error, const std::string& long_list) {
  const bool is_of_file = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr &&
                          !std::string(error.what()).starts_with('-');
  if (!is_of_file || long_list.empty()) return {};
  return fmt::format(
      "no file is given, unless it is in {}: put the file first, or separate the values by commas",
      long_list);
}

/// The help without hidden options.
class HelpText : public CLI::Formatter {
 public:
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override {
    if (group == hidden_group) return "";
    return CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
  }
};

}  // namespace

CommandLine::CommandLine(const std::string& name, const std::string& description)
    : app_(std::make_unique<CLI::App>(description, name)) {
  app_->formatter(std::make_shared<HelpText>());
}
CommandLine::~CommandLine() = default;

Command CommandLine::program() {
  return Command(*app_);
}

CommandText CommandLine::text() const {
  return text_of(*app_);
}

void CommandLine::set_version(const std::string& text) {
  app_->set_version_flag("--version", text);
}

CommandLine::Outcome CommandLine::parse_and_run(int argc, char** argv) {
  refuse_negative_counts(*app_);
  SeparateValues line = words_for_parser(*app_, argc, argv);
  try {
    app_->parse(line.words);
    return {};
  } catch (const CLI::ParseError& error) {
    const std::string unknown = error.get_exit_code() == 0 ? "" : unknown_word(*app_);
    if (!unknown.empty()) throw BadInput(unknown);
    const std::string taken = file_in_list(error, line.long_list);
    if (!taken.empty()) throw BadInput(taken);
    std::ostringstream asked_for, fault;
    const bool refused = app_->exit(error, asked_for, fault) != 0;
    return {.asked_for = asked_for.str(), .fault = fault.str(), .refused = refused};
  }
}

}  // namespace jostle::inline cli
