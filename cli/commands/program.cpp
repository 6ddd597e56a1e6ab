#include "cli/commands/program.hpp"

#include <fmt/format.h>

#include <exception>
#include <stdexcept>

#include "cli/terminal/exit_codes.hpp"
#include "cli/terminal/failure.hpp"
#include "cli/terminal/log.hpp"
#include "cli/terminal/screen.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "cli/terminal/version.hpp"
#include "results/disk/printable.hpp"
#include "results/hdf5/at_exit.hpp"
#include "study/bad_input.hpp"
#include "study/provenance.hpp"

namespace jostle::inline cli {

namespace {

constexpr const char* footer =
    "Examples:\n"
    "  jostle new quickstart          writes quickstart.json, a scene to start from\n"
    "  jostle check quickstart.json   what it means and costs\n"
    "  jostle run quickstart.json     writes quickstart.h5\n"
    "  jostle info quickstart.h5      what is in it\n"
    "  jostle fit quickstart.h5 --observable bottom_fraction\n"
    "  jostle analyse quickstart.h5 steady --observable mean_height\n"
    "  jostle structure quickstart.h5 --part profile,voronoi\n"
    "  jostle report quickstart.h5    writes quickstart.html, a page to look at\n"
    "\n"
    "Exit codes: 0 done; 2 bad scene or command line, nothing was run; 3 some realizations "
    "failed,\n"
    "the rest is stored; 4 input or output failed; 75 stopped by a signal or the time limit, "
    "--resume\n"
    "continues the run.";

int parse_and_run(int argc, char** argv, std::span<const AddCommand> commands) {
  CommandLine line("jostle", program_description);
  int code = exit_ok;
  describe_program(line, code, commands);
  const CommandLine::Outcome outcome = line.parse_and_run(argc, argv);
  print_wrapped(outcome.asked_for);
  print_to_standard_error(outcome.fault);
  return outcome.refused ? exit_bad_input : code;
}

void say(const std::string& message) {
  constexpr std::size_t longest_line = 2000;
  print_to_standard_error(fmt::format("jostle: {}\n", printable(message, longest_line)));
}

}  // namespace

void describe_program(CommandLine& line, int& code, std::span<const AddCommand> commands) {
  line.set_version(version_text());
  Command app = line.program();
  app.footer(footer);
  app.require_command();
  for (const AddCommand add : commands) add(app, code);
}

int run_program(int argc, char** argv, std::span<const AddCommand> commands) {
  reserve_standard_fds();
  close_nothing_at_exit();
  keep_command_line(argc, argv);
  try {
    begin_log();
    const int code = parse_and_run(argc, argv, commands);
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

}  // namespace jostle::inline cli
