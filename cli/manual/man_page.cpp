#include "cli/manual/man_page.hpp"

#include <fmt/format.h>

#include <sstream>
#include <vector>

namespace jostle::inline cli {

namespace {

// Escapes text for roff: nothing in it is a request, and every - can be copied as one.
std::string roff(const std::string& text) {
  std::string safe;
  bool line_begins = true;
  for (char c : text) {
    if (line_begins && (c == '.' || c == '\'')) safe += "\\&";
    if (c == '\\') {
      safe += "\\e";
    } else if (c == '-') {
      safe += "\\-";
    } else {
      safe += c;
    }
    line_begins = c == '\n';
  }
  return safe;
}

std::string bold(const std::string& text) {
  return "\\fB" + roff(text) + "\\fR";
}
std::string italic(const std::string& text) {
  return "\\fI" + roff(text) + "\\fR";
}

// ".SH NAME" or ".SS steady".
std::string heading(const char* request, const std::string& text) {
  return fmt::format("{} \"{}\"\n", request, roff(text));
}

std::string title(const std::string& name, const std::string& version) {
  std::string capitals;
  for (char c : name) capitals += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return fmt::format(".TH \"{}\" 1 \"\" \"jostle {}\" \"User Commands\"\n", roff(capitals),
                     version);
}

// "-o, --output FILE" with its description, the words it takes, and its environment variable.
std::string option_entry(const OptionText& option) {
  std::string entry = ".TP\n";
  for (std::size_t i = 0; i < option.names.size(); ++i) {
    entry += (i == 0 ? "" : ", ") + bold(option.names[i]);
  }
  if (!option.value.empty()) {
    entry +=
        " " + italic(option.offer.files ? "FILE" : option.value.substr(0, option.value.find(':')));
  }
  entry += "\n" + roff(option.description);
  if (option.required) entry += ". Required";
  if (!option.environment.empty()) entry += ". Also the variable " + bold(option.environment);
  return entry + ".\n";
}

std::string option_list(const std::vector<OptionText>& options) {
  std::string list;
  for (const OptionText& option : options) list += option_entry(option);
  return list;
}

std::string positional_entry(const OptionText& word) {
  return ".TP\n" + italic(word.names.front()) + "\n" + roff(word.description) + ".\n";
}

std::string synopsis(const std::string& name, const CommandText& command) {
  std::string text = bold(name) + " [" + italic("OPTIONS") + "]";
  for (const OptionText& word : command.positionals) {
    const std::string shown = italic(word.names.front()) + (word.repeated ? "..." : "");
    text += word.required ? " " + shown : " [" + shown + "]";
  }
  if (!command.commands.empty()) text += " " + italic("COMMAND") + " ...";
  return text + "\n";
}

std::vector<std::string> paragraphs(const std::string& text) {
  std::vector<std::string> all(1);
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.empty()) {
      all.emplace_back();
    } else {
      all.back() += line + "\n";
    }
  }
  std::erase(all, "");
  return all;
}

// The end of a help text: examples, exit codes, and remarks.
std::string closing(const std::string& footer) {
  std::string examples, status, notes;
  for (const std::string& paragraph : paragraphs(footer)) {
    if (paragraph.starts_with("Example")) {
      const std::string lines = paragraph.substr(paragraph.find('\n') + 1);
      examples += ".nf\n" + roff(lines) + ".fi\n";
    } else if (paragraph.starts_with("Exit code")) {
      status += ".PP\n" + roff(paragraph);
    } else {
      notes += ".PP\n" + roff(paragraph);
    }
  }
  std::string text;
  if (!notes.empty()) text += heading(".SH", "NOTES") + notes;
  if (!status.empty()) text += heading(".SH", "EXIT STATUS") + status;
  if (!examples.empty()) text += heading(".SH", "EXAMPLES") + examples;
  return text;
}

std::string page_of(const CommandText& program, const CommandText& command) {
  return program.name + "-" + command.name;
}

std::string beginning(const std::string& page, const std::string& name, const CommandText& command,
                      const std::string& version) {
  return title(page, version) + heading(".SH", "NAME") + roff(page) + " \\- " +
         roff(command.description) + "\n" + heading(".SH", "SYNOPSIS") + synopsis(name, command);
}

}  // namespace

std::string program_page(const CommandText& program, const std::string& version) {
  std::string page = beginning(program.name, program.name, program, version);
  page += heading(".SH", "COMMANDS");
  for (const CommandText& command : program.commands) {
    page += ".TP\n" + bold(command.name) + "\n" + roff(command.description) + ": see " +
            bold(page_of(program, command)) + "(1).\n";
  }
  page += heading(".SH", "OPTIONS") + option_list(program.options) + closing(program.footer);
  page += heading(".SH", "SEE ALSO");
  for (std::size_t i = 0; i < program.commands.size(); ++i) {
    page += (i == 0 ? "" : ",\n") + bold(page_of(program, program.commands[i])) + "(1)";
  }
  return page + "\n";
}

std::string command_page(const CommandText& program, const CommandText& command,
                         const std::string& version) {
  std::string page =
      beginning(page_of(program, command), program.name + " " + command.name, command, version);
  page += heading(".SH", "OPTIONS");
  for (const OptionText& word : command.positionals) page += positional_entry(word);
  page += option_list(command.options);
  for (const CommandText& kind : command.commands) {
    page += heading(".SS", command.name + " " + kind.name) + roff(kind.description) + ".\n" +
            option_list(kind.options);
  }
  return page + closing(command.footer) + heading(".SH", "SEE ALSO") + bold(program.name) + "(1)\n";
}

}  // namespace jostle::inline cli
