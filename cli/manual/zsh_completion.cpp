#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "cli/manual/completion.hpp"

namespace jostle::inline cli {

namespace {

// Within single quotes of zsh; brackets and colons have a sense of their own in what is quoted.
std::string quoted(const std::string& text, const std::string& special) {
  std::string safe;
  for (char c : text) {
    if (c == '\'') {
      safe += "'\\''";
      continue;
    }
    if (special.find(c) != std::string::npos) safe += '\\';
    safe += c;
  }
  return safe;
}

// "scene:_files -g ..." of what stands for a value.
std::string action(const std::string& title, const Offer& offer) {
  std::string does = " ";
  if (!offer.words.empty()) {
    does = fmt::format("({})", fmt::join(offer.words, " "));
  } else if (!offer.suffixes.empty()) {
    does = fmt::format("_files -g \"*.({})\"", fmt::join(offer.suffixes, "|"));
  } else if (offer.files) {
    does = "_files";
  }
  return quoted(title, ":") + ":" + does;
}

// '(-o --output)'{-o,--output}'[The results]:file:_files'
std::string option_spec(const OptionText& option) {
  const std::string described = fmt::format(
      "[{}]{}", quoted(option.description, "[]\\"),
      option.value.empty() ? ""
                           : ":" + action(option.offer.files ? "file" : "value", option.offer));
  if (option.names.size() == 1) {
    return fmt::format("'{}{}{}'", option.repeated ? "*" : "", option.names[0], described);
  }
  return fmt::format("'{}'{{{}}}'{}'",
                     option.repeated ? "*" : fmt::format("({})", fmt::join(option.names, " ")),
                     fmt::join(option.names, ","), described);
}

std::string specs(const std::vector<OptionText>& options) {
  std::string all;
  for (const OptionText& option : options) all += fmt::format("      {} \\\n", option_spec(option));
  return all;
}

std::string command_list(const std::vector<CommandText>& commands) {
  std::string list;
  for (const CommandText& command : commands) {
    list += fmt::format("    '{}:{}'\n", command.name, quoted(command.description, ":"));
  }
  return list;
}

// Arguments of `jostle COMMAND`; a command with kinds offers their names beside its files, and the
// options of all of them.
std::string command_case(const CommandText& command) {
  std::string body = specs(command.options);
  std::vector<std::string> seen;
  for (const CommandText& kind : command.commands) {
    for (const OptionText& option : kind.options) {
      const auto known = [&](const OptionText& candidate) {
        return candidate.names == option.names;
      };
      if (std::ranges::any_of(command.options, known)) continue;
      if (std::ranges::find(seen, option.names.front()) != seen.end()) continue;
      seen.push_back(option.names.front());
      body += fmt::format("      {} \\\n", option_spec(option));
    }
  }
  for (const OptionText& word : command.positionals) {
    std::string does = action(word.names.front(), word.offer);
    if (!command.commands.empty()) {
      std::vector<std::string> kinds;
      for (const CommandText& kind : command.commands) kinds.push_back(kind.name);
      does = fmt::format("{0}:{{_files -g \"*.({1})\"; compadd {2}}}", word.names.front(),
                         fmt::join(word.offer.suffixes, "|"), fmt::join(kinds, " "));
    }
    body += fmt::format("      '{}:{}' \\\n", word.repeated ? "*" : "", does);
  }
  body.erase(body.size() - 3);  // the last backslash
  return fmt::format("    {})\n      _arguments -s \\\n{}\n      ;;\n", command.name, body);
}

constexpr const char* script = R"(#compdef {0}
# zsh completion of {0}, made of its options

_{0}() {{
  local curcontext=$curcontext state line
  local -a commands
  commands=(
{1}  )
  _arguments -C \
{2}      '1:command:->command' \
      '*::argument:->argument'
  case $state in
    command) _describe command commands ;;
    argument)
      case $words[1] in
{3}      esac
      ;;
  esac
}}

_{0} "$@"
)";

}  // namespace

std::string zsh_completion(const CommandText& program) {
  std::string cases;
  for (const CommandText& command : program.commands) cases += command_case(command);
  return fmt::format(script, program.name, command_list(program.commands), specs(program.options),
                     cases);
}

}  // namespace jostle::inline cli
