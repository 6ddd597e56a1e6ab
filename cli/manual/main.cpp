// jostle_manual FOLDER: writes the manual pages and the completions of jostle there.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "cli/commands/program.hpp"
#include "cli/manual/completion.hpp"
#include "cli/manual/man_page.hpp"
#include "study/version.hpp"

namespace {

void write(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw std::runtime_error(path.string() + ": could not be written");
}

void write_all(const std::filesystem::path& folder) {
  jostle::CommandLine line("jostle", jostle::program_description);
  int code = 0;
  jostle::describe_program(line, code, jostle::every_command());
  const jostle::CommandText program = line.text();
  write(folder / "man1/jostle.1", program_page(program, jostle::version()));
  for (const jostle::CommandText& command : program.commands) {
    write(folder / "man1" / ("jostle-" + command.name + ".1"),
          command_page(program, command, jostle::version()));
  }
  write(folder / "bash/jostle", bash_completion(program));
  write(folder / "zsh/_jostle", zsh_completion(program));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: jostle_manual FOLDER\n";
    return 2;
  }
  try {
    write_all(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "jostle_manual: " << error.what() << '\n';
    return 1;
  }
}
