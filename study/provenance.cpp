#include "study/provenance.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>

#include "engine/monte_carlo/trial_loop.hpp"
#include "results/export/printable.hpp"
#include "study/version.hpp"

namespace jostle::inline study {
namespace {

bool needs_no_quotes(unsigned char c) {
  return std::isalnum(c) != 0 ||
         std::string_view("_-./=,:+@%").find(static_cast<char>(c)) != std::string_view::npos;
}

/// In bash's quotes $'...', in which every byte that a terminal does not show has an escape.
std::string escaped_shell_word(const std::string& argument) {
  std::string word = "$'";
  for (const char c : argument) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < ' ' || byte >= 0x7f) {
      constexpr std::string_view digits = "0123456789abcdef";
      word.append("\\x").append({digits[byte / 16], digits[byte % 16]});
    } else {
      if (c == '\'' || c == '\\') word += '\\';
      word += c;
    }
  }
  return word + "'";
}

std::string shell_word(const std::string& argument) {
  if (!argument.empty() && std::ranges::all_of(argument, needs_no_quotes)) return argument;
  if (printable_name(argument) != argument) return escaped_shell_word(argument);
  std::string word = "'";
  for (const char c : argument) {
    if (c == '\'') {
      word += R"('\'')";
    } else {
      word += c;
    }
  }
  return word + "'";
}

}  // namespace

std::vector<std::string> command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  return arguments;
}

std::string shell_words(const std::vector<std::string>& arguments) {
  std::string line;
  for (const auto& argument : arguments) {
    if (!line.empty()) line += ' ';
    line += shell_word(argument);
  }
  return line;
}

Provenance provenance_of_this_run(const std::string& threads) {
  Provenance provenance = provenance_of_this_machine();
  provenance.version = version();
  provenance.git_revision = git_revision();
  provenance.instruction_set = name(best_instruction_set());
  provenance.threads = threads;
  provenance.command_line = shell_words(command_line());
  return provenance;
}

}  // namespace jostle::inline study
