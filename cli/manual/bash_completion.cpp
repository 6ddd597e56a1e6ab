#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "cli/manual/completion.hpp"

namespace jostle::inline cli {

namespace {

constexpr const char* script_beginning = R"BASH(# bash completion of {0}, made of its options

# Files with one of the suffixes that follow the word, any file without; and folders.
_{0}_files() {{
  local word=$1 suffix
  shift
  {{
    compgen -d -- "$word"
    [ $# -gt 0 ] || compgen -f -- "$word"
    for suffix; do compgen -f -X "!*.$suffix" -- "$word"; done
  }} | sort -u
}}

# _{0}_value OPTION WORD: what the option's value may be; fails where OPTION takes none.
)BASH";

constexpr const char* end = R"BASH(
_{0}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command= kind= one
  local IFS=$'\n' offered
  COMPREPLY=()
  for one in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    if [ -z "$command" ]; then
      case $one in {1}) command=$one ;; esac
    else
      case "$command $one" in {2}) kind=$one ;; esac
    fi
  done
  if ! offered=$(_{0}_value "$command $before" "$word"); then
    case $word in
      -*) offered=$(compgen -W "$(_{0}_options "$command $kind")" -- "$word") || : ;;
      *) offered=$(_{0}_words "$command" "$word") ;;
    esac
  fi
  # A line each: no name is a pattern of names.
  [ -z "$offered" ] || mapfile -t COMPREPLY <<<"$offered"
}}
complete -o filenames -F _{0} {0}
)BASH";

// Prints an offer for the word $2; nothing where any value is valid.
std::string offer_command(const std::string& program, const Offer& offer) {
  if (!offer.words.empty()) {
    return fmt::format("compgen -W $'{}' -- \"$2\"", fmt::join(offer.words, "\\n"));
  }
  if (!offer.files) return ":";
  return fmt::format("_{}_files \"$2\" {}", program, fmt::join(offer.suffixes, " "));
}

// `compgen` of bash fails where nothing fits: an offer that is empty is an offer all the same.
std::string offer_or_nothing(const std::string& command) {
  return command == ":" ? command : command + " || :";
}

// Options of all of them, each once, with those of a command's kinds.
std::vector<OptionText> all_options(const CommandText& command) {
  std::vector<OptionText> all = command.options;
  for (const CommandText& kind : command.commands) {
    all.insert(all.end(), kind.options.begin(), kind.options.end());
  }
  return all;
}

std::string value_cases(const std::string& program, const CommandText& command) {
  std::string cases, seen = " ";
  for (const OptionText& option : all_options(command)) {
    if (option.value.empty()) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : option.names) {
      if (seen.find(" " + name + " ") != std::string::npos) continue;
      seen += name + " ";
      patterns.push_back(fmt::format("'{} {}'", command.name, name));
    }
    if (patterns.empty()) continue;
    cases += fmt::format("    {}) {} ;;\n", fmt::join(patterns, " | "),
                         offer_or_nothing(offer_command(program, option.offer)));
  }
  return cases;
}

std::string option_names(const std::vector<OptionText>& options) {
  std::vector<std::string> names;
  for (const OptionText& option : options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return fmt::format("{}", fmt::join(names, "\\n"));
}

// A function whose cases are made by the callers: `_jostle_words() { case $1 in ... esac }`.
std::string function(const std::string& name, const std::string& cases, const char* otherwise) {
  return fmt::format("{}() {{\n  case $1 in\n{}    *) {} ;;\n  esac\n}}\n", name, cases, otherwise);
}

std::vector<std::string> names_of(const std::vector<CommandText>& commands) {
  std::vector<std::string> names;
  for (const CommandText& command : commands) names.push_back(command.name);
  return names;
}

std::string word_case(const std::string& program, const CommandText& command) {
  std::vector<std::string> offers;
  for (const OptionText& word : command.positionals) {
    offers.push_back(offer_or_nothing(offer_command(program, word.offer)));
  }
  if (!command.commands.empty()) {
    offers.push_back(
        offer_or_nothing(offer_command(program, {.words = names_of(command.commands)})));
  }
  if (offers.empty()) offers.emplace_back(":");
  return fmt::format("    {}) {} ;;\n", command.name, fmt::join(offers, "; "));
}

}  // namespace

std::string bash_completion(const CommandText& program) {
  std::string values, options, words, kinds;
  for (const CommandText& command : program.commands) {
    values += value_cases(program.name, command);
    // Options of a kind are known once it has been named.
    for (const CommandText& kind : command.commands) {
      std::vector<OptionText> all_options = command.options;
      all_options.insert(all_options.end(), kind.options.begin(), kind.options.end());
      options += fmt::format("    '{} {}') printf -- '{}\\n' ;;\n", command.name, kind.name,
                             option_names(all_options));
      kinds += fmt::format("{}'{} {}'", kinds.empty() ? "" : " | ", command.name, kind.name);
    }
    options += fmt::format("    '{} ') printf -- '{}\\n' ;;\n", command.name,
                           option_names(command.options));
    words += word_case(program.name, command);
  }
  words += fmt::format(
      "    '') {} ;;\n",
      offer_or_nothing(offer_command(program.name, {.words = names_of(program.commands)})));
  const std::string name = "_" + program.name;
  return fmt::format(script_beginning, program.name) +
         function(name + "_value", values, "return 1") + "\n# The options of \"COMMAND KIND\".\n" +
         function(name + "_options", options,
                  fmt::format("printf -- '{}\\n'", option_names(program.options)).c_str()) +
         "\n# _" + program.name + "_words COMMAND WORD: words allowed without a name.\n" +
         function(name + "_words", words, ":") +
         fmt::format(end, program.name, fmt::join(names_of(program.commands), " | "), kinds);
}

}  // namespace jostle::inline cli
