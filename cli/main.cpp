#include <fmt/format.h>

#include <exception>
#include <stdexcept>

#include "cli/commands/program.hpp"
#include "cli/terminal/exit_codes.hpp"
#include "cli/terminal/failure.hpp"
#include "cli/terminal/log.hpp"
#include "cli/terminal/screen.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "results/disk/printable.hpp"
#include "results/hdf5/at_exit.hpp"
#include "study/bad_input.hpp"
#include "study/provenance.hpp"

namespace jostle::inline cli {
namespace {

int parse_and_run(int argc, char** argv) {
  CommandLine line("jostle", program_description);
  int code = exit_ok;
  describe_program(line, code);
  const CommandLine::Outcome outcome = line.parse_and_run(argc, argv);
  print_wrapped(outcome.asked_for);
  print_to_standard_error(outcome.fault);
  return outcome.refused ? exit_bad_input : code;
}

void say(const std::string& message) {
  constexpr std::size_t longest_line = 2000;
  print_to_standard_error(fmt::format("jostle: {}\n", printable(message, longest_line)));
}

/// Every error ends here, with a message on stderr.
int run_program(int argc, char** argv) {
  try {
    begin_log();
    const int code = parse_and_run(argc, argv);
    return code == exit_ok && output_is_lost() ? exit_io_error : code;
  } catch (const BadInput& error) {
    say(failure_text(error));
    return exit_bad_input;
  } catch (const std::invalid_argument& error) {  // an environment variable, for one
    say(error.what());
    return exit_bad_input;
  } catch (const JsonError& error) {
    say(fmt::format("a stored scene is not as jostle writes it: {}", error.what()));
    return exit_io_error;
  } catch (const std::exception& error) {
    say(failure_text(error));
    return exit_io_error;
  }
}

}  // namespace
}  // namespace jostle::inline cli

int main(int argc, char** argv) {
  jostle::reserve_standard_fds();
  jostle::close_nothing_at_exit();
  jostle::keep_command_line(argc, argv);
  return jostle::run_program(argc, argv);
}
