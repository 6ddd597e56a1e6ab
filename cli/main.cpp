#include <fmt/format.h>

#include <exception>
#include <stdexcept>

#include "cli/commands/commands.hpp"
#include "cli/options/command_line.hpp"
#include "cli/terminal/failure.hpp"
#include "cli/terminal/log.hpp"
#include "cli/terminal/standard_streams.hpp"
#include "cli/terminal/version.hpp"
#include "results/export/printable.hpp"
#include "study/bad_input.hpp"

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
    "the rest is stored; 4 a file or the disk; 75 stopped by a signal or the time limit, --resume\n"
    "goes on.";

int parse_and_run(int argc, char** argv) {
  CommandLine line("jostle", "Ensembles of tapped granular packings");
  line.set_version(version_text());
  Command app = line.program();
  app.footer(footer);
  app.require_command();
  int code = exit_ok;
  add_new(app, code);
  add_run(app, code);
  add_check(app, code);
  add_cost(app, code);
  add_schema(app, code);
  add_info(app, code);
  add_merge(app, code);
  add_bench(app, code);
  add_selftest(app, code);
  add_fit(app, code);
  add_analyse(app, code);
  add_structure(app, code);
  add_report(app, code);
  add_export(app, code);
  const CommandLine::Outcome outcome = line.parse_and_run(argc, argv);
  print(outcome.asked_for);
  print_to_standard_error(outcome.fault);
  return outcome.refused ? exit_bad_input : code;
}

void say(const std::string& what) {
  constexpr std::size_t longest_line = 2000;
  print_to_standard_error(fmt::format("jostle: {}\n", printable(what, longest_line)));
}

/// Every error ends here, and says on stderr what is wrong.
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
  return jostle::run_program(argc, argv);
}
