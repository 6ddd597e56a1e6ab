#pragma once

#include <memory>
#include <string>

#include "cli/options/command.hpp"
#include "cli/options/command_text.hpp"

namespace jostle::inline cli {

/// The whole command line of the program.
class CommandLine {
 public:
  CommandLine(const std::string& name, const std::string& description);
  ~CommandLine();

  Command program();
  void set_version(const std::string& text);

  /// All that has been described.
  CommandText text() const;

  /// Text to be printed instead of running a command; empty where one was run.
  struct Outcome {
    std::string asked_for;  // a help or the version
    std::string fault;      // the fault
    bool refused = false;
  };
  /// Reads the words and runs the command that they name. Throws BadInput for unknown words, and
  /// what the command throws.
  Outcome parse_and_run(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace jostle::inline cli
