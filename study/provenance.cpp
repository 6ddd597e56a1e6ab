#include "study/provenance.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <system_error>

#include "engine/monte_carlo/trial_loop.hpp"
#include "results/disk/printable.hpp"
#include "study/version.hpp"

namespace jostle::inline study {
namespace {

namespace fs = std::filesystem;

std::vector<std::string>& kept_command_line() {
  static std::vector<std::string> arguments;
  return arguments;
}

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

void keep_command_line(int argc, char** argv) {
  kept_command_line().assign(argv, argv + argc);
}

std::vector<std::string> command_line() {
#if defined(__linux__) && !defined(JOSTLE_PORTABLE)
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  if (!arguments.empty()) return arguments;
#endif
  return kept_command_line();
}

fs::path program_path() {
#if defined(__linux__) && !defined(JOSTLE_PORTABLE)
  std::error_code fault;
  const fs::path program = fs::read_symlink("/proc/self/exe", fault);
  if (!fault) return program;
#endif
  const std::vector<std::string> arguments = command_line();
  const std::string name = arguments.empty() ? "jostle" : arguments.front();
  if (name.find('/') == std::string::npos) {
    const char* const folders = std::getenv("PATH");
    std::istringstream stream(folders == nullptr ? "" : folders);
    for (std::string folder; std::getline(stream, folder, ':');) {
      const fs::path file = fs::path(folder) / name;
      if (fs::is_regular_file(file)) return fs::canonical(file);
    }
  }
  return fs::canonical(name);
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
